// Integrators that do not conserve the energy of a force give a warning if the energy grows in the run, and only then.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/pair_forces.h"
#include "ricochet/dynamics/springs.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr std::array kKinds{IntegratorKind::ballistic,
                            IntegratorKind::forward_euler,
                            IntegratorKind::symplectic_euler,
                            IntegratorKind::implicit_euler,
                            IntegratorKind::midpoint,
                            IntegratorKind::velocity_verlet,
                            IntegratorKind::rk4,
                            IntegratorKind::dormand_prince};

/// A motion with a conserved energy and an angular frequency near 1.
struct Motion {
    std::string name;
    std::function<std::unique_ptr<Force>()> force;
    Particle particle;
    double kinetic;  // J, about the largest value
};

std::vector<Motion> motions() {
    const auto anchor = [](double length) {
        return [length] { return make_anchor({.position = {}, .stiffness = 1.0, .rest_length = length}); };
    };
    const auto radial = [](double exponent) {
        return [exponent] { return make_radial_force({.center = {}, .strength = 1.0, .exponent = exponent}); };
    };
    const auto gravity = [] { return make_point_gravity({{{0, 0, 0}, 1.0, 0.1}}); };
    const auto magnetic = [] { return make_lorentz_force({.charge = 1.0, .electric = {}, .magnetic = {0, 0, 1}}); };
    return {{"anchor", anchor(0.0), particle_of({1, 0, 0}, {0, 0.5, 0}), 0.5},
            {"anchor with a length", anchor(1.0), particle_of({1.2, 0, 0}), 0.02},
            {"spring force", radial(1.0), particle_of({1, 0, 0}, {0, 0.3, 0.2}), 0.5},
            {"cubic force", radial(3.0), particle_of({1, 0, 0}, {0, 0.9, 0}), 0.5},
            {"inverse square", radial(-2.0), particle_of({1, 0, 0}, {0, 0.9, 0}), 0.85},
            {"point gravity", gravity, particle_of({1, 0, 0}, {0, 1, 0}), 0.5},
            {"magnetic field", magnetic, particle_of({1, 0, 0}, {0, 1, 0}), 0.5}};
}

SimulationSetup setup_with(const Motion& motion, IntegratorKind kind, double step, double duration) {
    SimulationSetup setup = setup_of(step, duration);
    setup.options.integrator.kind = kind;
    setup.forces.push_back(motion.force());
    setup.particles = {motion.particle};
    return setup;
}

double energy_of(const Simulation& simulation) {
    return simulation.kinetic_energy() + simulation.potential_energy().value();
}

/// Returns the growth of the energy in a run, over the largest kinetic energy of the true motion. It compares the last
/// third of the run with the first.
double growth_of(SimulationSetup setup, double kinetic) {
    Simulation simulation(std::move(setup));
    const double before = energy_of(simulation);
    const std::uint64_t steps = simulation.step_count();
    double sum = 0.0;
    std::uint64_t count = 0;
    try {
        while (!simulation.finished()) {
            simulation.step();
            if (simulation.step_index() <= 2 * steps / 3) continue;
            sum += energy_of(simulation) - before;
            ++count;
        }
    } catch (const DivergedError&) {
        return HUGE_VAL;
    }
    if (simulation.statistics().frozen > 0) return HUGE_VAL;
    return sum / static_cast<double>(count) / kinetic;
}

bool has_warning(const std::vector<std::string>& warnings, const std::string& part) {
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

// Steps range from a fiftieth of an oscillation to beyond the stability limit, in runs of 10 to 100 oscillations.
TEST(EnergyWarnings, WarningsAppearExactlyIfTheEnergyGrows) {
    for (const Motion& motion : motions()) {
        for (const IntegratorKind kind : kKinds) {
            for (const double step : {0.01, 0.05, 0.2, 0.5, 1.0, 2.5}) {
                for (const double duration : {60.0, 300.0}) {
                    if (duration / step > 10000.0) continue;
                    // Damped orbits end in the centre, and particles are thrown out from there.
                    if (kind == IntegratorKind::implicit_euler && motion.name == "inverse square") continue;
                    SCOPED_TRACE(motion.name + ", " + std::string(name_of(kind)) + ", step " + std::to_string(step) +
                                 ", duration " + std::to_string(duration));
                    SimulationSetup setup = setup_with(motion, kind, step, duration);
                    const bool warns =
                        has_warning(Simulation(setup_with(motion, kind, step, duration)).warnings(), "keep the energy");
                    const double growth = growth_of(std::move(setup), motion.kinetic);
                    // A bounded error may be large if the steps are almost too long.
                    const bool is_symplectic =
                        kind == IntegratorKind::velocity_verlet || kind == IntegratorKind::symplectic_euler;
                    if (growth > (is_symplectic && motion.name != "magnetic field" ? 20.0 : 0.03)) {
                        EXPECT_TRUE(warns) << "growth " << growth;
                    } else if (growth < 0.003) {
                        EXPECT_FALSE(warns) << "growth " << growth;
                    }
                }
            }
        }
    }
}

TEST(EnergyWarnings, WarningNamesTheForceTheParticleAndAConservingIntegrator) {
    SimulationSetup setup = setup_of(0.05, 60.0, {}, {0, 0, -9.81});
    setup.forces.push_back(make_anchor({.position = {0, 0, 3}, .stiffness = 9.0}));
    setup.particles = {particle_of({1, 0, 3})};
    const std::vector<std::string> warnings = Simulation(std::move(setup)).warnings();
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0].find("the integrator ballistic does not keep the energy of forces[1]: without collisions "
                               "particles[0] would gain "),
              0U)
        << warnings[0];
    EXPECT_NE(warnings[0].find(" in 60 s; use the integrator velocity_verlet or a shorter time_step"),
              std::string::npos)
        << warnings[0];
}

