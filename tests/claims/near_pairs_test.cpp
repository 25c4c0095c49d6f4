// Tests forces between near pairs of particles in whole runs. Checks energy and momentum, with and without walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "claims/particles_forces_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/pair_forces.h"
#include "ricochet/simulation.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::add_box;
using test::body;
using test::energy;
using test::finished;
using test::momentum;
using test::momentum_scale;
using testing::setup_of;

/// Returns molecules with thermal velocities on a grid with a spacing of 1.15 diameters.
SimulationSetup molecules(int side, double time_step, double duration) {
    SimulationSetup setup = setup_of(time_step, duration);
    setup.options.integrator = IntegratorKind::velocity_verlet;
    RandomSequence draws(3, 5, 0);
    for (int k = 0; k < side * side * side; ++k) {
        const Vec3 at{1.15 * (k % side), 1.15 * (k / side % side), 1.15 * (k / side / side)};
        setup.particles.push_back(body(at - Vec3{1, 1, 1} * (0.575 * (side - 1)), draws.in_unit_ball(), 1.0));
    }
    setup.particles_forces.push_back({make_lennard_jones({})});
    return setup;
}

/// Returns the largest change of the energy in a run, in J. The molecules bounce off a box or fly freely.
double energy_wander(bool in_box, double time_step) {
    SimulationSetup setup = molecules(5, time_step, 4.0);
    if (in_box) add_box(setup, 2.6);
    Simulation run(std::move(setup));
    const double before = energy(run);
    double largest = 0.0;
    while (!run.finished()) {
        run.step();
        largest = std::max(largest, std::fabs(energy(run) - before));
    }
    EXPECT_EQ(run.statistics().contacts > 100, in_box);
    return largest;
}

TEST(LennardJones, ConservesEnergyToTheOrderOfTheMethodWithAndWithoutWalls) {
    for (const bool in_box : {false, true}) {
        const double coarse = energy_wander(in_box, 0.008);
        const double fine = energy_wander(in_box, 0.002);
        EXPECT_LT(coarse, 1.0);
        EXPECT_GT(coarse / fine, 10.0);
    }
}

TEST(LennardJones, ConservesMomentumOverAThousandSteps) {
    SimulationSetup setup = molecules(5, 0.004, 4.0);
    Vec3 before;
    for (const Particle& p : setup.particles) before += p.mass * p.velocity;
    const Simulation run = finished(std::move(setup), {IntegratorKind::velocity_verlet});
    EXPECT_EQ(run.step_count(), 1000U);
    EXPECT_LT(length(momentum(run.particles()) - before), 1e-13 * momentum_scale(run.particles()));
}

// Two cohesive spheres are thrown against a wall. Damping along their connecting line ends their oscillation. Their
// common centre of mass moves like that of a single body.
TEST(Cohesion, KeepsSpheresTogetherAfterABounce) {
    SimulationSetup setup = setup_of(0.001, 2.0);
    setup.particles = {body({0, 0, 1}, {0, 0, -1}, 1.0), body({0.2, 0, 1}, {0, 0, -1}, 1.0)};
    for (Particle& p : setup.particles) p.radius = 0.1;
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}});
    setup.particles_forces.push_back({make_cohesion({500.0, 0.05, 2.0})});
    const Simulation run = finished(std::move(setup), {IntegratorKind::rk4});
    EXPECT_EQ(run.statistics().contacts, 2U);
    const Particles& p = run.particles();
    EXPECT_NEAR(length(p.position[1] - p.position[0]), 0.2, 1e-6);
    EXPECT_NEAR(0.5 * (p.velocity[0].z + p.velocity[1].z), 1.0, 1e-12);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
