/// \file
/// Queries of the colliders of one frame: the geometry of single surfaces, and the broad phase over all triangles.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "ricochet/collision/placed_colliders.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/acceleration/distance_field.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {

/// The colliders of one frame, at rest in its coordinates, and queries of their surfaces. Immutable after construction,
/// except for prepare_radius() and set_culling(). Queries are safe from any number of threads, for surfaces of this
/// frame.
class CollisionWorld : public PlacedColliders {
public:
    /// Also builds the broad phase. It divides a path whose distance from its chord exceeds `chord_margin`. The unit of
    /// `chord_margin` is the mean box diagonal of the triangles. Results do not depend on it.
    CollisionWorld(std::shared_ptr<ColliderList> colliders, std::string_view frame, double chord_margin = kChordMargin);
    /// Builds the world frame from colliders that are all at rest.
    explicit CollisionWorld(std::vector<ColliderDescription> colliders, double chord_margin = kChordMargin);
    CollisionWorld(const CollisionWorld&) = delete;  // the broad phase refers to the arrays
    CollisionWorld& operator=(const CollisionWorld&) = delete;

    /// Point of a surface that is nearest to a point p.
    struct Nearest {
        Vec3 normal;            ///< unit vector from the surface to p, or the surface's own normal if p lies on it
        double distance = 0.0;  ///< in m, >= 0
        bool flat = true;  ///< true: a plane, cap or face of a triangle; false: an edge, a corner or a curved surface
        bool rim = false;  ///< an edge or corner of a triangle, or the edge between a cylinder's cap and side
    };
    [[nodiscard]] Nearest nearest(SurfaceId surface, const Vec3& p) const;
    /// Returns the point of a triangle that is nearest to p.
    [[nodiscard]] static Nearest nearest(const TrianglePlane& triangle, const Vec3& p);

    /// Returns the plane of a triangle.
    [[nodiscard]] TrianglePlane plane_of_triangle(std::uint32_t triangle) const {
        const auto [a, b, c] = corners_of_triangle(triangle);
        return {a, b, c, unit_normals_[triangle]};
    }
    /// Returns the point of a surface that is nearest to p.
    [[nodiscard]] SurfacePosition closest_point_on(SurfaceId surface, const Vec3& p) const;

    /// Returns the unit normal of a surface at p, which may lie beyond its rim. The normal is the plane's own, the
    /// triangle's by the counter-clockwise rule, or the outward normal of a shape's part.
    [[nodiscard]] Vec3 unit_normal_of(SurfaceId surface, const Vec3& p) const;
    /// Returns the signed distance, in m, from a plane, or from a triangle or shape part extended beyond its rim.
    [[nodiscard]] double signed_distance_from(SurfaceId surface, const Vec3& p) const;
    /// Returns the size, in m, of a surface's collider: for shapes with a formula the diagonal of the box, but at most
    /// four of the smallest radii; for planes and triangles the diagonal of the box of all colliders.
    [[nodiscard]] double size_of(SurfaceId surface) const;
    /// Returns true for planes, triangles and the caps of cylinders.
    [[nodiscard]] bool is_flat(SurfaceId surface) const {
        const Range& range = range_of(surface);
        return range.kind != Kind::shape || surface != range.first_surface;
    }
    /// Returns true for the parts of balls and cylinders.
    [[nodiscard]] bool is_shape(SurfaceId surface) const { return range_of(surface).kind == Kind::shape; }
    /// Returns the rim of a cylinder, given by one of its parts, that is nearest to p: 1 at the bottom, 2 at the top.
    [[nodiscard]] int rim_of(SurfaceId surface, const Vec3& p) const;
    /// Returns the exact side of a surface: +1 if p is in front, where its normal points, -1 behind it, 0 in its plane.
    [[nodiscard]] int side_of_surface(SurfaceId surface, const Vec3& p) const;
    /// Returns the time, in s, for which a path along a surface stays over it, or the whole duration if it has no rim.
    [[nodiscard]] double time_over(SurfaceId surface, const Path& path, double slack) const;
    /// Returns true if the closed segment [p, q] intersects the surface. The decision is exact for planes and
    /// triangles. For shapes it errs on the side of true, by about 2^-90.
    [[nodiscard]] bool segment_intersects(SurfaceId surface, const Vec3& p, const Vec3& q) const;
    /// Returns true if the point lies on the surface, as precisely as segment_intersects() decides it.
    [[nodiscard]] bool point_on(SurfaceId surface, const Vec3& p) const { return segment_intersects(surface, p, p); }

    /// Returns the broad phase over the triangles of all meshes for particles of the given radius. It proposes
    /// triangles by their index in triangles(). Each radius class (a power of two) has its own broad phase, so that
    /// large particles do not enlarge the boxes for small ones. The class must have been prepared.
    [[nodiscard]] const TriangleBvh& bvh_for(double radius) const;
    /// Builds the class of a radius if it does not exist yet. Must not run while other threads query.
    void prepare_radius(double radius);
    /// Enables or disables culling. Without it, every triangle is a candidate of every path, as a reference for tests.
    void set_culling(bool culls) { culls_ = culls; }
    [[nodiscard]] bool culls() const { return culls_; }
    /// Returns the field of lower bounds of the distance to the triangles.
    [[nodiscard]] const DistanceField& distance_field() const { return distance_field_; }
    /// Returns the memory of the world, in bytes, with Embree's own, and without the meshes that it was made from.
    [[nodiscard]] std::size_t memory_bytes() const;
    /// Appends the memory pages of the large arrays, which no longer change.
    void add_pages_to(std::vector<std::span<const std::byte>>& pages) const;

private:
    /// Returns the index of a triangle, given the range of its collider.
    [[nodiscard]] static std::uint32_t triangle_in(const Range& range, SurfaceId surface) {
        return range.first_triangle + (surface - range.first_surface);
    }
    /// Returns the corners of a triangle, given the range of its collider.
    [[nodiscard]] Corners corners_in(const Range& range, SurfaceId surface) const {
        return corners_of_triangle(triangle_in(range, surface));
    }
    [[nodiscard]] double largest_radius_of_class(double radius) const;

    double chord_margin_ = 0.0;       ///< in m, largest distance of a path from its chords without division
    TriangleBvh::Clusters clusters_;  ///< clusters of all triangles, shared by the radius classes
    struct RadiusClass {
        double largest_radius;
        TriangleBvh bvh;
    };
    DistanceField distance_field_;
    PageVector<Vec3> unit_normals_;     ///< of the triangles; zero for triangles without area
    std::vector<RadiusClass> classes_;  ///< ascending in radius; the first is for points
    bool culls_ = true;
};

}  // namespace ricochet
