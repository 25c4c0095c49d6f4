/// \file
/// Polygons cut into triangles between their own corners.
///
/// Polygons are cut along diagonals only, so that every edge of the outline is an edge of exactly one triangle, a
/// closed polygon mesh gives a closed triangle mesh, and the triangles cover every point that the projected outline
/// winds around.
///
/// A polygon is projected along the axis nearest to its normal (Newell's method) and cut by ear clipping; all decisions
/// are signs of exact 2D orientations. The triangles of an outline that is simple in that projection do not overlap. An
/// outline that crosses itself is fanned where no ear is left, may overlap, and is counted in `crossing_faces`.
///
/// Neighbouring corners that are the same vertex count once; a face with fewer than three corners left, and a triangle
/// that names a vertex twice, stay as one degenerate triangle.
///
/// Sources: G. H. Meisters, "Polygons Have Ears", American Mathematical Monthly 82, 1975; M. Held, "FIST: Fast
/// Industrial-Strength Triangulation of Polygons", Algorithmica 30, 2001 (tests against reflex corners only).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Largest number of corners of one polygon: the slowest outline known takes about a second and a half at that size.
inline constexpr std::size_t kLargestPolygon = 100'000;

/// The triangles of a polygon mesh, in the order of its faces.
struct Triangulation {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> triangle_face;     ///< face of every triangle
    std::size_t faces_with_repeated_corners = 0;  ///< faces that name a vertex twice
    std::size_t crossing_faces = 0;               ///< faces whose projected outline crosses itself
};

/// Cuts all faces. A face of n different corners gives n - 2 triangles with its winding.
/// Throws InputError when a face has more corners than kLargestPolygon or fewer than 3.
[[nodiscard]] Triangulation triangulate(const PolygonMesh& mesh);

}  // namespace ricochet
