/// \file
/// Angle-weighted pseudonormals. They determine on which side of a mesh a point p is. Only the closest point of the
/// mesh is needed for this.
///
/// Method: J. A. Baerentzen, H. Aanaes, "Signed distance computation using the angle weighted pseudonormal", IEEE TVCG
/// 11(3), 2005. Consider triangles that bound a solid and are wound outward. The offset from the closest point to p is
/// multiplied by the pseudonormal at the closest point. This scalar product is positive outside and negative inside.
/// The same is true at edges with four or more faces, and for nested shells. Vertices at the same position count as one
/// (0 and -0 are equal). Triangles with collinear corners are left out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {

/// Pseudonormals of all features of a mesh. Immutable after construction, so any number of threads may use them. All
/// sums are computed in the order of the triangles.
class Pseudonormals {
public:
    /// Builds the pseudonormals. `vertices` and `triangles` must outlive this object. They must be finite and within
    /// the predicates' range.
    Pseudonormals(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

    /// Returns true for triangles with collinear corners, for which the functions below are undefined.
    [[nodiscard]] bool is_left_out(std::uint32_t triangle) const;

    /// Returns the pseudonormal of a triangle's feature, as the weighted mean of unit normals. Its length is at most 1.
    /// It is zero if normals cancel to rounding (kPseudonormalRounding), as in two sheets back to back. Normals also
    /// cancel for a face that is listed equally often with both windings.
    [[nodiscard]] Vec3 of(std::uint32_t triangle, TriangleFeature feature) const;

    /// Returns the side on which p lies: +1 on the side of the normals, -1 behind. `nearest` must be the result of
    /// closest_point_on_triangle() for p and that triangle, and no triangle of the mesh may be nearer. Returns 0 on the
    /// surface, if the pseudonormal is zero, or if rounding would decide. The result is exact above faces. It is also
    /// exact above edges for which both faces give the same side.
    [[nodiscard]] int side(std::uint32_t triangle, const ClosestPointOnTriangle& nearest, const Vec3& p) const;

    /// Returns true if the feature is an edge of an odd number of triangles, or a vertex at the end of such an edge.
    /// The side is undefined at such features.
    [[nodiscard]] bool is_on_boundary(std::uint32_t triangle, TriangleFeature feature) const;

    /// Returns the bytes in use besides the vertices and triangles: about 30 per triangle for a closed mesh.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    /// The neighbour across a side of a triangle: another triangle, or (with kIrregularEdge added) an entry of
    /// irregular_edges_.
    using Neighbour = std::uint32_t;

    /// The side of a triangle from corner `side` to the next.
    struct TriangleSide {
        std::uint32_t triangle;
        std::uint32_t side;
    };

    /// An edge that does not have exactly two triangles.
    struct IrregularEdge {
        Vec3 normal;
        bool is_open = false;
    };

    [[nodiscard]] Vec3 unit_normal_of(std::uint32_t triangle) const;
    [[nodiscard]] int excess_of(std::uint32_t triangle) const;
    [[nodiscard]] std::uint32_t welded(std::uint32_t triangle, std::size_t corner) const;
    [[nodiscard]] Vec3 of_edge(std::uint32_t triangle, std::size_t side) const;
    [[nodiscard]] int side_of_face(std::uint32_t triangle, const Vec3& p) const;
    [[nodiscard]] int side_of_edge(std::uint32_t triangle, std::size_t side, const Vec3& p) const;
    [[nodiscard]] int side_of_two_faces(std::uint32_t first, std::uint32_t second, const Vec3& p) const;
    [[nodiscard]] std::size_t weld();
    void link_edges(std::size_t vertex_count);
    void link_edge(std::span<const TriangleSide> sides);
    void record_copies(std::span<const TriangleSide> sides);
    void sum_at_vertices(std::size_t vertex_count);

    std::span<const Vec3> vertices_;
    std::span<const Triangle> triangles_;
    std::uint32_t first_vertex_ = 0;            ///< smallest vertex index of a triangle
    std::vector<std::uint32_t> welded_;         ///< per vertex from first_vertex_ on: index among the distinct vertices
    std::vector<Vec3> at_vertex_;               ///< pseudonormals of the distinct vertices
    std::vector<std::uint8_t> vertex_is_open_;  ///< 1 for ends of open edges
    std::vector<std::array<Neighbour, 3>> sides_;  ///< per triangle: across AB, BC and CA
    std::vector<IrregularEdge> irregular_edges_;
    /// Triangles that are listed several times, ascending. The value is 1 if the triangle's winding is more frequent
    /// than the opposite one, -1 if it is less frequent, and 0 if both are equally frequent.
    std::vector<std::pair<std::uint32_t, int>> copies_;
};

}  // namespace ricochet
