#include "ricochet/queries/placed_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/core/error.h"
#include "ricochet/queries/mesh_index.h"

namespace ricochet {
namespace {

/// Largest relative deviation of a similarity's columns from its scale, see PlacedMesh. Local: a limit of input values.
constexpr double kSimilarity = 1e-9;

/// Returns the scale of a similarity, or 0 if the map is not a similarity.
double scale_of(const AffineMap& map) {
    const double volume = std::fabs(map.determinant());
    const double scale = std::cbrt(volume);
    if (!(scale > 0.0) || !std::isfinite(scale) || !is_finite(map.translation)) return 0.0;
    const Vec3 rows[] = {map.row_x / scale, map.row_y / scale, map.row_z / scale};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (!(std::fabs(dot(rows[i], rows[j]) - (i == j ? 1.0 : 0.0)) <= kSimilarity)) return 0.0;
        }
    }
    return scale;
}

}  // namespace

/// Rays in the mesh's coordinates.
struct PlacedMesh::LocalRays {
    LocalRays(const PlacedMesh& placed, const RayBatch& rays)
        : origins(placed.local_points(rays.origins, "origins")),
          directions(rays.directions.size()),
          most(placed.local_lengths(rays.most)) {
        // The length of a direction has no effect, so each direction is scaled to a largest component of about 1.
        std::transform(rays.directions.begin(), rays.directions.end(), directions.begin(), [&](const Vec3& d) {
            const double largest = max_abs(d);
            return is_finite(d) && largest > 0.0 ? placed.world_from_mesh_.direction_back(d / largest) / placed.scale_
                                                 : d;
        });
    }
    [[nodiscard]] RayBatch batch() const { return {origins, directions, most}; }

    std::vector<Vec3> origins;
    std::vector<Vec3> directions;
    std::vector<double> most;
};

PlacedMesh::PlacedMesh(const MeshQueries& mesh, const AffineMap& world_from_mesh)
    : mesh_(mesh), world_from_mesh_(world_from_mesh), scale_(scale_of(world_from_mesh)) {
    if (scale_ > 0.0) return;
    throw InputError(
        "transform: found one that is no similarity, expected finite numbers: a rotation or reflection times one "
        "scale, "
        "and a translation");
}

std::vector<Vec3> PlacedMesh::local_points(std::span<const Vec3> points, const char* name) const {
    require_positions(points, name);
    std::vector<Vec3> local(points.size());
    std::transform(points.begin(), points.end(), local.begin(), [&](const Vec3& p) {
        return world_from_mesh_.direction_back((p - world_from_mesh_.translation) / scale_) / scale_;
    });
    return local;
}

std::vector<double> PlacedMesh::local_lengths(std::span<const double> lengths) const {
    std::vector<double> local(lengths.begin(), lengths.end());
    for (double& value : local) value /= scale_;
    return local;
}

void PlacedMesh::place(std::vector<Vec3>& points) const {
    for (Vec3& p : points) p = world_from_mesh_.point(p);
}

void PlacedMesh::scale(std::vector<double>& lengths) const {
    for (double& value : lengths) value *= scale_;
}

MeshHits PlacedMesh::first_hits(const RayBatch& rays) const {
    MeshHits hits = mesh_.first_hits(LocalRays(*this, rays).batch());
    place(hits.point);
    scale(hits.distance);
    return hits;
}

AllMeshHits PlacedMesh::all_hits(const RayBatch& rays) const {
    AllMeshHits all = mesh_.all_hits(LocalRays(*this, rays).batch());
    place(all.hits.point);
    scale(all.hits.distance);
    if (world_from_mesh_.mirrors()) {
        for (std::int8_t& crossing : all.crossing) crossing = static_cast<std::int8_t>(-crossing);
    }
    return all;
}

std::vector<std::uint64_t> PlacedMesh::count_hits(const RayBatch& rays) const {
    return mesh_.count_hits(LocalRays(*this, rays).batch());
}

std::vector<std::uint8_t> PlacedMesh::occluded(const RayBatch& rays) const {
    return mesh_.occluded(LocalRays(*this, rays).batch());
}

std::vector<std::uint8_t> PlacedMesh::inside(std::span<const Vec3> points, InsideRule rule) const {
    return mesh_.inside(local_points(points, "points"), rule);
}

std::vector<double> PlacedMesh::winding_numbers(std::span<const Vec3> points) const {
    std::vector<double> numbers = mesh_.winding_numbers(local_points(points, "points"));
    if (world_from_mesh_.mirrors()) {
        for (double& number : numbers) number = 0.0 - number;  // avoids -0
    }
    return numbers;
}

NearestPoints PlacedMesh::closest_points(std::span<const Vec3> points, double within) const {
    NearestPoints nearest = mesh_.closest_points(local_points(points, "points"), within / scale_);
    place(nearest.point);
    scale(nearest.distance);
    return nearest;
}

std::vector<double> PlacedMesh::signed_distances(std::span<const Vec3> points, InsideRule rule) const {
    std::vector<double> distances = mesh_.signed_distances(local_points(points, "points"), rule);
    scale(distances);
    return distances;
}

MeshHits PlacedMesh::sweep(std::span<const Vec3> from, std::span<const Vec3> to, std::span<const double> radii) const {
    MeshHits hits = mesh_.sweep(local_points(from, "from_points"), local_points(to, "to_points"), local_lengths(radii));
    place(hits.point);
    return hits;
}

MeshHits PlacedMesh::sweep_moving(std::span<const Vec3> from, std::span<const Vec3> to, std::span<const double> radii,
                                  std::span<const Vec3> vertices_after) const {
    MeshHits hits = mesh_.sweep_moving(local_points(from, "from_points"), local_points(to, "to_points"),
                                       local_lengths(radii), local_points(vertices_after, "vertices_after"));
    place(hits.point);
    return hits;
}

}  // namespace ricochet
