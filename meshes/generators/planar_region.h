/// \file
/// Triangulated regions of the plane: the cross-sections that layered_extrusion() turns into solids.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// A point of the plane, metres.
struct Point2 {
    double x = 0.0;
    double y = 0.0;
};

/// Counter-clockwise triangles in the plane, each belonging to one of up to 32 parts, which slabs take or leave out.
struct PlanarRegion {
    std::vector<Point2> points;
    std::vector<Triangle> triangles;
    std::vector<std::uint8_t> parts;  ///< part number of every triangle, below 32
};

/// The cells (i, j) of the grid spanned by increasing xs and ys for which solid(i, j) holds, two triangles each. Cells
/// that meet only at a corner would make a non-manifold solid: callers avoid them. All triangles are of part 0.
[[nodiscard]] PlanarRegion lattice_region(std::span<const double> xs, std::span<const double> ys,
                                          const std::function<bool(std::size_t i, std::size_t j)>& solid);

/// The whole rectangle [0, width] x [0, height] with cells of about the edge length.
[[nodiscard]] PlanarRegion rectangle_region(double width, double height, double edge_length);

/// The band between one loop of a nested family and the next.
struct Band {
    int subdivisions = 1;   ///< rings of cells across the band
    std::uint8_t part = 0;  ///< part of its triangles
};

/// Nested loops around the origin, innermost first, all with the same number of points, counter-clockwise, points of
/// equal index on one ray from the origin. bands[i] lies between loops[i] and loops[i + 1]. With core_part >= 0 the
/// innermost loop is closed by a fan about the origin of that part.
[[nodiscard]] PlanarRegion nested_region(const std::vector<std::vector<Point2>>& loops, std::span<const Band> bands,
                                         int core_part = -1);

/// A circle about the origin as a loop of points.
[[nodiscard]] std::vector<Point2> circle_loop(double radius, int points);

/// Values from first to last in steps of about the edge length, at least one step.
[[nodiscard]] std::vector<double> even_steps(double first, double last, double edge_length);

/// Number of steps of about the edge length in a length, at least `fewest`.
[[nodiscard]] int steps_in(double length, double edge_length, int fewest = 1);

}  // namespace ricochet::meshes
