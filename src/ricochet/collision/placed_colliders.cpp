#include "ricochet/collision/placed_colliders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

constexpr std::size_t kBlock = 1 << 14;

[[noreturn]] void refuse(const ColliderDescription& collider, const std::string& what) {
    throw InputError("collider \"" + collider.name + "\": " + what);
}

AffineMap checked_map(const ColliderDescription& collider, const AffineMap& map) {
    const double determinant = map.determinant();
    if (!is_finite(map.row_x) || !is_finite(map.row_y) || !is_finite(map.row_z) || !is_finite(map.translation)) {
        refuse(collider, "its placement is not finite, expected finite position, rotation and scale");
    }
    if (determinant == 0.0) refuse(collider, "its placement is singular, expected a scale without zeros");
    return map;
}

/// Throws InputError if a placed surface is too small. `extents`, in m: its local sizes. checked_map() reports scale 0.
void require_size(const ColliderDescription& collider, const AffineMap& map, const Vec3& extents) {
    for (int axis = 0; axis < 3; ++axis) {
        const double scale = max_abs(Vec3{map.row_x[axis], map.row_y[axis], map.row_z[axis]});
        const double size = extents[axis] * scale;
        if (size >= kSmallestSize || extents[axis] == 0.0 || scale == 0.0) continue;
        if (!std::isfinite(scale)) continue;
        refuse(collider,
               fmt::format("it measures {:g} m along its own {} axis, expected at least {:g} m: choose a larger "
                           "size, scale or unit",
                           size, "xyz"[axis], kSmallestSize));
    }
}

/// Throws InputError if a placed mesh is too small, by its largest extent, because it may be flat.
void require_size(const ColliderDescription& collider, const AffineMap& map, const std::vector<Vec3>& vertices) {
    Box3 box;
    for (const Vec3& vertex : vertices) box.include(vertex);
    const double largest = vertices.empty() ? 0.0 : max_abs(box.size());
    require_size(collider, map, Vec3{largest, largest, largest});
}

/// Returns the map of a shape after checks of its size and placement.
AffineMap checked_shape(const ColliderDescription& collider, const AffineMap& map) {
    require_size(collider, map, Vec3{2, 2, 2});
    return checked_map(collider, map);
}

void bake_vertices(const ColliderDescription& collider, const std::vector<Vec3>& local, const AffineMap& map,
                   std::span<Vec3> world) {
    parallel_for(local.size(), kBlock, [&](std::size_t i) {
        world[i] = flush_tiny(map.point(local[i]));
        if (is_finite(world[i]) && max_abs(world[i]) <= kLargestCoordinate) return;
        refuse(collider, "a placed vertex is not finite or beyond 1e75 m, expected a smaller position or scale");
    });
}

Box3 box_of(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    std::vector<Box3> boxes((triangles.size() + kBlock - 1) / kBlock);
    parallel_for_blocks(triangles.size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        Box3 box;
        for (std::size_t t = begin; t < end; ++t) {
            for (const std::uint32_t v : triangles[t]) box.include(vertices[v]);
        }
        boxes[block] = box;
    });
    Box3 all;
    for (const Box3& box : boxes) all.include(box);
    return all;
}

/// Returns 1 for each triangle without area, otherwise 0.
PageVector<std::uint8_t> degenerate_flags(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    PageVector<std::uint8_t> flags(triangles.size(), 0);
    parallel_for(triangles.size(), kBlock, [&](std::size_t t) {
        const auto [a, b, c] = triangles[t];
        flags[t] = are_collinear(vertices[a], vertices[b], vertices[c]) ? 1 : 0;
    });
    return flags;
}

}  // namespace

PlacedColliders::PlacedColliders(std::shared_ptr<ColliderList> colliders, std::string_view frame)
    : list_(std::move(colliders)) {
    for (std::size_t number = 0; number < list_->all().size(); ++number) {
        if (list_->all()[number].frame == frame && !is_deforming(list_->all()[number])) {
            add(number);
        } else {
            add_range(number, Kind::elsewhere);
        }
    }
    degenerate_ = degenerate_flags(vertices_, triangles_);
    degenerate_count_ = static_cast<std::size_t>(std::ranges::count(degenerate_, 1));
    if (degenerate_count_ == 0) degenerate_ = {};
    triangle_bounds_ = box_of(vertices_, triangles_);
    bounds_ = triangle_bounds_;
    for (const ShapeSurface& shape : shapes_) bounds_.include(shape.shape.bounds());
}

void PlacedColliders::add(std::size_t number) {
    const ColliderDescription& collider = list_->all()[number];
    const auto add_shape = [&](const AnalyticShape& shape) {
        add_range(number, Kind::shape, shapes_.size());
        shapes_.push_back({shape, list_->first_surface_of(number)});
    };
    if (const auto* plane = std::get_if<PlaneShape>(&collider.shape)) {
        add_plane(number, *plane);
    } else if (const auto* ball = std::get_if<BallShape>(&collider.shape)) {
        add_shape(AnalyticShape::ball(checked_shape(collider, world_from_unit(*ball))));
    } else if (const auto* cylinder = std::get_if<CylinderShape>(&collider.shape)) {
        add_shape(AnalyticShape::cylinder(checked_shape(collider, world_from_unit(*cylinder))));
    } else if (const auto* cuboid = std::get_if<CuboidShape>(&collider.shape)) {
        require_size(collider, world_from_local(cuboid->placement), cuboid->size);
        add_mesh(number, {std::make_shared<const TriangleMesh>(cuboid_mesh(cuboid->size)), cuboid->placement, {}, {}});
    } else {
        add_mesh(number, std::get<MeshShape>(collider.shape));
        list_->drop_mesh(number);  // from here on, the placed copy is used
    }
}

