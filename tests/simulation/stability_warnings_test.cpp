// Warnings about time steps that are too long for forces between particles, compared with the actual stability.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/pair_forces.h"
#include "ricochet/dynamics/particles_force.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kRadius = 0.5;
constexpr double kStiffness = 100.0;

Particle grain(const Vec3& position, double mass = 1.0) {
    Particle particle = particle_of(position, {}, kRadius);
    particle.mass = mass;
    return particle;
}

/// Returns cohesive grains at rest with small stretches relative to the range, so that their forces are almost linear.
SimulationSetup sticking(double time_step, double damping, IntegratorKind kind, std::vector<Particle> grains) {
    SimulationSetup setup = setup_of(time_step, 400.0 * time_step);
    setup.options.integrator.kind = kind;
    setup.particles = std::move(grains);
    setup.particles_forces.push_back({make_cohesion({.stiffness = kStiffness, .range = 0.3, .damping = damping})});
    return setup;
}

std::vector<Particle> pair_of(double second_mass) { return {grain({}), grain({1.0 + 1e-7, 0, 0}, second_mass)}; }

/// Returns the closest packing of 108 grains, with positions displaced by about 1e-7 m.
std::vector<Particle> packing() {
    const double edge = std::sqrt(2.0);
    std::vector<Particle> grains;
    for (int k = 0; k < 6 * 6 * 6; ++k) {
        const Vec3 place{double(k % 6), double(k / 6 % 6), double(k / 36)};
        if ((k % 6 + k / 6 % 6 + k / 36) % 2 != 0) continue;
        grains.push_back(
            grain(0.5 * edge * place + 1e-7 * Vec3{std::sin(7.0 * k), std::sin(5.0 * k), std::sin(3.0 * k)}));
    }
    return grains;
}

bool explodes(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    const double before = simulation.potential_energy().value();
    while (!simulation.finished()) simulation.step();
    return simulation.kinetic_energy() + simulation.potential_energy().value() > before + 1e-9;
}

std::vector<std::string> warnings_of(SimulationSetup setup) { return Simulation(std::move(setup)).warnings(); }

TEST(StabilityWarnings, CohesionWarningStartsWhenTwoGrainsExplode) {
    for (const double mass : {1.0, 0.25}) {
        const double inverse = 1.0 + 1.0 / mass;
        for (const double damping : {0.0, 3.0, 100.0}) {
            // h^2 k / m + 2 h c / m = 4
            const double gamma = damping * inverse;
            const double bound = 4.0 / (gamma + std::sqrt(gamma * gamma + 4.0 * kStiffness * inverse));
            const auto scene = [&](double h) {
                return sticking(h, damping, IntegratorKind::velocity_verlet, pair_of(mass));
            };
            SCOPED_TRACE(damping);
            EXPECT_TRUE(warnings_of(scene(0.99 * bound)).empty());
            EXPECT_FALSE(explodes(scene(0.99 * bound)));
            EXPECT_EQ(warnings_of(scene(1.02 * bound)).size(), 1U);
            EXPECT_TRUE(damping > 0.0 || explodes(scene(1.02 * bound)));
            EXPECT_TRUE(explodes(scene(2.1 * bound)));  // the bound for damping has a safety factor of two
        }
    }
}

TEST(StabilityWarnings, CohesionGivesNoWarningUpToTheLimitOfTheClosestPacking) {
    const double bound = 2.0 / std::sqrt(8.0 * kStiffness);  // four times two over the mass
    const auto scene = [](double h) { return sticking(h, 0.0, IntegratorKind::velocity_verlet, packing()); };
    EXPECT_TRUE(warnings_of(scene(0.99 * bound)).empty());
    EXPECT_FALSE(explodes(scene(0.99 * bound)));
    EXPECT_EQ(warnings_of(scene(1.01 * bound)).size(), 1U);
    EXPECT_TRUE(explodes(scene(1.1 * bound)));
}

