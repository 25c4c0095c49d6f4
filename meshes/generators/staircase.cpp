#include "generators/staircase.h"

#include <vector>

#include "generators/layered_extrusion.h"
#include "generators/placement.h"
#include "generators/require.h"

namespace ricochet::meshes {
namespace {

/// Lattice lines at every step and evenly in between, each computed from its index so that equal lines are equal bits.
std::vector<double> step_lines(int steps, double size, std::size_t pieces) {
    std::vector<double> lines;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(steps) * pieces; ++i) {
        lines.push_back(size * static_cast<double>(i) / static_cast<double>(pieces));
    }
    return lines;
}

}  // namespace

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
