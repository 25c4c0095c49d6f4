/// \file
/// The colliders of a scene that share one frame, placed in the coordinates of that frame: planes, shapes, and the
/// triangles of all meshes. One total order numbers the surfaces of the colliders of all frames.
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
#include "ricochet/geometry/shapes/analytic_shape.h"
#include "ricochet/geometry/sweep/point_sweep.h"

namespace ricochet {

/// The placed colliders of one frame and the numbers of their surfaces. Immutable after construction.
class PlacedColliders {
public:
    /// Applies the placements of all colliders of a frame to their vertices. Throws InputError with the name of the
    /// collider if a placement is singular or a coordinate exceeds kLargestCoordinate.
    PlacedColliders(std::shared_ptr<ColliderList> colliders, std::string_view frame);

    /// Returns the colliders of all frames.
    [[nodiscard]] const std::shared_ptr<ColliderList>& list() const { return list_; }
    /// Returns the descriptions of the colliders of all frames.
    [[nodiscard]] const std::vector<ColliderDescription>& colliders() const { return list_->all(); }
    [[nodiscard]] std::size_t surface_count() const { return list_->surface_count(); }
    [[nodiscard]] SurfaceName name_of(SurfaceId surface) const { return list_->name_of(surface); }
    enum class Kind : std::uint8_t { plane, mesh, shape, elsewhere };
    /// The entries of the arrays that belong to a collider.
    struct Range {
        SurfaceId first_surface = 0;
        std::uint32_t first_triangle = 0;
        std::uint32_t first_vertex = 0;
        std::uint32_t index = 0;  ///< index into planes() or shapes()
        Kind kind = Kind::mesh;   ///< elsewhere: the collider belongs to another frame
    };
    [[nodiscard]] const Range& range(std::size_t collider) const { return ranges_[collider]; }
    [[nodiscard]] const Range& range_of(SurfaceId surface) const { return ranges_[list_->collider_of(surface)]; }
    /// Returns true if the surface belongs to a collider of this frame, as the functions below require.
    [[nodiscard]] bool owns(SurfaceId surface) const { return range_of(surface).kind != Kind::elsewhere; }
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

    [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
    [[nodiscard]] std::span<const Vec3> vertices() const { return vertices_; }
    /// Returns true if the triangle has no area. Collisions ignore it, because the edges of its neighbours cover it.
    [[nodiscard]] bool is_degenerate(std::uint32_t triangle) const {
        return degenerate_count_ != 0 && degenerate_[triangle] != 0;
    }
    [[nodiscard]] SurfaceId surface_of_triangle(std::uint32_t triangle) const;
    /// Returns the index of a surface in triangles(), or nothing for planes and shapes.
    [[nodiscard]] std::optional<std::uint32_t> triangle_of(SurfaceId surface) const {
        const Range& range = range_of(surface);
        if (range.kind != Kind::mesh) return std::nullopt;
        return range.first_triangle + (surface - range.first_surface);
    }
    /// Returns the material of a surface of any frame: of its triangle if it has one, otherwise of its collider.
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

    /// Returns the mesh of a collider in the frame's coordinates, with degenerate triangles; nothing for other shapes.
    [[nodiscard]] std::optional<TriangleMesh> mesh_of(std::size_t collider) const;
    /// Returns the number of surfaces of a collider: its triangles, 1 for a plane or ball, 3 for a cylinder.
    [[nodiscard]] std::size_t surface_count_of(std::size_t collider) const;
    /// Returns the box of the frame's colliders, without the planes.
    [[nodiscard]] const Box3& bounds() const { return bounds_; }
    /// Returns the box of all triangles.
    [[nodiscard]] const Box3& triangle_bounds() const { return triangle_bounds_; }
    /// Returns the number of triangles without area, which collisions ignore.
    [[nodiscard]] std::size_t degenerate_triangles() const { return degenerate_count_; }

protected:
    /// Returns the memory of the arrays and the list, in bytes.
    [[nodiscard]] std::size_t array_bytes() const;
    /// Appends the memory pages of the large arrays.
    void add_array_pages_to(std::vector<std::span<const std::byte>>& pages) const;

private:
    void add(std::size_t number);
    void add_range(std::size_t number, Kind kind, std::size_t index = 0);
    void add_plane(std::size_t number, const PlaneShape& shape);
    void add_mesh(std::size_t number, const MeshShape& shape);

    std::shared_ptr<ColliderList> list_;
    std::vector<Range> ranges_;  ///< one per collider of the list
    std::vector<PlaneSurface> planes_;
    std::vector<ShapeSurface> shapes_;
    PageVector<Vec3> vertices_;
    PageVector<Triangle> triangles_;
    PageVector<std::uint8_t> degenerate_;
    std::size_t degenerate_count_ = 0;
    Box3 bounds_;
    Box3 triangle_bounds_;
};

}  // namespace ricochet