TEST(StabilityWarnings, WarningHasTheStepTheForceAndAdvice) {
    EXPECT_EQ(warnings_of(sticking(0.2, 2.0, IntegratorKind::velocity_verlet, pair_of(1.0))),
              (std::vector<std::string>{
                  "the time step of 0.2 s exceeds 0.123 s, up to which velocity_verlet is sure to be stable with what "
                  "is held together by particle_forces[0] (stiffness 100 N/m, damping 2 N s/m, lightest particle 1 "
                  "kg): they may explode; use a shorter step or a weaker force"}));
    EXPECT_EQ(warnings_of(sticking(0.2, 0.0, IntegratorKind::forward_euler, pair_of(1.0))),
              (std::vector<std::string>{
                  "forward_euler is not stable at any time step with particle_forces[0] (stiffness 100 N/m, lightest "
                  "particle 1 kg), which has no damping: they may explode; give it damping of more than the time step "
                  "times its stiffness, or use the integrator symplectic_euler or velocity_verlet"}));
}

TEST(StabilityWarnings, AlmostEqualStepsArePrintedWithEnoughDigits) {
    const double bound = 2.0 / std::sqrt(200.0);
    const auto lines =
        warnings_of(sticking(std::nextafter(bound, 1.0), 0.0, IntegratorKind::velocity_verlet, pair_of(1.0)));
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NE(lines[0].find("step of 0.1414213562373"), std::string::npos) << lines[0];
    const auto at = lines[0].find("exceeds ") + 8;
    EXPECT_NE(lines[0].substr(17, lines[0].find(" s", 17) - 17), lines[0].substr(at, lines[0].find(" s", at) - at))
        << lines[0];
}

/// Returns two grains of 1 kg and two of 100 kg. The step is above the bound of the light ones alone, 0.141 s.
SimulationSetup light_and_heavy(std::vector<std::uint64_t> taking_part) {
    std::vector<Particle> grains = pair_of(1.0);
    grains.push_back(grain({5, 0, 0}, 100.0));
    grains.push_back(grain({9, 0, 0}, 100.0));
    SimulationSetup setup = sticking(0.2, 0.0, IntegratorKind::velocity_verlet, std::move(grains));
    setup.particles_forces[0].particles = std::move(taking_part);
    return setup;
}

SimulationSetup emitted(double mass) {
    SimulationSetup setup = sticking(0.2, 0.0, IntegratorKind::velocity_verlet, {});
    setup.emitters.resize(1);
    setup.emitters[0].mass.mean = mass;
    return setup;
}

TEST(StabilityWarnings, OnlyParticipatingParticlesCount) {
    EXPECT_EQ(warnings_of(light_and_heavy({})).size(), 1U);
    EXPECT_EQ(warnings_of(light_and_heavy({0, 1})).size(), 1U);
    EXPECT_TRUE(warnings_of(light_and_heavy({2, 3})).empty());
    EXPECT_TRUE(warnings_of(light_and_heavy({0})).empty()) << "a single particle has no partner";
    EXPECT_EQ(warnings_of(emitted(1.0)).size(), 1U);
    EXPECT_TRUE(warnings_of(emitted(100.0)).empty());
}

TEST(StabilityWarnings, LennardJonesWarningUsesTheCurvatureOfTheWell) {
    const auto scene = [](double h) {
        SimulationSetup setup = setup_of(h, h);
        setup.particles = {grain({}), grain({2, 0, 0})};
        setup.particles_forces.push_back({make_lennard_jones({.depth = 3.0, .diameter = 0.5})});
        return setup;
    };
    const double curvature = 72.0 / std::cbrt(2.0) * 3.0 / 0.25;
    const double bound = 2.0 / std::sqrt(2.0 * curvature);
    EXPECT_TRUE(warnings_of(scene(0.999 * bound)).empty());
    EXPECT_EQ(warnings_of(scene(1.001 * bound)).size(), 1U);
}

/// Returns two particles that repel each other from a third of their equilibrium distance.
SimulationSetup repelling(double time_step, double distance) {
    SimulationSetup setup = setup_of(time_step, 2000.0 * time_step);
    setup.options.integrator.kind = IntegratorKind::velocity_verlet;
    setup.particles = {grain({}), grain({distance, 0, 0})};
    setup.particles_forces.push_back({make_lennard_jones({.depth = 1.0, .diameter = 1.0})});
    return setup;
}

double energy_gain(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    const double before = simulation.potential_energy().value();
    while (!simulation.finished()) simulation.step();
    return (simulation.kinetic_energy() + simulation.potential_energy().value()) / before;
}

