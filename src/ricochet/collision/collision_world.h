/// \file
/// The colliders of a scene that stand in one frame, in its coordinates: those at rest in the world, or those that move
/// together. The surfaces of all colliders have one total order, whatever frame they are in.
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

/// Immutable after construction; safe from any number of threads.
class CollisionWorld {
public:
    /// Bakes the placements of all colliders of a frame into its coordinates and builds the broad phase. Throws
    /// InputError that names the collider when a placement is singular or a coordinate exceeds kLargestCoordinate.
    /// chord_margin: how far beside its chords a path may run before the broad phase divides it, in parts of the mean
    /// triangle's box. Results do not depend on it.
    CollisionWorld(std::shared_ptr<ColliderList> colliders, std::string_view frame, double chord_margin = kChordMargin);
    /// The same of colliders that all stand in the world.
    explicit CollisionWorld(std::vector<ColliderDescription> colliders, double chord_margin = kChordMargin);
    CollisionWorld(const CollisionWorld&) = delete;  // the broad phase refers to the arrays
    CollisionWorld& operator=(const CollisionWorld&) = delete;

    /// Of all frames, and the numbers of their surfaces.
    [[nodiscard]] const std::vector<ColliderDescription>& colliders() const { return list_->all(); }
    [[nodiscard]] std::size_t surface_count() const { return list_->surface_count(); }
    [[nodiscard]] SurfaceName name_of(SurfaceId surface) const { return list_->name_of(surface); }
    /// True for the surfaces of this frame's colliders: what is asked of a surface below is asked of one of these.
    [[nodiscard]] bool owns(SurfaceId surface) const { return ranges_[collider_of(surface)].kind != Kind::elsewhere; }
    /// True where there are none.
    [[nodiscard]] bool empty() const { return triangles_.empty() && planes_.empty() && shapes_.empty(); }

    /// The infinite planes, with their surface numbers.
    struct PlaneSurface {
        Plane plane;
        SurfaceId surface;
    };
    [[nodiscard]] std::span<const PlaneSurface> planes() const { return planes_; }

    /// The balls and cylinders, with the surface numbers of their parts.
    struct ShapeSurface {
        AnalyticShape shape;
        SurfaceId surface;  ///< of its side

        [[nodiscard]] SurfaceId surface_of(ShapePart part) const { return surface + static_cast<SurfaceId>(part); }
        [[nodiscard]] bool owns(SurfaceId other) const {
            return other >= surface && other < surface + shape.part_count();
        }
        [[nodiscard]] ShapePart part_of(SurfaceId own) const { return static_cast<ShapePart>(own - surface); }
        /// The part that is nearest to p.
        [[nodiscard]] SurfaceId nearest_to(const Vec3& p) const { return surface_of(shape.closest_point(p).part); }
    };
    [[nodiscard]] std::span<const ShapeSurface> shapes() const { return shapes_; }

