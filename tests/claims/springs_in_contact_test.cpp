// Springs between particles that slide, rest and roll. In every step, one end of a spring gains the momentum that the
// other end loses, in flight and in contact. Other tests compare results with closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kGravity = 9.81;

std::vector<IntegratorKind> explicit_methods() {
    return {IntegratorKind::forward_euler, IntegratorKind::symplectic_euler,
            IntegratorKind::midpoint,      IntegratorKind::velocity_verlet,
            IntegratorKind::rk4,           IntegratorKind::dormand_prince,
            IntegratorKind::ballistic};
}

/// Returns the methods of at least second order.
std::vector<IntegratorKind> higher_methods() {
    return {IntegratorKind::midpoint, IntegratorKind::velocity_verlet, IntegratorKind::rk4,
            IntegratorKind::dormand_prince, IntegratorKind::ballistic};
}

struct Answer {
    ResponseKind kind;
    bool global = false;  ///< true if rollback restores the whole system
};
constexpr Answer kExact{ResponseKind::exact};
constexpr Answer kAnswers[] = {
    kExact, {ResponseKind::rollback}, {ResponseKind::rollback, true}, {ResponseKind::project}, {ResponseKind::penalty}};

/// Returns false if the response refuses the method. The penalty response and the global rollback refuse methods with
/// variable steps. Reason: the penalty response has its own sub-steps, and the global rollback steps all particles
/// together.
bool go_together(IntegratorKind kind, const Answer& answer) {
    return kind != IntegratorKind::dormand_prince || !(answer.kind == ResponseKind::penalty || answer.global);
}

std::string name_of_case(IntegratorKind kind, const Answer& answer, double damping) {
    return std::string(name_of(kind)) + ", " + std::string(name_of(answer.kind)) + (answer.global ? ".global" : "") +
           ", c = " + std::to_string(damping);
}

Particle point(const Vec3& position, const Vec3& velocity, double mass) {
    Particle particle;
    particle.position = position;
    particle.velocity = velocity;
    particle.mass = mass;
    return particle;
}

/// Returns a plane z = 0 without rebound, and gravity.
SimulationSetup floor_with(double friction) {
    SimulationSetup setup;
    setup.forces.push_back(make_gravity({0, 0, -kGravity}));
    Material& material = setup.materials.emplace_back();
    material.restitution = 0.0;
    material.friction = friction;
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    return setup;
}

/// Returns a row of six points that slides in its own direction. moved: displacement of every second point, in m.
SimulationSetup sliding_row(double stiffness, double damping, double moved) {
    SimulationSetup setup = floor_with(0.3);
    for (std::uint64_t i = 0; i < 6; ++i) {
        const double off = i % 2 == 0 ? moved : 0.0;
        setup.particles.push_back(point({0.2 * static_cast<double>(i) + off, off, 0.0}, {3, 0, 0}, 1.0 / 6.0));
        if (i > 0) setup.springs.push_back({i - 1, i, 0.2, stiffness, damping});
    }
    return setup;
}

/// Returns two masses above each other, the lower one on the floor. The spring starts at its equilibrium length under
/// the weight of the upper mass.
SimulationSetup column(double stiffness, double damping) {
    SimulationSetup setup = floor_with(0.5);
    setup.particles = {point({}, {}, 1.0), point({0, 0, 0.3}, {}, 1.0)};
    setup.springs.push_back({0, 1, 0.3, stiffness, damping});
    return setup;
}

Simulation made(SimulationSetup setup, IntegratorKind kind, const Answer& answer, double step, double duration) {
    setup.options.integrator = kind;
    setup.options.response = answer.kind;
    setup.options.rollback.global = answer.global;
    setup.options.time_step = step;
    setup.options.duration = duration;
    return Simulation(std::move(setup));
}

/// Returns the impulse on the floor, in N s.
Vec3 given_to_floor(const Simulation& run) { return run.triangle_totals(0).impulse[0]; }

Vec3 momentum(const Simulation& run) {
    Vec3 sum;
    for (std::size_t i = 0; i < run.particles().size(); ++i) {
        sum += run.particles().mass[i] * run.particles().velocity[i];
    }
    return sum;
}

/// Returns the largest violation of momentum conservation in a step of the run, in N s. weight: sum of the masses on
/// which gravity acts, in kg.
double largest_gap(Simulation run, double weight, double step) {
    double largest = 0.0;
    Vec3 before = momentum(run) + given_to_floor(run);
    while (!run.finished()) {
        run.step();
        const Vec3 after = momentum(run) + given_to_floor(run);
        largest = std::max(largest, length(after - before - Vec3{0, 0, -weight * kGravity * step}));
        before = after;
    }
    return largest;
}

TEST(SpringsInContact, ConserveMomentumInEveryStepOfASlidingRow) {
    for (const IntegratorKind kind : explicit_methods()) {
        for (const Answer& answer : kAnswers) {
            for (const double damping : {0.0, 1.0}) {
                if (!go_together(kind, answer)) continue;
                Simulation run = made(sliding_row(1000.0, damping, 0.003), kind, answer, 1e-3, 0.1);
                EXPECT_LT(largest_gap(std::move(run), 1.0, 1e-3), 1e-12) << name_of_case(kind, answer, damping);
            }
        }
    }
}