// U'' = 24 depth / r^2 (26 s^2 - 7 s) with s = (diameter / r)^6
TEST(StabilityWarnings, InitialOverlapGivesAWarningForTheFirstSteps) {
    for (const double distance : {0.5, 0.7, 0.9}) {
        SCOPED_TRACE(distance);
        const double s = std::pow(distance, -6.0);
        const double curvature = 24.0 / (distance * distance) * (26.0 * s * s - 7.0 * s);
        const double bound = 2.0 / std::sqrt(2.0 * curvature);
        EXPECT_TRUE(warnings_of(repelling(0.999 * bound, distance)).empty());
        const auto warnings = warnings_of(repelling(1.001 * bound, distance));
        ASSERT_EQ(warnings.size(), 1U);
        EXPECT_NE(warnings[0].find("while particles are as near to each other as at the start: they may explode; place "
                                   "them farther apart, or use a shorter step"),
                  std::string::npos)
            << warnings[0];
        EXPECT_NEAR(energy_gain(repelling(0.05 * bound, distance)), 1.0, 1e-2);
        EXPECT_GT(energy_gain(repelling(4.0 * bound, distance)), 2.0);
    }
}

// Each of n grains at about one position presses on all others. In an isotropic cloud, the stiffness of the mode in
// which one grain moves against the others is n k / 3 over its mass.
TEST(StabilityWarnings, AllNeighboursCountForManyGrainsAtOnePosition) {
    std::vector<Particle> grains;
    for (int k = 0; k < 120; ++k) {
        grains.push_back(grain(0.2 * Vec3{std::sin(1.0 + 7.0 * k), std::sin(2.0 + 5.0 * k), std::sin(3.0 + 3.0 * k)}));
    }
    const auto scene = [&](double h) { return sticking(h, 0.0, IntegratorKind::velocity_verlet, grains); };
    const double closest_packing = 2.0 / std::sqrt(8.0 * kStiffness);
    EXPECT_EQ(warnings_of(scene(0.9 * closest_packing)).size(), 1U);
    EXPECT_TRUE(explodes(scene(0.9 * closest_packing)));
    const double bound = 2.0 / std::sqrt(2.0 * 119.0 * kStiffness);  // as if all were in one line
    EXPECT_TRUE(warnings_of(scene(bound)).empty());
}

TEST(StabilityWarnings, PinnedAndUninvolvedParticlesGiveNoWarningAtTheStart) {
    SimulationSetup pinned = repelling(0.1, 0.5);
    pinned.particles[0].pinned = pinned.particles[1].pinned = true;
    EXPECT_TRUE(warnings_of(std::move(pinned)).empty());
    SimulationSetup others = repelling(0.1, 0.5);
    others.particles.push_back(grain({9, 0, 0}));
    others.particles_forces[0].particles = {1, 2};
    EXPECT_TRUE(warnings_of(std::move(others)).empty());
}

/// Returns the error that ends a run; empty if it does not diverge.
std::string end_of(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    try {
        while (!simulation.finished()) simulation.step();
    } catch (const DivergedError& error) {
        return error.what();
    }
    return "";
}

/// Returns two spheres joined by a spring that explodes.
SimulationSetup exploding_spring(IntegratorKind kind, bool with_contacts) {
    SimulationSetup setup = setup_of(0.1, 1e3);
    setup.options.integrator.kind = kind;
    setup.particles = {grain({}), grain({1.5, 0, 0})};
    setup.springs = {{0, 1, 1.4, 1e5, 0.0}};
    if (with_contacts) setup.options.particle_contacts = PairContactSettings{};
    return setup;
}

TEST(StabilityAdvice, ImplicitMethodIsNamedOnlyIfTheSceneMayUseIt) {
    const IntegratorKind verlet = IntegratorKind::velocity_verlet;
    EXPECT_NE(warnings_of(exploding_spring(verlet, false)).at(0).find("implicit_euler"), std::string::npos);
    EXPECT_NE(end_of(exploding_spring(verlet, false)).find("more damping, or the integrator implicit_euler"),
              std::string::npos);
    const std::string warning = warnings_of(exploding_spring(verlet, true)).at(0);
    EXPECT_EQ(warning.find("implicit_euler"), std::string::npos) << warning;
    const std::string line = end_of(exploding_spring(verlet, true));
    EXPECT_NE(line.find("more damping, or weaker springs and forces between particles"), std::string::npos) << line;
    const auto undamped = warnings_of(exploding_spring(IntegratorKind::forward_euler, true));
    EXPECT_NE(undamped.at(0).find("use the integrator symplectic_euler or velocity_verlet"), std::string::npos);
}

