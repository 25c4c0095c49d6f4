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

/// Counter-clockwise triangles in the plane. Each belongs to one of up to 32 parts, which a slab can include or omit.
struct PlanarRegion {
    std::vector<Point2> points;
    std::vector<Triangle> triangles;
    std::vector<std::uint8_t> parts;  ///< part number of every triangle, below 32
};

/// Returns the cells (i, j) with solid(i, j) of the grid between increasing xs and ys, with two triangles each. Cells
/// that meet only at a corner would make a non-manifold solid, so callers avoid them. All triangles are of part 0.
[[nodiscard]] PlanarRegion lattice_region(std::span<const double> xs, std::span<const double> ys,
                                          const std::function<bool(std::size_t i, std::size_t j)>& solid);

/// Returns the rectangle [0, width] x [0, height] with cells of about the edge length.
[[nodiscard]] PlanarRegion rectangle_region(double width, double height, double edge_length);

/// Band between two consecutive nested loops.
struct Band {
    int subdivisions = 1;   ///< rings of cells across the band
    std::uint8_t part = 0;  ///< part of its triangles
};

/// Returns the region between nested counter-clockwise loops around the origin, innermost first. All loops have equally
/// many points, and points of equal index are on one ray from the origin. bands[i] lies between loops[i] and loops[i +
/// 1]. With core_part >= 0 a fan of that part about the origin closes the innermost loop.
[[nodiscard]] PlanarRegion nested_region(const std::vector<std::vector<Point2>>& loops, std::span<const Band> bands,
                                         int core_part = -1);

/// Returns a circle about the origin as a loop of points.
[[nodiscard]] std::vector<Point2> circle_loop(double radius, int points);

/// Returns values from first to last in steps of about the edge length, with at least one step.
[[nodiscard]] std::vector<double> even_steps(double first, double last, double edge_length);

/// Returns the number of steps of about the edge length in a length, at least `fewest`.
[[nodiscard]] int steps_in(double length, double edge_length, int fewest = 1);

}  // namespace ricochet::meshes