/// Appends the range of a collider. The running triangle count keeps the ranges sorted by first triangle.
void PlacedColliders::add_range(std::size_t number, Kind kind, std::size_t index) {
    ranges_.push_back({list_->first_surface_of(number), static_cast<std::uint32_t>(triangles_.size()),
                       static_cast<std::uint32_t>(vertices_.size()), static_cast<std::uint32_t>(index), kind});
}

void PlacedColliders::add_plane(std::size_t number, const PlaneShape& shape) {
    const ColliderDescription& collider = list_->all()[number];
    const double size = length(shape.normal);
    if (!(size > 0.0) || !std::isfinite(size))
        refuse(collider, "its normal is zero or not finite, expected a direction");
    if (!is_finite(shape.point) || max_abs(shape.point) > kLargestCoordinate) {
        refuse(collider, "its point is not finite or beyond 1e75 m");
    }
    add_range(number, Kind::plane, planes_.size());
    planes_.push_back({{flush_tiny(shape.point), flush_tiny(shape.normal / size)}, list_->first_surface_of(number)});
}

void PlacedColliders::add_mesh(std::size_t number, const MeshShape& shape) {
    const ColliderDescription& collider = list_->all()[number];
    const TriangleMesh& mesh = *shape.mesh;
    const std::size_t triangles_after = triangles_.size() + mesh.triangles.size();
    if (std::max(triangles_after, vertices_.size() + mesh.vertices.size()) >
        std::numeric_limits<SurfaceId>::max() / 2) {
        refuse(collider, "the scene's meshes have more than 2^31 triangles or vertices together");
    }
    const AffineMap placed = world_from_local(shape.placement);
    require_size(collider, placed, mesh.vertices);
    const AffineMap map = checked_map(collider, placed);
    const auto base = static_cast<std::uint32_t>(vertices_.size());
    add_range(number, Kind::mesh);
    vertices_.resize(vertices_.size() + mesh.vertices.size());
    bake_vertices(collider, mesh.vertices, map, std::span(vertices_).subspan(base));
    const std::size_t first = triangles_.size();
    const bool flip = map.mirrors();
    triangles_.resize(triangles_after);
    parallel_for(mesh.triangles.size(), kBlock, [&](std::size_t i) {
        const Triangle& t = mesh.triangles[i];
        triangles_[first + i] =
            flip ? Triangle{base + t[0], base + t[2], base + t[1]} : Triangle{base + t[0], base + t[1], base + t[2]};
    });
}

SurfaceId PlacedColliders::surface_of_triangle(std::uint32_t triangle) const {
    if (ranges_.size() == 1) return triangle;
    // Planes own no triangles. The owner is therefore the last range that starts at or before the triangle.
    auto after = std::upper_bound(ranges_.begin(), ranges_.end(), triangle,
                                  [](std::uint32_t t, const Range& range) { return t < range.first_triangle; });
    --after;
    return after->first_surface + (triangle - after->first_triangle);
}

std::size_t PlacedColliders::surface_count_of(std::size_t collider) const {
    return list_->first_surface_of(collider + 1) - list_->first_surface_of(collider);
}

std::optional<TriangleMesh> PlacedColliders::mesh_of(std::size_t collider) const {
    const Range& range = ranges_[collider];
    if (range.kind != Kind::mesh) return std::nullopt;
    TriangleMesh mesh;
    const std::size_t count = surface_count_of(collider);
    mesh.triangles.reserve(count);
    std::uint32_t last_vertex = range.first_vertex;
    for (std::size_t t = 0; t < count; ++t) {
        const Triangle& world = triangles_[range.first_triangle + t];
        mesh.triangles.push_back(
            {world[0] - range.first_vertex, world[1] - range.first_vertex, world[2] - range.first_vertex});
        last_vertex = std::max({last_vertex, world[0], world[1], world[2]});
    }
    mesh.vertices.assign(vertices_.begin() + range.first_vertex, vertices_.begin() + last_vertex + 1);
    return mesh;
}

void PlacedColliders::add_array_pages_to(std::vector<std::span<const std::byte>>& pages) const {
    for (const auto list : {own_pages(vertices_), own_pages(triangles_), own_pages(degenerate_)}) {
        if (!list.empty()) pages.push_back(list);
    }
}

std::size_t PlacedColliders::array_bytes() const {
    const auto used_bytes = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
    return used_bytes(ranges_) + used_bytes(planes_) + used_bytes(vertices_) + used_bytes(triangles_) +
           used_bytes(degenerate_) + used_bytes(shapes_) + list_->memory_bytes();
}

}  // namespace ricochet
