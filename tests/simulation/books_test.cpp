// The books of mass, momentum and energy over every response, integrator and feature that go together: particles in a
// box without gravity, so that all that they lose the walls have got.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/simulation.h"

namespace ricochet {
namespace {

constexpr std::array<IntegratorKind, 8> kIntegrators{IntegratorKind::ballistic,
                                                     IntegratorKind::forward_euler,
                                                     IntegratorKind::symplectic_euler,
                                                     IntegratorKind::implicit_euler,
                                                     IntegratorKind::midpoint,
                                                     IntegratorKind::velocity_verlet,
                                                     IntegratorKind::rk4,
                                                     IntegratorKind::dormand_prince};
constexpr std::uint32_t kParticles = 12;
constexpr double kMass = 0.5;         // kg, of each
constexpr double kChildMass = 0.125;  // kg
constexpr double kLaunch = 0.4;       // m/s, of fragments
constexpr double kStiffness = 40.0;   // N/m
constexpr double kDuration = 0.6;     // s
constexpr double kEnergy = 12.0;      // J, of the start: twelve of half a kilogram at 2 m/s

enum class Feature { springs, children, absorbing, shattering };
constexpr std::array<Feature, 4> kFeatures{Feature::springs, Feature::children, Feature::absorbing,
                                           Feature::shattering};
constexpr std::array<const char*, 4> kFeatureNames{"springs", "children", "absorbing", "shattering"};

struct Case {
    ResponseKind response;
    IntegratorKind integrator;
    Feature feature;
    bool absorbs = false;  ///< walls do, besides
};

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    for (const ResponseKind response : response_kinds()) {
        for (const IntegratorKind integrator : kIntegrators) {
            const bool is_refused =
                response == ResponseKind::penalty &&
                (integrator == IntegratorKind::implicit_euler || integrator == IntegratorKind::dormand_prince);
            for (const Feature feature : kFeatures) {
                if (!is_refused) cases.push_back({response, integrator, feature, false});
            }
        }
    }
    return cases;
}

std::string name(const Case& c) {
    return std::string(name_of(c.response)) + ", " + std::string(name_of(c.integrator)) + ", " +
           kFeatureNames[static_cast<std::size_t>(c.feature)];
}

std::vector<Particle> moving_particles() {
    RandomSequence random(12, 0, 0);
    std::vector<Particle> particles(kParticles);
    for (std::uint32_t k = 0; k < kParticles; ++k) {
        particles[k].position = {0.2 * (k % 4) - 0.3, 0.2 * (k / 4) - 0.2, 0.05 * (k % 3) - 0.05};
        particles[k].velocity = 2.0 * random.unit_vector();
        particles[k].mass = kMass;
    }
    return particles;
}

/// Each by an emitter of its own, so that it may have children.
void emit(const std::vector<Particle>& particles, const ParentRule& rule, SimulationSetup& setup) {
    for (const Particle& particle : particles) {
        EmitterDescription emitter;
        emitter.name = "parent " + std::to_string(setup.emitters.size());
        emitter.shape = PointShape{particle.position};
        emitter.burst = 1;
        emitter.velocity = particle.velocity;
        emitter.mass = {particle.mass, 0.0};
        setup.emitters.push_back(emitter);
    }
    for (std::uint32_t k = 0; k < particles.size(); ++k) {
        EmitterDescription child;
        child.name = "child " + std::to_string(k);
        child.parent = rule;
        child.parent->emitter = k;
        child.rate = {20.0, 0.0};
        child.mass = {kChildMass, 0.0};
        child.speed = {rule.share ? kLaunch : 0.0, 0.0};
        setup.emitters.push_back(child);
    }
}

SimulationSetup setup_of(const Case& c, double time_step) {
    SimulationSetup setup;
    setup.options.response = c.response;
    setup.options.integrator = c.integrator;
    setup.options.time_step = time_step;
    setup.options.duration = kDuration;
    setup.materials = {{.name = "wall", .restitution = 1.0, .friction = 0.0}};
    setup.colliders = {{"box", CuboidShape{{1, 1, 1}, {}}, 0}};
    const std::vector<Particle> particles = moving_particles();
    ParentRule rule;
    if (c.feature == Feature::absorbing || c.absorbs) setup.materials[0].absorption = 0.3;
    if (c.feature == Feature::springs || c.feature == Feature::absorbing) setup.particles = particles;
    if (c.feature == Feature::springs) {
        for (std::uint64_t k = 1; k < kParticles; ++k) {
            if (k % 4 != 0) setup.springs.push_back({k - 1, k, 0.2, kStiffness, 0.0});
        }
    }
    if (c.feature == Feature::children) {
        rule.on = BirthEvent::life;
        rule.inherit_velocity = 0.0;
        emit(particles, rule, setup);
    }
    if (c.feature == Feature::shattering) {
        rule.on = BirthEvent::impact;
        rule.share = true;
        rule.count = {3.0, 0.0};
        emit(particles, rule, setup);
    }
    return setup;
}

struct Books {
    double mass = 0.0;
    Vec3 momentum;
    double energy = 0.0;
};

/// Of what lives, with what walls have got and what they have swallowed.
Books books_of(const Simulation& simulation) {
    Books books;
    const Particles& particles = simulation.particles();
    for (std::size_t i = 0; i < particles.size(); ++i) {
        books.mass += particles.mass[i];
        books.momentum += particles.mass[i] * particles.velocity[i];
    }
    books.mass += kMass * static_cast<double>(simulation.statistics().absorbed);
    books.energy = simulation.kinetic_energy() + simulation.potential_energy().value();
    for (const Vec3& impulse : simulation.triangle_totals(0).impulse) books.momentum += impulse;
    return books;
}

/// The bounds that theory gives for springs at a step h, with what a run has come to.
struct SpringTheory {
    double h;         ///< s
    double speed;     ///< m/s, more than which the energy does not allow
    double contacts;  ///< bounces; with penalty, steps of those
    /// Largest rate of an oscillation, 1/s: twice two springs over the mass (Gershgorin).
    [[nodiscard]] static double rate() { return std::sqrt(4.0 * kStiffness / kMass); }

