#include "generators/primitives.h"

#include <vector>

#include "generators/layered_extrusion.h"
#include "generators/placement.h"
#include "generators/require.h"

namespace ricochet::meshes {
namespace {

/// Returns an isosceles triangle from the origin along x, divided into n^2 triangles.
PlanarRegion wedge_region(double length, double opening, int n) {
    PlanarRegion region;
    for (int i = 0; i <= n; ++i) {  // column i has i + 1 points
        const double x = length * i / n;
        for (int j = 0; j <= i; ++j) region.points.push_back({x, opening * (2 * j - i) / (2 * n)});
    }
    const auto point = [](int i, int j) { return static_cast<std::uint32_t>(i * (i + 1) / 2 + j); };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j <= i; ++j) {
            region.triangles.push_back({point(i, j), point(i + 1, j), point(i + 1, j + 1)});
            if (j < i) region.triangles.push_back({point(i, j), point(i + 1, j + 1), point(i, j + 1)});
        }
    }
    region.parts.assign(region.triangles.size(), 0);
    return region;
}

/// Returns lattice lines at every step and evenly in between. Each is computed from its index, so that equal lines have
/// equal bits.
std::vector<double> step_lines(int steps, double size, std::size_t pieces) {
    std::vector<double> lines;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(steps) * pieces; ++i) {
        lines.push_back(size * static_cast<double>(i) / static_cast<double>(pieces));
    }
    return lines;
}

}  // namespace

TriangleMesh make_box(const BoxShape& shape, double edge_length) {
    require_length("box", "length", shape.length);
    require_length("box", "width", shape.width);
    require_length("box", "height", shape.height);
    return moved(extrusion(rectangle_region(shape.length, shape.width, edge_length), shape.height, edge_length),
                 {-0.5 * shape.length, -0.5 * shape.width, -0.5 * shape.height});
}

TriangleMesh make_plate(const PlateShape& shape, double edge_length) {
    require_length("plate", "length", shape.length);
    require_length("plate", "width", shape.width);
    const PlanarRegion region = rectangle_region(shape.length, shape.width, edge_length);
    TriangleMesh mesh;
    mesh.triangles = region.triangles;
    mesh.vertices.reserve(region.points.size());
    for (const Point2& p : region.points) {
        mesh.vertices.push_back({p.x - 0.5 * shape.length, p.y - 0.5 * shape.width, 0.0});
    }
    return mesh;
}

TriangleMesh make_wedge(const WedgeShape& shape, double edge_length) {
    require_length("wedge", "length", shape.length);
    require_length("wedge", "opening", shape.opening);
    require_length("wedge", "width", shape.width);
    const PlanarRegion side = wedge_region(shape.length, shape.opening, steps_in(shape.length, edge_length));
    return moved(stood_up(extrusion(side, shape.width, edge_length)), {0.0, 0.5 * shape.width, 0.0});
}

TriangleMesh make_staircase(const StaircaseShape& shape, double edge_length) {
    require_between("staircase", "steps", shape.steps, 1, 10000);
    require_length("staircase", "run", shape.run);
    require_length("staircase", "rise", shape.rise);
    require_length("staircase", "width", shape.width);
    const auto across = static_cast<std::size_t>(steps_in(shape.run, edge_length));
    const auto up = static_cast<std::size_t>(steps_in(shape.rise, edge_length));
    const PlanarRegion side = lattice_region(
        step_lines(shape.steps, shape.run, across), step_lines(shape.steps, shape.rise, up),
        [&](std::size_t i, std::size_t j) { return i / across + j / up < static_cast<std::size_t>(shape.steps); });
    return moved(stood_up(extrusion(side, shape.width, edge_length)), {0.0, 0.5 * shape.width, 0.0});
}

}  // namespace ricochet::meshes
