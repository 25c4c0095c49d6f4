/// \file
/// The colliders of a scene that share one frame, in the coordinates of that frame. They are at rest in the world or
/// move together. One total order numbers the surfaces of the colliders of all frames.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "ricochet/collision/collider_list.h"
#include "ricochet/collision/surface.h"
#include "ricochet/core/box3.h"
#include "ricochet/core/page_vector.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/acceleration/distance_field.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"
#include "ricochet/geometry/shapes/analytic_shape.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "ricochet/geometry/sweep/point_sweep.h"

namespace ricochet {

/// The colliders of one frame, and queries of their surfaces. Immutable after construction, except for prepare_radius()
/// and set_culling(). Queries are safe from any number of threads.
class CollisionWorld {
public:
    /// Applies the placements of all colliders of a frame to their vertices and builds the broad phase. Throws
    /// InputError with the name of the collider if a placement is singular or a coordinate exceeds kLargestCoordinate.
    /// `chord_margin` is the distance that a path may lie beside its chords before the broad phase divides it. Its unit
    /// is the mean box diagonal of the triangles. Results do not depend on it.
    CollisionWorld(std::shared_ptr<ColliderList> colliders, std::string_view frame, double chord_margin = kChordMargin);
    /// Builds the world frame from colliders that are all at rest.
    explicit CollisionWorld(std::vector<ColliderDescription> colliders, double chord_margin = kChordMargin);
    CollisionWorld(const CollisionWorld&) = delete;  // the broad phase refers to the arrays
    CollisionWorld& operator=(const CollisionWorld&) = delete;

    /// Colliders of all frames, and the numbers of their surfaces.
    [[nodiscard]] const std::vector<ColliderDescription>& colliders() const { return list_->all(); }
    [[nodiscard]] std::size_t surface_count() const { return list_->surface_count(); }
    [[nodiscard]] SurfaceName name_of(SurfaceId surface) const { return list_->name_of(surface); }
    /// Returns true if the surface belongs to a collider of this frame. The functions below that take a surface accept
    /// only surfaces of this frame.
    [[nodiscard]] bool owns(SurfaceId surface) const { return ranges_[collider_of(surface)].kind != Kind::elsewhere; }
    /// Returns true if the frame has no colliders.
    [[nodiscard]] bool empty() const { return triangles_.empty() && planes_.empty() && shapes_.empty(); }

    /// An infinite plane with its surface number.
    struct PlaneSurface {
        Plane plane;
        SurfaceId surface;
    };
    [[nodiscard]] std::span<const PlaneSurface> planes() const { return planes_; }

    /// A ball or cylinder with the surface numbers of its parts.
    struct ShapeSurface {
        AnalyticShape shape;
        SurfaceId surface;  ///< surface number of its side

        [[nodiscard]] SurfaceId surface_of(ShapePart part) const { return surface + static_cast<SurfaceId>(part); }
        [[nodiscard]] bool owns(SurfaceId other) const {
            return other >= surface && other < surface + shape.part_count();
        }
        [[nodiscard]] ShapePart part_of(SurfaceId own) const { return static_cast<ShapePart>(own - surface); }
        /// Returns the part nearest to p.
        [[nodiscard]] SurfaceId nearest_to(const Vec3& p) const { return surface_of(shape.closest_point(p).part); }
    };
    [[nodiscard]] std::span<const ShapeSurface> shapes() const { return shapes_; }