/// Returns two particles that gravity, mutual or uniform, accelerates beyond the speed of light.
SimulationSetup thrown_by_gravity(bool between_particles) {
    SimulationSetup setup = setup_of(1.0, 100.0, {}, between_particles ? Vec3{} : Vec3{1e12, 0, 0});
    setup.options.integrator.kind = IntegratorKind::velocity_verlet;
    setup.particles = {grain({}), grain({1, 0, 0})};
    GravitySettings gravity;
    gravity.constant = 1e12;
    if (between_particles) setup.particles_forces = {{make_mutual_gravity(gravity)}};
    return setup;
}

TEST(StabilityAdvice, AdviceForARunawayFitsTheScene) {
    EXPECT_NE(end_of(thrown_by_gravity(false)).find("a shorter time step, the integrator implicit_euler, or weaker"),
              std::string::npos);
    const std::string line = end_of(thrown_by_gravity(true));
    EXPECT_EQ(line.find("implicit_euler"), std::string::npos) << line;
    EXPECT_FALSE(line.empty());
}

TEST(StabilityAdvice, SphereHitByAFasterOneNamesThatOne) {
    SimulationSetup setup = setup_of(1e-3, 1e-2);
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.5};
    setup.particles = {grain({}), grain({2, 0, 0})};
    setup.particles[0].velocity = {1e70, 0, 0};
    EXPECT_EQ(
        end_of(std::move(setup)),
        "by t = 0.001 s particle 1 has come to 7.5e+69 m/s, beyond the speed of light, and particle 0 has set out "
        "at 1e+70 m/s: let no particle set out faster than light");
}

/// Returns a setup in which each sphere breaks into six pieces at an impact.
SimulationSetup pieces(double softening, double count, bool share) {
    SimulationSetup setup = setup_of(1e-3, 1e-2);
    setup.emitters.resize(2);
    setup.emitters[1].name = "pieces";
    setup.emitters[1].parent =
        ParentRule{.emitter = 0, .on = BirthEvent::impact, .count = {count, 0.0}, .share = share};
    GravitySettings gravity;
    gravity.softening = softening;
    setup.particles_forces = {{make_mutual_gravity(gravity)}};
    return setup;
}

TEST(BirthWarnings, ChildrenThatAForceWithoutSofteningThrowsApartGiveAWarning) {
    EXPECT_EQ(warnings_of(pieces(0.0, 6.0, true)),
              (std::vector<std::string>{
                  "children of 'pieces' begin where their parent is, in each other, and particle_forces[0], which has "
                  "no softening, may throw them apart at any speed: give it a softening of about their radius, or "
                  "leave them out of it"}));
    EXPECT_EQ(warnings_of(pieces(0.0, 1.0, false)).size(), 1U);  // beside the parent, which stays
    EXPECT_TRUE(warnings_of(pieces(0.0, 1.0, true)).empty());    // instead of the parent
    EXPECT_TRUE(warnings_of(pieces(0.1, 6.0, true)).empty());
    SimulationSetup others = pieces(0.0, 6.0, true);
    others.particles_forces[0].emitters = {0};
    EXPECT_TRUE(warnings_of(std::move(others)).empty());
}

/// Returns a ball of 1 kg and 1 m under a drag, with the given velocity, without gravity.
SimulationSetup dragged(double time_step, IntegratorKind kind, std::unique_ptr<Force> drag, const Vec3& velocity) {
    SimulationSetup setup = setup_of(time_step, 8.0 * time_step);
    setup.options.integrator.kind = kind;
    setup.particles = {particle_of({}, velocity, 1.0)};
    setup.forces.push_back(std::move(drag));
    return setup;
}

double last_speed(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return length(simulation.particles().velocity[0]);
}

