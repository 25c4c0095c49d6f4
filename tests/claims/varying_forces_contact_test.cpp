// Persistent contact under varying forces: drag, springs and central attraction. The motion has the order of the
// integrator. Energy is conserved if the forces have a potential.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "claims/contact_scene.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

using MakeForces = std::function<std::vector<std::unique_ptr<Force>>()>;

std::vector<std::unique_ptr<Force>> list_of(std::unique_ptr<Force> first, std::unique_ptr<Force> second) {
    std::vector<std::unique_ptr<Force>> forces;
    forces.push_back(std::move(first));
    forces.push_back(std::move(second));
    return forces;
}

Simulation simulation_with(const ContactScene& scene, std::vector<std::unique_ptr<Force>> forces) {
    SimulationSetup setup;
    setup.options.time_step = scene.time_step;
    setup.options.duration = scene.duration;
    setup.options.integrator = scene.integrator;
    setup.options.verify = true;
    setup.forces = std::move(forces);
    setup.materials = scene.materials;
    setup.colliders = scene.colliders;
    setup.particles.push_back(scene.particle);
    return Simulation(std::move(setup));
}

Particle end_with(const ContactScene& scene, std::vector<std::unique_ptr<Force>> forces) {
    Simulation simulation = simulation_with(scene, std::move(forces));
    while (!simulation.finished()) simulation.step();
    expect_no_time_lost(simulation);
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    return simulation.particles().at(0);
}

/// Returns a point or a sphere on the plane z = 0. With friction, the sphere rolls.
ContactScene on_a_plane(double radius, double friction, const Vec3& place, const Vec3& velocity) {
    ContactScene scene;
    scene.colliders = {{"floor", PlaneShape{{}, {0, 0, 1}}, 0}};
    scene.materials = {{"", 0.0, friction}};
    const bool rolls = radius > 0.0 && friction > 0.0;
    const Vec3 spin = rolls ? Vec3{-velocity.y / radius, velocity.x / radius, 0} : Vec3{};
    scene.particle = particle_of(place + Vec3{0, 0, radius + 1e-13}, velocity, radius, spin);
    return scene;
}

std::vector<IntegratorKind> methods_of_second_order() {
    return {IntegratorKind::midpoint, IntegratorKind::velocity_verlet, IntegratorKind::rk4};
}

/// Expects an error in x as small as that of the midpoint rule. At half the step, the error must fall by at least the
/// factor 3.8.
void expect_second_order(ContactScene scene, const MakeForces& forces, double expected) {
    for (const IntegratorKind kind : methods_of_second_order()) {
        scene.integrator = kind;
        const auto error = [&](double step) {
            scene.time_step = step;
            return std::fabs(end_with(scene, forces()).position.x - expected);
        };
        const double coarse = error(0.1);
        const double fine = error(0.05);
        EXPECT_LT(coarse, 4e-3) << name_of(kind);  // relative error (c dt)^2 / 6 of the path
        EXPECT_LT(fine, coarse / 3.8 + 1e-12) << name_of(kind);
    }
}

TEST(LinearDrag, BrakesSlidingAndRollingParticlesToSecondOrder) {
    const MakeForces forces = [] { return list_of(make_gravity({0, 0, -kStandardGravity}), make_linear_drag(1.0)); };
    // The equation of motion is m v' = -c v. For a rolling sphere, the effective mass is 7/5 m.
    expect_second_order(on_a_plane(0.0, 0.0, {}, {3, 0, 0}), forces, 3.0 * (1.0 - std::exp(-1.0)));
    expect_second_order(on_a_plane(0.1, 100.0, {}, {3, 0, 0}), forces, 4.2 * (1.0 - std::exp(-1.0 / 1.4)));
}

TEST(ASpringAlongAPlane, SwingsSlidingAndRollingParticlesToSecondOrder) {
    for (const auto& [radius, friction, inertia] : {std::tuple{0.0, 0.0, 1.0}, std::tuple{0.1, 100.0, 1.4}}) {
        const double height = radius;
        const MakeForces forces = [height] {
            AnchorSettings anchor;
            anchor.position = {0, 0, height};
            anchor.stiffness = 4.0;
            return list_of(make_gravity({0, 0, -kStandardGravity}), make_anchor(anchor));
        };
        expect_second_order(on_a_plane(radius, friction, {1, 0, 0}, {}), forces, std::cos(std::sqrt(4.0 / inertia)));
    }
}

TEST(LinearDrag, BrakesSlidingParticlesWithinTheToleranceOfDormandPrince) {
    ContactScene scene = on_a_plane(0.0, 0.0, {}, {3, 0, 0});
    scene.time_step = 0.5;
    scene.integrator = Integrator(IntegratorKind::dormand_prince, ErrorTolerance{1e-8, 1e-8});
    const Particle end = end_with(scene, list_of(make_gravity({0, 0, -kStandardGravity}), make_linear_drag(20.0)));
    EXPECT_NEAR(end.position.x, 3.0 / 20.0 * (1.0 - std::exp(-20.0)), 1e-7);
}

