// The error of a run when a particle exceeds the speed of light: its speed, and the cause.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/pair_forces.h"
#include "ricochet/dynamics/particles_force.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

std::string end_of(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    try {
        while (!simulation.finished()) simulation.step();
    } catch (const DivergedError& error) {
        return error.what();
    }
    return {};
}

void add_floor(SimulationSetup& setup) { setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0}}; }

TEST(Runaways, BeltAtAlmostTheSpeedOfLightIsNamed) {
    Material belt{.name = "belt", .restitution = 1.0, .friction = 1e9};
    belt.motion.velocity = {2.9e8, 0, 0};
    SimulationSetup setup = setup_of(1e-8, 1e-7, belt);
    add_floor(setup);
    setup.particles = {particle_of({0, 0, 1}, {0, 0, -1e8})};
    const std::string line = end_of(std::move(setup));
    EXPECT_NE(line.find("a surface has thrown particle 0 at 3.07e+08 m/s"), std::string::npos) << line;
}

// The belt moves, but it does not cause the speed.
TEST(Runaways, ForceIsNamedEvenOnABelt) {
    Material slow{.name = "belt", .restitution = 1.0};
    slow.motion.velocity = {1, 0, 0};
    for (const bool is_alone : {true, false}) {
        SimulationSetup setup = setup_of(0.01, 1.0, slow);
        add_floor(setup);
        setup.options.integrator.kind = IntegratorKind::velocity_verlet;
        setup.particles = {particle_of({2, 0, 1e-3}), particle_of({0, 0, 1e-3})};
        if (is_alone) {
            setup.forces.push_back(make_acceleration([](const ForceInput&) { return Vec3{1e12, 0, -1}; }));
        } else {
            GravitySettings gravity;
            gravity.constant = 1e14;
            setup.particles_forces = {{make_mutual_gravity(gravity)}};
        }
        const std::string line = end_of(std::move(setup));
        EXPECT_EQ(line.find("a surface"), std::string::npos) << line;
        EXPECT_NE(line.find(is_alone ? " forces have brought particle"
                                     : "springs or forces between particles have brought particle"),
                  std::string::npos)
            << line;
        EXPECT_EQ(line.find(" 0 m/s"), std::string::npos) << line;
    }
}

TEST(Runaways, CollisionNamesTheSphereOrTheFasterOneThatHitIt) {
    for (const double speed : {2.5e8, 1e9}) {
        SimulationSetup setup = setup_of(1e-9, 1e-7);
        setup.options.particle_contacts = PairContactSettings{};
        setup.particles = {particle_of({}, {speed, 0, 0}, 0.5), particle_of({2, 0, 0}, {}, 0.5)};
        setup.particles[0].mass = 1e6;
        const std::string line = end_of(std::move(setup));
        EXPECT_NE(line.find(speed < 2.9e8 ? "another sphere has thrown particle 1 at 5e+08 m/s"
                                          : "particle 1 has come to 2e+09 m/s"),
                  std::string::npos)
            << line;
    }
}

TEST(Runaways, PenaltyResponseNamesTheContact) {
    SimulationSetup setup = setup_of(0.01, 1.0, {}, {0, 0, -9.81});
    add_floor(setup);
    setup.options.response = ResponseKind::penalty;
    setup.options.penalty.stiffness = 1e30;
    setup.particles = {particle_of({0, 0, 0.01}, {0, 0, -1})};
    const std::string line = end_of(std::move(setup));
    EXPECT_NE(line.find("a contact has thrown particle 0 at "), std::string::npos) << line;
    EXPECT_NE(line.find("penalty"), std::string::npos) << line;
}

TEST(Runaways, AdaptiveMethodGetsNoAdviceToShortenTheStep) {
    SimulationSetup setup = setup_of(0.01, 1.0);
    setup.options.integrator.kind = IntegratorKind::dormand_prince;
    setup.forces.push_back(make_radial_force({.center = {}, .strength = 1e14, .exponent = 1.0}));
    setup.particles = {particle_of({1e3, 0, 0})};
    const std::string line = end_of(std::move(setup));
    EXPECT_NE(line.find("use softening"), std::string::npos) << line;
    EXPECT_EQ(line.find("shorter time step"), std::string::npos) << line;
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
