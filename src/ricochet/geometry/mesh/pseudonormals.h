/// \file
/// Angle-weighted pseudonormals: the side of a mesh that a point is on, from its closest point alone.
///
/// Method: J. A. Baerentzen, H. Aanaes, "Signed distance computation using the angle weighted pseudonormal", IEEE TVCG
/// 11(3), 2005. For triangles that bound a solid and are wound outward, the scalar product with the offset from the
/// closest point to p is positive outside and negative inside, also at edges of four faces or more and in nested
/// shells. Vertices at the same position are the same (0 and -0 are equal); triangles with collinear corners are left
/// out.
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

/// Immutable after construction; safe from any number of threads. All sums run in the order of the triangles.
class Pseudonormals {
public:
    /// `vertices` and `triangles` must outlive it; finite, within the predicates' range.
    Pseudonormals(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

    /// True for triangles whose corners are collinear, for which the functions below are undefined.
    [[nodiscard]] bool is_left_out(std::uint32_t triangle) const;

    /// The pseudonormal of a part of a triangle, as the weighted mean of unit normals: at most of unit length. Zero
    /// where normals cancel to rounding (kPseudonormalRounding): two sheets back to back. That includes faces that are
    /// listed as often with one winding as with the other.
    [[nodiscard]] Vec3 of(std::uint32_t triangle, TriangleFeature feature) const;

    /// The side that p is on, where `nearest` is what closest_point_on_triangle() said about p and that triangle and no
    /// triangle of the mesh is nearer: +1 where the normals point to, -1 behind, 0 on the surface, where the
    /// pseudonormal is zero, or where rounding would decide. Exact over faces, and over edges where both faces agree.
    [[nodiscard]] int side(std::uint32_t triangle, const ClosestPointOnTriangle& nearest, const Vec3& p) const;

    /// True when the feature is an edge of an odd number of triangles, or a vertex at the end of one: sides are
    /// undefined.
    [[nodiscard]] bool is_on_boundary(std::uint32_t triangle, TriangleFeature feature) const;

    /// Bytes held besides the vertices and triangles: some 30 a triangle for a closed mesh.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    /// What is across a side of a triangle: another triangle, or (with kIrregularEdge added) an entry of
    /// irregular_edges_.
    using Neighbour = std::uint32_t;

    /// The side from corner `side` of a triangle to the next.
    struct TriangleSide {
        std::uint32_t triangle;
        std::uint32_t side;
    };

    /// An edge that has not exactly two triangles.
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
    std::uint32_t first_vertex_ = 0;               ///< the smallest that a triangle names
    std::vector<std::uint32_t> welded_;            ///< per vertex from there on: its index among the different ones
    std::vector<Vec3> at_vertex_;                  ///< pseudonormals of the different vertices
    std::vector<std::uint8_t> vertex_is_open_;     ///< 1 for ends of open edges
    std::vector<std::array<Neighbour, 3>> sides_;  ///< per triangle: beyond AB, BC and CA
    std::vector<IrregularEdge> irregular_edges_;
    /// Triangles listed several times, ascending: 1 when more often with this winding than with the opposite one, -1
    /// when less often, 0 when as often.
    std::vector<std::pair<std::uint32_t, int>> copies_;
};

}  // namespace ricochet
