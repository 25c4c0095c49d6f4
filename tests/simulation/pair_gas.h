/// \file
/// A gas of hard spheres in a closed box, and its known properties.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet::testing {

/// Smooth spheres of radius 1 and mass 1 in a closed box with elastic walls. All have the same initial speed.
struct Gas {
    double packing;
    std::size_t count;
    double restitution;

    [[nodiscard]] double edge() const {
        return std::cbrt(static_cast<double>(count) * 4.0 / 3.0 * std::numbers::pi / packing);
    }

    [[nodiscard]] SimulationSetup setup(double time_step, double duration) const {
        SimulationSetup setup = testing::setup_of(time_step, duration);
        setup.options.resting_speed = 0.0;
        setup.options.particle_contacts = PairContactSettings{.restitution = restitution};
        for (int axis = 0; axis < 3; ++axis) {
            for (const double side : {-1.0, 1.0}) {
                ColliderDescription wall;
                PlaneShape plane{{}, {}};
                plane.point[axis] = 0.5 * side * edge();
                plane.normal[axis] = -side;
                wall.shape = plane;
                setup.colliders.push_back(wall);
            }
        }
        const auto cells = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(count))));
        const double pitch = (edge() - 2.0) / static_cast<double>(cells);
        const double corner = -0.5 * edge() + 1.0 + 0.5 * pitch;
        RandomSequence random(11, 1, 0);
        for (std::size_t k = 0; k < count; ++k) {
            const Vec3 at{static_cast<double>(k % cells), static_cast<double>(k / cells % cells),
                          static_cast<double>(k / cells / cells)};
            setup.particles.push_back(testing::particle_of(Vec3{corner, corner, corner} + pitch * at,
                                                           std::sqrt(3.0) * random.unit_vector(), 1.0));
        }
        return setup;
    }
};

/// Returns Enskog's rate of impacts per particle at temperature 1 and a number density: sqrt(2) n pi d^2 chi times the
/// mean speed.
inline double enskog_rate(double density) {
    const double packing = density * 4.0 / 3.0 * std::numbers::pi;
    const double chi = (1.0 - 0.5 * packing) / std::pow(1.0 - packing, 3);
    const double mean_speed = std::sqrt(8.0 / std::numbers::pi);
    return std::sqrt(2.0) * density * std::numbers::pi * 4.0 * chi * mean_speed;
}

/// Returns true if a position is in the inner half of the box's volume.
inline bool is_inner(const Vec3& x, double edge) {
    const double half = 0.5 * edge * std::cbrt(0.5);
    return std::fabs(x.x) < half && std::fabs(x.y) < half && std::fabs(x.z) < half;
}

/// Returns the number of centres in the inner half of the box's volume, over that volume.
inline double inner_density(const Particles& particles, double edge) {
    std::size_t inside = 0;
    for (const Vec3& x : particles.position) inside += is_inner(x, edge) ? 1 : 0;
    return static_cast<double>(inside) / (0.5 * edge * edge * edge);
}

}  // namespace ricochet::testing
