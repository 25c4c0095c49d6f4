/// \file
/// Queries on a mesh that a map places in the world, without a copy of the mesh.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/inside_rule.h"
#include "ricochet/queries/mesh_queries.h"

namespace ricochet {

/// A mesh with a similarity that places it: a rotation or reflection, one scale for all axes, and a translation.
///
/// Queries are transformed to the mesh's own coordinates, and results are transformed back. Each result is exact for
/// the transformed and rounded query, as in MeshQueries. The transformation rounds each coordinate by a few units in
/// the last place of the largest number involved. Triangles keep the order of their corners. A reflection therefore
/// inverts their normals, and changes the signs of crossings and winding numbers.
class PlacedMesh {
public:
    /// Shares the mesh. Throws InputError if the map is not finite or not a similarity. The scales of the axes may
    /// differ, and the axes may deviate from right angles, by at most 1e-9 of the scale. These limits accept rotations
    /// written with ten digits.
    PlacedMesh(const MeshQueries& mesh, const AffineMap& world_from_mesh);

    // The queries of MeshQueries, in world coordinates and lengths.
    [[nodiscard]] MeshHits first_hits(const RayBatch& rays) const;
    [[nodiscard]] AllMeshHits all_hits(const RayBatch& rays) const;
    [[nodiscard]] std::vector<std::uint64_t> count_hits(const RayBatch& rays) const;
    [[nodiscard]] std::vector<std::uint8_t> occluded(const RayBatch& rays) const;
    [[nodiscard]] std::vector<std::uint8_t> inside(std::span<const Vec3> points,
                                                   InsideRule rule = InsideRule::parity) const;
    [[nodiscard]] std::vector<double> winding_numbers(std::span<const Vec3> points) const;
    [[nodiscard]] NearestPoints closest_points(std::span<const Vec3> points,
                                               double within = std::numeric_limits<double>::infinity()) const;
    [[nodiscard]] std::vector<double> signed_distances(std::span<const Vec3> points,
                                                       InsideRule rule = InsideRule::parity) const;
    [[nodiscard]] MeshHits sweep(std::span<const Vec3> from, std::span<const Vec3> to,
                                 std::span<const double> radii) const;
    [[nodiscard]] MeshHits sweep_moving(std::span<const Vec3> from, std::span<const Vec3> to,
                                        std::span<const double> radii, std::span<const Vec3> vertices_after) const;

private:
    struct LocalRays;
    [[nodiscard]] std::vector<Vec3> local_points(std::span<const Vec3> points, const char* name) const;
    [[nodiscard]] std::vector<double> local_lengths(std::span<const double> lengths) const;
    void place(std::vector<Vec3>& points) const;
    void scale(std::vector<double>& lengths) const;

    MeshQueries mesh_;
    AffineMap world_from_mesh_;
    double scale_ = 1.0;
};

}  // namespace ricochet