// If h c / m exceeds 2, every step leaves a larger velocity.
TEST(StabilityWarnings, LinearDragWarningStartsWhenTheStepAmplifies) {
    constexpr double kBound = 2.0 / 50.0;
    for (const IntegratorKind kind :
         {IntegratorKind::ballistic, IntegratorKind::velocity_verlet, IntegratorKind::symplectic_euler}) {
        for (const double factor : {0.99, 1.01}) {
            const auto make = [&] { return dragged(factor * kBound, kind, make_linear_drag(50.0), {3, 0, 0}); };
            EXPECT_EQ(last_speed(make()) > 3.0, factor > 1.0) << name_of(kind) << " " << factor;
            EXPECT_EQ(warnings_of(make()).size(), factor > 1.0 ? 1U : 0U) << name_of(kind) << " " << factor;
        }
    }
    EXPECT_TRUE(warnings_of(dragged(1.0, IntegratorKind::implicit_euler, make_linear_drag(50.0), {3, 0, 0})).empty());
    EXPECT_TRUE(warnings_of(dragged(1.0, IntegratorKind::dormand_prince, make_linear_drag(50.0), {3, 0, 0})).empty());
}

// With the force k |v| v, one step reverses v at h k |v| / m = 1.
TEST(StabilityWarnings, QuadraticDragWarningStartsWhenAStepReversesTheVelocity) {
    for (const double factor : {0.99, 1.01}) {
        const Vec3 velocity{3, 4, 0};
        SimulationSetup setup =
            dragged(factor / (2.0 * 5.0), IntegratorKind::ballistic, make_quadratic_drag(2.0), velocity);
        EXPECT_EQ(warnings_of(std::move(setup)).size(), factor > 1.0 ? 1U : 0U) << factor;
        setup = dragged(factor / (2.0 * 5.0), IntegratorKind::ballistic, make_quadratic_drag(2.0), velocity);
        Simulation simulation(std::move(setup));
        simulation.step();
        EXPECT_EQ(dot(simulation.particles().velocity[0], velocity) < 0.0, factor > 1.0) << factor;
    }
}

// The terminal speed is sqrt(m g / k), at which 2 k v / m = 2 sqrt(k g / m).
TEST(StabilityWarnings, DragWarningConsidersTheTerminalSpeed) {
    for (const double factor : {0.98, 1.02}) {
        SimulationSetup setup =
            dragged(factor / std::sqrt(200.0), IntegratorKind::ballistic, make_quadratic_drag(20.0), {});
        setup.forces.push_back(make_gravity({0, 0, -10}));
        EXPECT_EQ(warnings_of(std::move(setup)).size(), factor > 1.0 ? 1U : 0U) << factor;
    }
}

TEST(StabilityWarnings, DragWarningUsesTheLightestAndLargestParticleOfAnEmitter) {
    SimulationSetup setup = setup_of(0.01, 0.1);
    EmitterDescription emitter;
    emitter.name = "mist";
    emitter.shape = PointShape{};
    emitter.burst = 1;
    emitter.mass = {1.0, 0.5};
    emitter.radius = {0.1, 0.02};
    setup.emitters.push_back(emitter);
    const double rate = 6.0 * std::numbers::pi * 100.0 * 0.12 / 0.5;
    setup.forces.push_back(make_stokes_drag(100.0));
    ASSERT_GT(0.01 * rate, 2.0);
    const std::vector<std::string> warnings = warnings_of(std::move(setup));
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("particles of 'mist' (mass 0.5 kg, radius 0.12 m"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find("use a time_step of at most 0.00442 s or the integrator implicit_euler"),
              std::string::npos)
        << warnings[0];
}

TEST(StabilityWarnings, DragWarningPairsTheSmallestRadiusWithTheMassOfItsDensity) {
    SimulationSetup setup = setup_of(0.01, 0.1);
    setup.emitters.resize(1);
    setup.emitters[0].density = 1000.0;
    setup.emitters[0].radius = {0.003, 0.002};
    setup.forces.push_back(make_stokes_drag(1.0));
    const std::vector<std::string> warnings = warnings_of(std::move(setup));
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("(mass 4.19e-06 kg, radius 0.001 m"), std::string::npos) << warnings[0];
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
