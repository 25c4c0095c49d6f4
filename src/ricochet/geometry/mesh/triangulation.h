/// \file
/// Cuts polygons into triangles between their own corners.
///
/// Polygons are cut along diagonals only, so every edge of the outline is an edge of exactly one triangle. A closed
/// polygon mesh therefore gives a closed triangle mesh. The triangles cover every point around which the projected
/// outline winds.
///
/// A polygon is projected along the axis nearest to its normal (Newell's method) and cut by ear clipping. All decisions
/// are signs of exact 2D orientations. If the outline is simple in that projection, the triangles do not overlap. If an
/// outline crosses itself and no ear is left, the rest becomes a fan. The triangles of the fan may overlap, and the
/// face is counted in `crossing_faces`.
///
/// Neighbouring corners at the same vertex count once. A face with fewer than three remaining corners becomes one
/// degenerate triangle. A triangle that names a vertex twice also stays as a degenerate triangle.
///
/// Sources: G. H. Meisters, "Polygons Have Ears", American Mathematical Monthly 82, 1975; M. Held, "FIST: Fast
/// Industrial-Strength Triangulation of Polygons", Algorithmica 30, 2001 (tests against reflex corners only).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Largest number of corners of one polygon. At that size, the slowest known outline takes about 1.5 seconds.
inline constexpr std::size_t kLargestPolygon = 100'000;

/// The triangles of a polygon mesh, in the order of its faces.
struct Triangulation {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> triangle_face;     ///< face of every triangle
    std::size_t faces_with_repeated_corners = 0;  ///< faces that name a vertex twice
    std::size_t crossing_faces = 0;               ///< faces whose projected outline crosses itself
};

/// Cuts all faces into triangles. A face of n different corners gives n - 2 triangles with the winding of the face.
/// Throws InputError if a face has more corners than kLargestPolygon or fewer than 3.
[[nodiscard]] Triangulation triangulate(const PolygonMesh& mesh);

}  // namespace ricochet