    /// N s. A bounce of v leads off the plan by 2 v t at most in what is left of the step, which the spring's other end
    /// does not know: both springs of a particle miss k 2 v h^2 / 2 each.
    [[nodiscard]] double momentum() const { return contacts * 2.0 * kStiffness * speed * h * h; }
    /// J, that this makes of a bounce: k (2 v h)^2 / 6 for each of two springs, twice where it is the work on both
    /// ends.
    [[nodiscard]] double energy_of_bounces() const {
        return contacts * 2.0 * 2.0 * kStiffness * std::pow(2.0 * speed * h, 2) / 6.0;
    }
    /// J, by which a method's own energy moves off the true one, for an oscillation that has all of it: what the
    /// amplification |R| of a step makes of it in n steps, and for symplectic methods what their own Hamiltonian
    /// differs by (E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", IX.3).
    [[nodiscard]] double energy_of(IntegratorKind kind) const {
        const double z = rate() * h;
        const double steps = kDuration / h;
        switch (kind) {
            case IntegratorKind::forward_euler:
                return kEnergy * std::expm1(steps * z * z);
            case IntegratorKind::symplectic_euler:
                return 0.5 * z * kEnergy;
            case IntegratorKind::midpoint:
                return kEnergy * std::expm1(steps * z * z * z * z / 4.0);
            case IntegratorKind::rk4:
                return kEnergy * steps * std::pow(z, 6) / 72.0;
            case IntegratorKind::implicit_euler:
                return kEnergy * steps * z * z;
            case IntegratorKind::dormand_prince:
                return kEnergy * steps * 1e-6;  // its tolerance
            default:
                return 0.25 * z * z * kEnergy;  // velocity Verlet
        }
    }
};

/// N s, by which the sum of momenta may be wrong: rounding, and what docs/integrators.md says is left out: with the
/// exact response alone springs give the others what a bounce has changed.
double momentum_bound(const Case& c, const SpringTheory& theory) {
    const bool is_complete = c.feature != Feature::springs || c.response == ResponseKind::exact;
    return is_complete ? 1e-12 : theory.momentum();
}

/// J, by which penalties may miss: walls are springs of half a period of `contact_steps` sub-steps, whatever the step,
/// and a bounce is half an oscillation by the scene's method. Forward Euler's growth goes on from bounce to bounce.
double energy_of_penalties(const Case& c, double contacts) {
    if (c.response != ResponseKind::penalty) return 0.0;
    const double steps = PenaltySettings{}.contact_steps;
    const double z = std::numbers::pi / steps;
    const double of_each = contacts * kEnergy / kParticles;
    // A child that is born within a wall is pushed out as its parent would be, by as much energy as its mass has at 2
    // m/s.
    const double born = c.feature == Feature::children ? contacts * 0.5 * kChildMass * 4.0 : 0.0;
    switch (c.integrator) {
        case IntegratorKind::forward_euler:
            return kEnergy * std::expm1(4.0 * steps * z * z) + born;
        case IntegratorKind::symplectic_euler:
            return 0.5 * z * of_each + born;
        case IntegratorKind::midpoint:
            return of_each * std::expm1(steps * std::pow(z, 4) / 4.0) + born;
        case IntegratorKind::rk4:
            return of_each * steps * std::pow(z, 6) / 72.0 + born;
        default:
            return 0.25 * z * z * of_each + born;
    }
}

/// J by which the sum of energies may change. Without springs and penalties particles fly straight and bounce
/// elastically.
double energy_bound(const Case& c, const SpringTheory& theory) {
    const double of_walls = 1e-11 + energy_of_penalties(c, theory.contacts);
    if (c.feature != Feature::springs) return of_walls;
    return of_walls + theory.energy_of(c.integrator) + theory.energy_of_bounces();
}

void expect_closed(const Case& c, double time_step) {
    Simulation simulation(setup_of(c, time_step));
    const bool is_emitted = c.feature == Feature::children || c.feature == Feature::shattering;
    if (is_emitted) simulation.step();  // in which all are born
    const Books start = books_of(simulation);
    const std::uint64_t children_before = simulation.statistics().children;
    simulation.advance(simulation.step_count());
    const SimulationStatistics& statistics = simulation.statistics();
    EXPECT_GT(statistics.contacts, 5U);
    EXPECT_EQ(statistics.unsimulated_time, 0.0);
    const Books end = books_of(simulation);
    const bool bears = c.feature == Feature::children;
    const double born = bears ? kChildMass * static_cast<double>(statistics.children - children_before) : 0.0;
    const double speed = std::sqrt(2.0 * start.energy / kMass);
    const SpringTheory theory{time_step, speed, static_cast<double>(statistics.contacts)};
    EXPECT_NEAR(end.mass, start.mass + born, 1e-12);
    EXPECT_LT(length(end.momentum - start.momentum), momentum_bound(c, theory));
    EXPECT_TRUE(!bears || statistics.children > 100U);
    EXPECT_EQ(c.feature == Feature::absorbing, statistics.absorbed > 0U);
    EXPECT_EQ(c.feature == Feature::shattering, statistics.shattered > 0U);
    // All have the same energy, also those that walls swallow; fragments have at most that of their launches besides.
    const double swallowed = kEnergy / kParticles * static_cast<double>(statistics.absorbed);
    const double launched = 0.5 * kMass * static_cast<double>(statistics.shattered) * kLaunch * kLaunch;
    EXPECT_GT(end.energy, start.energy - swallowed - energy_bound(c, theory));
    EXPECT_LT(end.energy, start.energy - swallowed + launched + energy_bound(c, theory));
}

TEST(Books, OfMassMomentumAndEnergyAreClosedForEveryPairOfFeatures) {
    ASSERT_EQ(all_cases().size(), 4U * (4U * 8U - 2U));
    for (const Case& c : all_cases()) {
        SCOPED_TRACE(name(c));
        expect_closed(c, 0.002);
        if (c.feature == Feature::springs) expect_closed(c, 0.0005);
    }
}

/// N s, that springs give the other end of what a wall has swallowed until they are lost at the end of the step, and
/// that nobody holds up: at most by two springs that hold all of the energy.
double pulls_of_swallowed(const Case& c, double time_step, const Simulation& simulation) {
    if (c.feature != Feature::springs) return 0.0;
    const double pull = std::sqrt(2.0 * kEnergy * kStiffness);
    return 2.0 * pull * time_step * static_cast<double>(simulation.statistics().absorbed);
}

// Walls get the momentum of what they swallow once, whoever it was born of, and whatever hung on it.
TEST(Books, OfMomentumAreClosedWhereWallsSwallowSomeOfIt) {
    for (Case c : all_cases()) {
        if (c.feature == Feature::absorbing) continue;
        c.absorbs = true;
        SCOPED_TRACE(name(c) + " and absorbing");
        const double time_step = 0.002;
        Simulation simulation(setup_of(c, time_step));
        if (c.feature != Feature::springs) simulation.step();  // in which all are born
        const Books start = books_of(simulation);
        simulation.advance(simulation.step_count());
        const SimulationStatistics& statistics = simulation.statistics();
        EXPECT_GT(statistics.absorbed, 0U);
        EXPECT_EQ(statistics.unsimulated_time, 0.0);
        const Books end = books_of(simulation);
        const double speed = std::sqrt(2.0 * start.energy / kMass);
        const SpringTheory theory{time_step, speed, static_cast<double>(statistics.contacts)};
        EXPECT_LT(length(end.momentum - start.momentum),
                  momentum_bound(c, theory) + pulls_of_swallowed(c, time_step, simulation));
        const double launched = 0.5 * kMass * static_cast<double>(statistics.shattered) * kLaunch * kLaunch;
        EXPECT_LT(end.energy, start.energy + launched + energy_bound(c, theory));
    }
}

// A flow's particles have no momentum: walls get none, and nobody is lost.
TEST(Books, OfWhatAFlowCarriesHoldParticlesAndTimeOnly) {
    for (const IntegratorKind integrator : {IntegratorKind::forward_euler, IntegratorKind::midpoint,
                                            IntegratorKind::rk4, IntegratorKind::dormand_prince}) {
        for (const WallRule walls : {WallRule::slide, WallRule::stop}) {
            SCOPED_TRACE(name_of(integrator));
            SimulationSetup setup;
            setup.options.integrator = integrator;
            setup.options.walls = walls;
            setup.options.flow = make_wind({1.0, 0.4, -0.7});
            setup.options.time_step = 0.02;
            setup.materials = {{.name = "wall"}};
            setup.colliders = {{"box", CuboidShape{{1, 1, 1}, {}}, 0}};
            setup.particles = moving_particles();
            Simulation simulation(std::move(setup));
            simulation.advance(simulation.step_count());
            EXPECT_EQ(simulation.particles().size(), kParticles);
            EXPECT_GT(simulation.statistics().contacts, kParticles - 1);
            EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
            for (const Vec3& impulse : simulation.triangle_totals(0).impulse) EXPECT_EQ(impulse, Vec3{});
        }
    }
}

}  // namespace
}  // namespace ricochet