TEST(EnergyWarnings, RecommendedIntegratorGivesNoWarning) {
    SimulationSetup setup = setup_of(0.05, 60.0, {}, {0, 0, -9.81});
    setup.options.integrator.kind = IntegratorKind::velocity_verlet;
    setup.forces.push_back(make_anchor({.position = {0, 0, 3}, .stiffness = 9.0}));
    setup.particles = {particle_of({1, 0, 3})};
    EXPECT_TRUE(Simulation(std::move(setup)).warnings().empty());
}

TEST(EnergyWarnings, DissipationByDragIsTakenIntoAccount) {
    for (const double coefficient : {0.0, 0.5}) {
        SimulationSetup setup = setup_of(0.05, 60.0);
        setup.forces.push_back(make_anchor({.position = {}, .stiffness = 1.0}));
        setup.forces.push_back(make_linear_drag(coefficient));
        setup.particles = {particle_of({1, 0, 0})};
        EXPECT_EQ(has_warning(Simulation(std::move(setup)).warnings(), "keep the energy"), coefficient == 0.0);
    }
}

TEST(EnergyWarnings, ParticlesOfEmittersGiveWarningsToo) {
    SimulationSetup setup = setup_of(0.05, 60.0);
    setup.forces.push_back(make_point_gravity({{{0, 0, 0}, 10.0, 0.1}}));
    EmitterDescription emitter;
    emitter.name = "planets";
    emitter.shape = PointShape{{2, 0, 0}};
    emitter.direction = {0, 1, 0};
    emitter.speed = {2.0, 0.0};
    emitter.rate = {1.0, 0.0};
    setup.emitters = {emitter};
    EXPECT_TRUE(has_warning(Simulation(std::move(setup)).warnings(), "a particle of 'planets' would gain"));
}

TEST(EnergyWarnings, ParticleThatFallsIntoAPointMassGivesAWarning) {
    for (const IntegratorKind kind : kKinds) {
        SCOPED_TRACE(name_of(kind));
        for (const double softening : {0.0, 0.2}) {
            SimulationSetup setup = setup_of(1.0 / 60.0, 1.0);
            setup.options.integrator.kind = kind;
            setup.forces.push_back(make_point_gravity({{{0, 0, 0}, 8.85, softening}}));
            setup.particles = {particle_of({0.03, -0.16, 0.26})};
            EXPECT_EQ(has_warning(Simulation(std::move(setup)).warnings(), "attracts without bound"), softening == 0.0);
        }
    }
}

/// Returns two balls on a spring, with or without damping.
SimulationSetup on_a_spring(IntegratorKind kind, double step, double damping) {
    SimulationSetup setup = setup_of(step, 100.0);
    setup.options.integrator.kind = kind;
    setup.particles = {particle_of({}), particle_of({1.1, 0, 0})};
    setup.springs = {{.first = 0, .second = 1, .rest_length = 1.0, .stiffness = 0.5, .damping = damping}};
    return setup;
}

// The spring's own oscillation is the fastest: omega = 1.
TEST(EnergyWarnings, SpringsGiveWarningsIfTheEnergyGrows) {
    for (const IntegratorKind kind : {IntegratorKind::midpoint, IntegratorKind::velocity_verlet,
                                      IntegratorKind::symplectic_euler, IntegratorKind::rk4}) {
        for (const double step : {0.01, 0.05, 0.2, 0.6}) {
            for (const double damping : {0.0, 0.05}) {
                SCOPED_TRACE(std::string(name_of(kind)) + ", step " + std::to_string(step) + ", damping " +
                             std::to_string(damping));
                const bool warns =
                    has_warning(Simulation(on_a_spring(kind, step, damping)).warnings(), "keep the energy");
                const double growth = growth_of(on_a_spring(kind, step, damping), 0.0025);
                // The energies of symplectic methods oscillate within bounds.
                const bool grows = growth > 0.03 && (kind == IntegratorKind::midpoint || kind == IntegratorKind::rk4);
                if (grows) {
                    EXPECT_TRUE(warns) << growth;
                }
                if (growth < 0.0 || kind != IntegratorKind::midpoint) {
                    EXPECT_EQ(warns, grows) << growth;
                }
            }
        }
    }
}

TEST(EnergyWarnings, ForcesBetweenParticlesGiveAWarningWithMidpoint) {
    for (const IntegratorKind kind : {IntegratorKind::midpoint, IntegratorKind::velocity_verlet}) {
        SimulationSetup setup = setup_of(0.03, 100.0);
        setup.options.integrator.kind = kind;
        setup.particles = {particle_of({}, {}, 0.5), particle_of({1.0, 0, 0}, {}, 0.5)};
        setup.particles_forces = {{make_cohesion({.stiffness = 100.0, .range = 0.3})}};
        EXPECT_EQ(has_warning(Simulation(std::move(setup)).warnings(), "keep the energy"),
                  kind == IntegratorKind::midpoint);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
