// Targets that read tables of numbers: particles as text, flows on grids, frames.
#include <cmath>
#include <variant>

#include "fuzz/fuzz_targets.h"
#include "fuzz/memory_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/io/scene/context.h"
#include "ricochet/io/vti_reader.h"
#include "run/vtp_reader.h"

namespace ricochet::fuzz {

bool fuzz_csv(std::string_view bytes) {
    const std::vector<AttributeDescription> declared = {{"heat", 1, {20, 0, 0}}, {"wind", 3, {}}};
    const detail::ParticleTable table = detail::parse_particle_table(bytes, "fuzz.csv", declared);
    for (const Particle& p : table.particles) {
        require(max_abs(p.position) <= kLargestCoordinate && max_abs(p.velocity) <= kLargestCoordinate,
                "positions and velocities are in range");
        require(p.mass > 0.0 && std::isfinite(p.mass) && p.radius >= 0.0 && std::isfinite(p.radius),
                "masses and radii are in range");
        require(p.attributes.size() <= table.attributes.size(), "attributes have columns");
    }
    require(table.errors.size() <= 16, "the number of errors is bounded");
    return table.errors.empty();
}

bool fuzz_vti(std::string_view bytes) {
    const MemoryFile file(bytes);
    try {
        VectorGrid grid = read_vti(file.path());
        for (const Vec3& value : grid.values) require(is_finite(value), "values are finite");
        const Vec3 corner = grid.origin;
        const FlowPointer flow = make_grid_flow(std::move(grid));
        for (const Vec3& p : {Vec3{}, corner, corner + Vec3{0.3, 0.2, 0.1}, Vec3{1e75, -1e75, 1e75}}) {
            static_cast<void>(flow->velocity(p, 0.0));
        }
    } catch (const InputError&) {
        return false;
    }
    return true;
}

bool fuzz_vtp(std::string_view bytes) {
    const MemoryFile file(bytes);
    VtkPolyData data;
    try {
        data = read_vtp(file.path());
    } catch (const InputError&) {
        return false;
    }
    for (const VtkArray& array : data.point_arrays) {
        require(array.size() == data.points.size(), "arrays of points are as long as the list of points");
        require(scalar_values(array).size() == array.size(), "every entry has a number");
    }
    for (const VtkArray& array : data.cell_arrays) {
        require(array.size() == data.cell_count(), "arrays of cells are as long as the list of cells");
    }
    const auto names_points = [&](const auto& cells) {
        for (const auto& cell : cells) {
            for (const std::uint32_t corner : cell) require(corner < data.points.size(), "corners are points");
        }
    };
    names_points(data.lines);
    names_points(data.triangles);
    return true;
}

}  // namespace ricochet::fuzz