    /// Broad phase over the triangles of all meshes for particles of that radius. It proposes triangles by their index
    /// in triangles(). There is one for each radius class (powers of two), so that small particles do not pay for large
    /// ones; the class must have been prepared.
    [[nodiscard]] const TriangleBvh& bvh_for(double radius) const;
    /// Builds the class of a radius when it is not there yet. Not safe beside queries of other threads.
    void prepare_radius(double radius);
    /// False: every triangle is a candidate of every path. The same results, slowly: the reference of tests.
    void set_culling(bool culls) { culls_ = culls; }
    [[nodiscard]] bool culls() const { return culls_; }
    [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
    [[nodiscard]] std::span<const Vec3> vertices() const { return vertices_; }
    /// True for triangles of no area, which take no part in collisions: their neighbours' edges cover them.
    [[nodiscard]] bool is_degenerate(std::uint32_t triangle) const {
        return degenerate_count_ != 0 && degenerate_[triangle] != 0;
    }
    [[nodiscard]] SurfaceId surface_of_triangle(std::uint32_t triangle) const;
    /// Index into triangles(); nothing for planes and shapes.
    [[nodiscard]] std::optional<std::uint32_t> triangle_of(SurfaceId surface) const {
        const Range& range = ranges_[collider_of(surface)];
        if (range.kind != Kind::mesh) return std::nullopt;
        return range.first_triangle + (surface - range.first_surface);
    }

    /// Material of a surface of any frame: that of its triangle, or of its collider.
    [[nodiscard]] std::uint32_t material_of(SurfaceId surface) const { return list_->material_of(surface); }

    /// The corners of a surface that is a triangle.
    struct Corners {
        const Vec3& a;
        const Vec3& b;
        const Vec3& c;
    };
    [[nodiscard]] Corners corners_of_triangle(std::uint32_t triangle) const {
        const Triangle& t = triangles_[triangle];
        return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
    }

    /// The point of a surface nearest to p.
    struct Nearest {
        Vec3 normal;            ///< unit, from the surface to p (the surface's own normal where p lies on it)
        double distance = 0.0;  ///< m, >= 0
        bool flat = true;       ///< a plane or the inside of a triangle; false: a rim, a corner or a curved surface
        bool rim = false;       ///< an edge or corner of a triangle, or where a cylinder's cap and side meet
    };
    [[nodiscard]] Nearest nearest(SurfaceId surface, const Vec3& p) const;
    /// The same of a triangle.
    [[nodiscard]] static Nearest nearest(const TrianglePlane& triangle, const Vec3& p);

    /// The point of a surface nearest to p.
    [[nodiscard]] SurfacePosition closest_point_on(SurfaceId surface, const Vec3& p) const;

    /// Unit normal of a surface at p, which goes on beyond its rim: the plane's own, the triangle's by the
    /// counter-clockwise rule, the outward one of a shape's part.
    [[nodiscard]] Vec3 unit_normal_of(SurfaceId surface, const Vec3& p) const;
    /// Signed distance from a plane, a triangle's plane or a shape's part that goes on beyond its rim, m; accurate also
    /// next to it.
    [[nodiscard]] double signed_distance_from(SurfaceId surface, const Vec3& p) const;
    /// A length that tells how large a shape with a formula is: the diagonal of its box, m, at most four of its
    /// smallest radii; the diagonal of all colliders' box for planes and triangles.
    [[nodiscard]] double size_of(SurfaceId surface) const;
    /// True for planes, triangles and the caps of cylinders.
    [[nodiscard]] bool is_flat(SurfaceId surface) const {
        const Range& range = ranges_[collider_of(surface)];
        return range.kind != Kind::shape || surface != range.first_surface;
    }
    /// True for the parts of balls and cylinders.
    [[nodiscard]] bool is_shape(SurfaceId surface) const { return ranges_[collider_of(surface)].kind == Kind::shape; }
    /// Which rim of a shape's part is nearest to p, where one is: 1 at the bottom, 2 at the top.
    [[nodiscard]] int rim_of(SurfaceId surface, const Vec3& p) const;
    /// Exact side of a surface's plane: +1 where its normal points to, -1 behind, 0 in the plane.
    [[nodiscard]] int side_of_surface(SurfaceId surface, const Vec3& p) const;
    /// Time that a path along a surface stays over it, see triangle_exit_time(); the whole duration for a
    /// plane and a shape's side.
    [[nodiscard]] double time_over(SurfaceId surface, const Path& path, double slack) const;
    /// Exact: does the closed segment [p, q] intersect the surface?
    [[nodiscard]] bool segment_intersects(SurfaceId surface, const Vec3& p, const Vec3& q) const;
    /// Exact: does the point lie on the surface?
    [[nodiscard]] bool point_on(SurfaceId surface, const Vec3& p) const { return segment_intersects(surface, p, p); }

    /// Mesh of a collider, in the frame's coordinates, with all its triangles, degenerate ones included; nothing for
    /// planes.
    [[nodiscard]] std::optional<TriangleMesh> mesh_of(std::size_t collider) const;
    /// Triangles of a collider; 1 for a plane and a ball, 3 for a cylinder.
    [[nodiscard]] std::size_t surface_count_of(std::size_t collider) const;
    /// First surface of a collider.
    [[nodiscard]] SurfaceId first_surface_of(std::size_t collider) const { return list_->first_surface_of(collider); }
    /// Box of the frame's colliders but the planes.
    [[nodiscard]] const Box3& bounds() const { return bounds_; }
    /// Box of all triangles.
    [[nodiscard]] const Box3& triangle_bounds() const { return triangle_bounds_; }
    /// How far it is to the triangles.
    [[nodiscard]] const DistanceField& distance_field() const { return distance_field_; }
    /// What all of this takes without the colliders' own meshes, bytes: also what Embree maps by itself.
    [[nodiscard]] std::size_t memory_bytes() const;
    /// The pages of what is large and stays as it is.
    void add_pages_to(std::vector<std::span<const std::byte>>& pages) const;
    /// Triangles that take no part in collisions.
    [[nodiscard]] std::size_t degenerate_triangles() const { return degenerate_count_; }

private:
    enum class Kind : std::uint8_t { plane, mesh, shape, elsewhere };

    /// What a collider owns of the shared arrays.
    struct Range {
        SurfaceId first_surface = 0;
        std::uint32_t first_triangle = 0;
        std::uint32_t first_vertex = 0;
        std::uint32_t index = 0;  ///< into planes_ or shapes_
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
    std::vector<Range> ranges_;  ///< one a collider of the list
    std::vector<PlaneSurface> planes_;
    PageVector<Vec3> vertices_;
    PageVector<Triangle> triangles_;
    PageVector<std::uint8_t> degenerate_;
    std::size_t degenerate_count_ = 0;
    Box3 bounds_;
    Box3 triangle_bounds_;
    std::vector<ShapeSurface> shapes_;
    double chord_margin_ = 0.0;       ///< m, how far beside its chords a path may run before it is divided
    TriangleBvh::Clusters clusters_;  ///< of all triangles, shared by the classes
    struct RadiusClass {
        double largest_radius;
        TriangleBvh bvh;
    };
    DistanceField distance_field_;
    std::vector<RadiusClass> classes_;  ///< ascending in radius; the first serves points
    bool culls_ = true;
};

}  // namespace ricochet