    /// Returns the broad phase over the triangles of all meshes for particles of the given radius. It proposes
    /// triangles by their index in triangles(). Each radius class (a power of two) has its own, so that small particles
    /// do not pay for large ones. The class must have been prepared.
    [[nodiscard]] const TriangleBvh& bvh_for(double radius) const;
    /// Builds the class of a radius if it does not exist yet. Must not run while other threads query.
    void prepare_radius(double radius);
    /// Enables or disables culling. Without culling every triangle is a candidate of every path. The results are the
    /// same but slower; tests use them as the reference.
    void set_culling(bool culls) { culls_ = culls; }
    [[nodiscard]] bool culls() const { return culls_; }
    [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
    [[nodiscard]] std::span<const Vec3> vertices() const { return vertices_; }
    /// Returns true if the triangle has no area. Collisions ignore such triangles, because the edges of their
    /// neighbours cover them.
    [[nodiscard]] bool is_degenerate(std::uint32_t triangle) const {
        return degenerate_count_ != 0 && degenerate_[triangle] != 0;
    }
    [[nodiscard]] SurfaceId surface_of_triangle(std::uint32_t triangle) const;
    /// Returns the index of a surface in triangles(), or nothing for planes and shapes.
    [[nodiscard]] std::optional<std::uint32_t> triangle_of(SurfaceId surface) const {
        const Range& range = ranges_[collider_of(surface)];
        if (range.kind != Kind::mesh) return std::nullopt;
        return range.first_triangle + (surface - range.first_surface);
    }

    /// Returns the material of a surface of any frame: the material of its triangle if it has one, otherwise of its
    /// collider.
    [[nodiscard]] std::uint32_t material_of(SurfaceId surface) const { return list_->material_of(surface); }

    /// Corners of a triangle.
    struct Corners {
        const Vec3& a;
        const Vec3& b;
        const Vec3& c;
    };
    [[nodiscard]] Corners corners_of_triangle(std::uint32_t triangle) const {
        const Triangle& t = triangles_[triangle];
        return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
    }

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

    /// Returns the point of a surface that is nearest to p.
    [[nodiscard]] SurfacePosition closest_point_on(SurfaceId surface, const Vec3& p) const;

    /// Returns the unit normal of a surface at p, which may lie beyond its rim. The normal is the plane's own, the
    /// triangle's by the counter-clockwise rule, or the outward normal of a shape's part.
    [[nodiscard]] Vec3 unit_normal_of(SurfaceId surface, const Vec3& p) const;
    /// Returns the signed distance, in m, from a plane, a triangle's plane or a shape's part extended beyond its rim.
    /// It is also accurate next to the surface.
    [[nodiscard]] double signed_distance_from(SurfaceId surface, const Vec3& p) const;
    /// Returns the size, in m, of the collider that a surface belongs to. For shapes with a formula it is the diagonal
    /// of the box, but at most four of the smallest radii. For planes and triangles it is the diagonal of the box of
    /// all colliders.
    [[nodiscard]] double size_of(SurfaceId surface) const;
    /// Returns true for planes, triangles and the caps of cylinders.
    [[nodiscard]] bool is_flat(SurfaceId surface) const {
        const Range& range = ranges_[collider_of(surface)];
        return range.kind != Kind::shape || surface != range.first_surface;
    }
    /// Returns true for the parts of balls and cylinders.
    [[nodiscard]] bool is_shape(SurfaceId surface) const { return ranges_[collider_of(surface)].kind == Kind::shape; }
    /// Returns the rim of a cylinder that is nearest to p: 1 at the bottom, 2 at the top. The surface must be a part of
    /// a cylinder.
    [[nodiscard]] int rim_of(SurfaceId surface, const Vec3& p) const;
    /// Returns the exact side of a surface that p is on: +1 in front of it, where its normal points, -1 behind it, 0 in
    /// its plane.
    [[nodiscard]] int side_of_surface(SurfaceId surface, const Vec3& p) const;
    /// Returns the time, in s, for which a path along a surface stays over it, see triangle_exit_time(). It is the
    /// whole duration for a plane and for a shape's side.
    [[nodiscard]] double time_over(SurfaceId surface, const Path& path, double slack) const;
    /// Returns true if the closed segment [p, q] intersects the surface. The decision is exact for planes and
    /// triangles. For shapes it errs towards true, by some 2^-90.
    [[nodiscard]] bool segment_intersects(SurfaceId surface, const Vec3& p, const Vec3& q) const;
    /// Returns true if the point lies on the surface, as precisely as segment_intersects() decides it.
    [[nodiscard]] bool point_on(SurfaceId surface, const Vec3& p) const { return segment_intersects(surface, p, p); }

    /// Returns the mesh of a collider in the frame's coordinates, with its degenerate triangles; nothing if it is not a
    /// mesh or box.
    [[nodiscard]] std::optional<TriangleMesh> mesh_of(std::size_t collider) const;
    /// Returns the number of surfaces of a collider: its triangles, 1 for a plane or ball, 3 for a cylinder.
    [[nodiscard]] std::size_t surface_count_of(std::size_t collider) const;
    [[nodiscard]] SurfaceId first_surface_of(std::size_t collider) const { return list_->first_surface_of(collider); }
    /// Box of the frame's colliders, without the planes.
    [[nodiscard]] const Box3& bounds() const { return bounds_; }
    /// Box of all triangles.
    [[nodiscard]] const Box3& triangle_bounds() const { return triangle_bounds_; }
    /// Field of lower bounds of the distance to the triangles.
    [[nodiscard]] const DistanceField& distance_field() const { return distance_field_; }
    /// Returns the memory of the world, in bytes, without the meshes that the colliders were made from. It includes
    /// memory that Embree maps by itself.
    [[nodiscard]] std::size_t memory_bytes() const;
    /// Appends the memory pages of the large arrays, which no longer change.
    void add_pages_to(std::vector<std::span<const std::byte>>& pages) const;
    /// Number of triangles without area, which collisions ignore.
    [[nodiscard]] std::size_t degenerate_triangles() const { return degenerate_count_; }

private:
    enum class Kind : std::uint8_t { plane, mesh, shape, elsewhere };

    /// The entries of the shared arrays that belong to a collider.
    struct Range {
        SurfaceId first_surface = 0;
        std::uint32_t first_triangle = 0;
        std::uint32_t first_vertex = 0;
        std::uint32_t index = 0;  ///< index into planes_ or shapes_
        Kind kind = Kind::mesh;
    };

    void add(std::size_t number);
    void add_range(std::size_t number, Kind kind, std::size_t index = 0);
    void add_shape(std::size_t number, const AnalyticShape& shape);
    void add_plane(std::size_t number, const PlaneShape& shape);
    void add_mesh(std::size_t number, const MeshShape& shape);
    void flag_degenerate_triangles();
    [[nodiscard]] double mean_box() const;
    [[nodiscard]] double largest_radius_of_class(double radius) const;
    [[nodiscard]] std::uint32_t collider_of(SurfaceId surface) const { return list_->collider_of(surface); }

    std::shared_ptr<ColliderList> list_;
    std::vector<Range> ranges_;  ///< one per collider of the list
    std::vector<PlaneSurface> planes_;
    PageVector<Vec3> vertices_;
    PageVector<Triangle> triangles_;
    PageVector<std::uint8_t> degenerate_;
    std::size_t degenerate_count_ = 0;
    Box3 bounds_;
    Box3 triangle_bounds_;
    std::vector<ShapeSurface> shapes_;
    double chord_margin_ = 0.0;       ///< in m, distance that a path may lie beside its chords before it is divided
    TriangleBvh::Clusters clusters_;  ///< clusters of all triangles, shared by the radius classes
    struct RadiusClass {
        double largest_radius;
        TriangleBvh bvh;
    };
    DistanceField distance_field_;
    std::vector<RadiusClass> classes_;  ///< ascending in radius; the first is for points
    bool culls_ = true;
};

}  // namespace ricochet