// This is the smallest case. One particle slides, the other particle flies, and gravity acts only on the sliding
// particle.
TEST(SpringsInContact, ConserveMomentumBetweenASlidingAndAFlyingParticle) {
    for (const IntegratorKind kind : explicit_methods()) {
        for (const Answer& answer : kAnswers) {
            for (const double damping : {0.0, 20.0}) {
                if (!go_together(kind, answer)) continue;
                SimulationSetup setup = floor_with(0.5);
                setup.forces.clear();
                setup.forces.push_back(make_force_on({0}, make_gravity({0, 0, -kGravity})));
                setup.particles = {point({}, {3, 0, 0}, 1.0), point({1, 0, 0.2}, {3, 0, 0}, 1.0)};
                setup.springs.push_back({0, 1, 1.0, 1000.0, damping});
                Simulation run = made(std::move(setup), kind, answer, 1e-3, 0.1);
                EXPECT_LT(largest_gap(std::move(run), 1.0, 1e-3), 1e-12) << name_of_case(kind, answer, damping);
            }
        }
    }
}

// The spheres of a net land, slide, roll and lift off. Friction changes its direction when a slip ends. The momentum of
// the last slip near zero speed must be part of the friction impulse.
TEST(SpringsInContact, ConserveMomentumOfANetThatFallsOnTheFloor) {
    for (const IntegratorKind kind : explicit_methods()) {
        for (const double damping : {0.0, 0.05}) {
            SimulationSetup setup = floor_with(0.4);
            for (std::uint64_t k = 0; k < 16; ++k) {
                const double x = 0.06 * static_cast<double>(k % 4);
                const double y = 0.06 * static_cast<double>(k / 4);
                Particle sphere = point({x, y, 0.05 + 0.3 * x + 0.2 * y}, {1.0, 0.3, -1.0}, 0.01);
                sphere.radius = 0.02;
                setup.particles.push_back(sphere);
                if (k % 4 > 0) setup.springs.push_back({k - 1, k, 0.06, 100.0, damping});
                if (k >= 4) setup.springs.push_back({k - 4, k, 0.06, 100.0, damping});
            }
            Simulation run = made(std::move(setup), kind, kExact, 5e-4, 0.3);
            EXPECT_LT(largest_gap(std::move(run), 0.16, 5e-4), 1e-12) << name_of_case(kind, kExact, damping);
        }
    }
}

// The sliding distance is v^2 / (2 mu g). Friction decelerates all particles equally, so springs at their rest length
// have no effect.
TEST(SpringsInContact, DoNotChangeTheSlidingDistanceOfARow) {
    const double closed = 9.0 / (2.0 * 0.3 * kGravity);
    for (const IntegratorKind kind : higher_methods()) {
        // An adaptive method can have an error of its tolerance, 1e-6 m, in each of the sub-steps at the end of the
        // slide.
        const double error = kind == IntegratorKind::dormand_prince ? 1e-5 : 1e-6;
        for (const double step : {1e-3, 4e-3}) {
            Simulation run = made(sliding_row(1000.0, 1.0, 0.0), kind, kExact, step, 1.5);
            while (!run.finished()) run.step();
            double sum = 0.0;
            for (const Vec3& x : run.particles().position) sum += x.x / 6.0;
            EXPECT_NEAR(sum - 0.5, closed, error) << name_of(kind) << ", " << step << " s";
            EXPECT_EQ(run.statistics().resting, 6U) << name_of(kind);
        }
    }
}

TEST(SpringsInContact, DoNotChangeTheSlidingDistanceOfAStiffRow) {
    const double closed = 9.0 / (2.0 * 0.3 * kGravity);
    Simulation run = made(sliding_row(1e5, 5.0, 0.0), IntegratorKind::velocity_verlet, kExact, 1e-3, 1.5);
    while (!run.finished()) run.step();
    double sum = 0.0;
    for (const Vec3& x : run.particles().position) sum += x.x / 6.0;
    EXPECT_NEAR(sum - 0.5, closed, 1e-6);
}

// At rest the floor carries 2 m g, and the spring is compressed by m g / k.
TEST(SpringsInContact, SupportAColumnAtRest) {
    struct Case {
        double stiffness;
        double damping;
    };
    for (const auto& [stiffness, damping] : {Case{1000.0, 5.0}, Case{1e5, 100.0}}) {
        for (const IntegratorKind kind : higher_methods()) {
            for (const Answer& answer : kAnswers) {
                if (!go_together(kind, answer)) continue;
                Simulation run = made(column(stiffness, damping), kind, answer, 2e-3, 12.0);
                while (run.time() < 11.0) run.step();
                const double time = run.time();
                const double before = given_to_floor(run).z;
                while (!run.finished()) run.step();
                const double force = (before - given_to_floor(run).z) / (run.time() - time);
                const std::string what = name_of_case(kind, answer, damping);
                const std::vector<Vec3>& x = run.particles().position;
                EXPECT_NEAR(force, 2.0 * kGravity, 1e-6) << what;
                EXPECT_NEAR(0.3 - (x[1].z - x[0].z), kGravity / stiffness, 1e-7 * kGravity / stiffness + 1e-12) << what;
                EXPECT_LT(std::fabs(run.particles().velocity[1].z), 1e-9) << what;
            }
        }
    }
}

// With forward Euler, the first step from rest does not move the particles. After n steps of h they have fallen by g
// h^2 n (n - 1) / 2. The velocity gain by gravity in the first step must not count as divergence.
TEST(SpringsThatFall, MayFallFromRestByForwardEuler) {
    SimulationSetup setup;
    setup.forces.push_back(make_gravity({0, 0, -kGravity}));
    setup.particles = {point({0, 0, 5}, {}, 1.0), point({0, 0, 5.3}, {}, 1.0)};
    setup.springs.push_back({0, 1, 0.3, 1.0, 1.0});
    Simulation run = made(std::move(setup), IntegratorKind::forward_euler, kExact, 0.01, 1.0);
    while (!run.finished()) run.step();
    EXPECT_NEAR(run.particles().position[0].z, 5.0 - kGravity * 1e-4 * 100.0 * 99.0 / 2.0, 1e-10);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