// The velocity is v = v0 + b t - s t^2 / 2, where b is 4 m/s^2 minus the deceleration by friction. At the start the
// force exceeds friction, and in the middle of the step the force has reversed. The point stops in between and sticks.
// Contact intervals end within a quarter of their planned time. The error of the force there is at most an eighth of
// its change. This error changes the path by at most a tenth.
TEST(AForceThatTurnsWithinAStep, StopsAPointAtTheTimeOfItsIntegral) {
    constexpr double kForce = 4.0;    // in m/s^2
    constexpr double kSlope = 100.0;  // in m/s^3
    constexpr double kStart = 0.01;   // in m/s
    const double b = kForce - 0.3 * kStandardGravity;
    const double stops = (b + std::sqrt(b * b + 2.0 * kSlope * kStart)) / kSlope;
    const double expected = stops * (kStart + stops * (b / 2.0 - kSlope * stops / 6.0));
    for (const IntegratorKind kind : methods_of_second_order()) {
        ContactScene scene = on_a_plane(0.0, 0.3, {}, {kStart, 0, 0});
        scene.integrator = kind;
        scene.time_step = scene.duration = 0.06;
        const Particle end = end_with(
            scene, list_of(make_gravity({0, 0, -kStandardGravity}), make_acceleration([](const ForceInput& at) {
                               return Vec3{kForce - kSlope * at.time, 0, 0};
                           })));
        EXPECT_NEAR(end.position.x, expected, 0.1 * expected) << name_of(kind);
        EXPECT_EQ(end.velocity, Vec3{}) << name_of(kind);
    }
}

struct RopeCase {
    IntegratorKind integrator;
    std::size_t nodes;
    double stiffness;  // in N/m
    double friction;
    double time_step;  // in s
};

Simulation rope_over_a_box(const RopeCase& c) {
    SimulationSetup setup;
    setup.options.time_step = c.time_step;
    setup.options.duration = 2.0;
    setup.options.integrator = c.integrator;
    setup.options.verify = true;
    setup.forces.push_back(make_gravity({0, 0, -kStandardGravity}));
    setup.materials = {{"", 0.1, c.friction}};
    setup.colliders = {{"box", CuboidShape{{0.4, 0.4, 0.4}, {{0, 0, -0.5}}}, 0}};
    RopeSettings settings;
    settings.from = {0.02, 0, 0};
    settings.to = {0.7, 0, -0.7};
    settings.nodes = c.nodes;
    settings.mass = 0.5;
    settings.radius = 0.02;
    settings.stiffness = c.stiffness;
    settings.damping = 0.2;
    settings.pin_from = true;
    const SpringBody rope = make_rope(settings);
    setup.particles = rope.particles;
    setup.springs = rope.springs;
    return Simulation(std::move(setup));
}

// The rope oscillates more than once per step, and its nodes slip, roll and stick in turn. The forces at both ends of a
// contact interval do not determine the forces in between. An interval that is planned with the forces at its midpoint,
// but ends before it, could gain energy.
TEST(ARopeOverABox, GainsNoEnergyFromIt) {
    for (const RopeCase& c :
         {RopeCase{IntegratorKind::rk4, 12, 500.0, 0.5, 0.01}, RopeCase{IntegratorKind::rk4, 5, 2000.0, 0.3, 0.005},
          RopeCase{IntegratorKind::rk4, 12, 2000.0, 1.0, 0.005},
          RopeCase{IntegratorKind::velocity_verlet, 12, 500.0, 0.3, 0.005},
          RopeCase{IntegratorKind::velocity_verlet, 20, 500.0, 1.0, 0.005}}) {
        SCOPED_TRACE(std::string(name_of(c.integrator)) + ", " + std::to_string(c.nodes) + " nodes");
        Simulation simulation = rope_over_a_box(c);
        simulation.advance(simulation.step_count());
        EXPECT_GT(simulation.statistics().contacts, 20U);
        EXPECT_EQ(simulation.statistics().energy_violations, 0U);
        EXPECT_EQ(simulation.statistics().violations, 0U);
    }
}

/// Returns the largest change of kinetic plus potential energy, relative to the largest kinetic energy.
double worst_change(const ContactScene& scene, std::vector<std::unique_ptr<Force>> forces) {
    Simulation simulation = simulation_with(scene, std::move(forces));
    const auto energy = [&] { return simulation.kinetic_energy() + simulation.potential_energy().value(); };
    const double first = energy();
    double worst = 0.0;
    double moving = 0.0;
    while (!simulation.finished()) {
        simulation.step();
        worst = std::max(worst, std::fabs(energy() - first));
        moving = std::max(moving, simulation.kinetic_energy());
    }
    expect_no_time_lost(simulation);
    return worst / moving;
}

// The run has a hundred swings. The potential has a rounding error of about 1e-16 in each of 30 000 contact intervals.
TEST(ForcesWithAPotential, ConserveTheEnergyOfSlidingAndRollingParticles) {
    for (const auto& [radius, friction] : {std::pair{0.0, 0.0}, std::pair{0.1, 0.0}, std::pair{0.1, 100.0}}) {
        ContactScene scene = on_a_plane(radius, friction, {1, 0, 0}, {0, 0.5, 0});
        scene.integrator = IntegratorKind::velocity_verlet;
        scene.time_step = 0.02;
        scene.duration = 300.0;
        AnchorSettings anchor;
        anchor.position = {0, 0, radius};
        anchor.stiffness = 4.0;
        EXPECT_LT(worst_change(scene, list_of(make_gravity({0, 0, -kStandardGravity}), make_anchor(anchor))), 1e-11)
            << radius << ", " << friction;
    }
}

TEST(ForcesWithAPotential, ConserveTheEnergyOfAMarbleAttractedToABall) {
    ContactScene scene;
    scene.colliders = {{"ball", BallShape{1.0, {}}, 0}};
    scene.materials = {{"", 0.0, 100.0}};
    scene.particle = particle_of({0, 0, 1.1}, {1, 0, 0}, 0.1, {0, 10, 0});
    scene.integrator = IntegratorKind::rk4;
    scene.time_step = 0.02;
    scene.duration = 100.0;
    // The centre of attraction is not the centre of the bowl, so that the force has a component along the marble's
    // path.
    EXPECT_LT(worst_change(scene, list_of(make_point_gravity({{{0.2, 0, 0.1}, 9.81, 0.0}}), make_gravity({}))), 1e-11);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
