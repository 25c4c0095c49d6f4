// Tests whole systems of particles: closed forms of coupled oscillations, orders of convergence, and agreement with
// single particles.
#include "ricochet/dynamics/system_integrator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "ricochet/dynamics/springs.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr IntegratorKind kAllKinds[] = {IntegratorKind::forward_euler,   IntegratorKind::symplectic_euler,
                                        IntegratorKind::implicit_euler,  IntegratorKind::midpoint,
                                        IntegratorKind::velocity_verlet, IntegratorKind::rk4,
                                        IntegratorKind::dormand_prince,  IntegratorKind::ballistic};

/// Particles with springs and forces, stepped without collisions.
struct FreeSystem {
    explicit FreeSystem(std::vector<Spring> list, std::vector<std::unique_ptr<Force>> pull = {})
        : forces(std::move(pull)), springs(std::move(list)) {}

    void add(const Vec3& x, const Vec3& v, double mass, bool pinned = false) {
        Particle particle;
        particle.id = particles.size();
        particle.position = x;
        particle.velocity = v;
        particle.mass = mass;
        particle.pinned = pinned;
        particles.append(particle);
    }
    /// Steps all particles as members. Returns true if every step was solved.
    bool run(const Integrator& integrator, double duration, int steps) {
        springs.bind(particles.id);
        std::vector<std::uint32_t> all(particles.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
        ParticleSystem system(forces, springs);
        system.assign(particles, all, 0.0);
        bool solved = true;
        double first_try = duration / steps;
        for (int k = 0; k < steps; ++k) {
            const double end = duration * (k + 1) / steps;
            while (end - system.time() > 1e-12 * duration) {
                const SystemStep step = step_system(integrator, system, end - system.time(), first_try);
                first_try = step.next_duration;
                solved = solved && step.solved;
                system.set_phase(step.positions, step.velocities);
                system.set_time(system.time() + step.duration);
            }
        }
        particles.position = system.positions();
        particles.velocity = system.velocities();
        return solved;
    }

    ForceField forces;
    SpringNetwork springs;
    Particles particles;
};

/// Returns two masses on a spring without gravity. Their distance oscillates with omega^2 = k (1/m1 + 1/m2), and their
/// centre drifts.
FreeSystem swinging_pair() {
    FreeSystem system({{0, 1, 1.0, 18.0, 0.0}});
    system.add({0, 0, 0}, {0.1, 0.2, 0.0}, 1.0);
    system.add({1.3, 0, 0}, {0.1, 0.2, 0.0}, 2.0);
    return system;
}

double error_of_pair(IntegratorKind kind, int steps) {
    FreeSystem system = swinging_pair();
    const double t = 1.0;
    EXPECT_TRUE(system.run(Integrator(kind, {1e-10, 1e-10}), t, steps));
    const double omega = std::sqrt(18.0 * 1.5);
    const double middle = 1.3 * 2.0 / 3.0 + 0.1 * t;
    const double apart = 1.0 + 0.3 * std::cos(omega * t);
    const Vec3 first{middle - apart * 2.0 / 3.0, 0.2 * t, 0.0};
    const Vec3 second{middle + apart / 3.0, 0.2 * t, 0.0};
    return length(system.particles.position[0] - first) + length(system.particles.position[1] - second);
}

TEST(SystemIntegrator, SolvesTheOscillatingPairWithItsOrder) {
    const auto order = [](IntegratorKind kind, int steps) {
        return std::log2(error_of_pair(kind, steps) / error_of_pair(kind, 2 * steps));
    };
    EXPECT_NEAR(order(IntegratorKind::forward_euler, 2000), 1.0, 0.1);
    EXPECT_NEAR(order(IntegratorKind::symplectic_euler, 2000), 1.0, 0.1);
    EXPECT_NEAR(order(IntegratorKind::implicit_euler, 2000), 1.0, 0.1);
    EXPECT_NEAR(order(IntegratorKind::midpoint, 200), 2.0, 0.1);
    EXPECT_NEAR(order(IntegratorKind::velocity_verlet, 200), 2.0, 0.1);
    EXPECT_NEAR(order(IntegratorKind::ballistic, 200), 2.0, 0.1);
    EXPECT_NEAR(order(IntegratorKind::rk4, 100), 4.0, 0.1);
}

TEST(SystemIntegrator, DormandPrinceKeepsItsToleranceOverTheWholeSystem) {
    EXPECT_LT(error_of_pair(IntegratorKind::dormand_prince, 1), 1e-7);
    EXPECT_GT(error_of_pair(IntegratorKind::dormand_prince, 1), 1e-16);
}

TEST(SystemIntegrator, StepsUncoupledParticlesToTheBitsOfSingleParticles) {
    for (const IntegratorKind kind : kAllKinds) {
        if (kind == IntegratorKind::ballistic) continue;  // becomes velocity_verlet
        std::vector<std::unique_ptr<Force>> list;
        list.push_back(make_acceleration([](const ForceInput& p) {
            return Vec3{0.3, -0.2, -9.81} - 0.4 * length(p.velocity) * p.velocity - 3.0 * p.position;
        }));
        FreeSystem system({}, std::move(list));
        system.add({0.1, 0.7, -0.2}, {1.5, -2.5, 0.5}, 1.7);
        const ForceInput start{system.particles.position[0], system.particles.velocity[0], 1.7, 0.0, 0.0, 0};
        const Flight flight = begin_flight(Integrator(kind, {1.0, 1.0}), system.forces, start, 0.01);
        const bool solved = system.run(Integrator(kind, {1.0, 1.0}), 0.01, 1);
        EXPECT_TRUE(solved) << name_of(kind);
        if (kind == IntegratorKind::implicit_euler) {  // another method for the same root
            EXPECT_LT(length(system.particles.position[0] - flight.path.end), 1e-12);
            EXPECT_LT(length(system.particles.velocity[0] - flight.end_velocity), 1e-10);
            continue;
        }
        if (kind == IntegratorKind::velocity_verlet) {  // the flight's end follows from its parabola by Horner's rule
            EXPECT_LT(length(system.particles.position[0] - flight.path.end), 1e-15);
        } else {
            EXPECT_EQ(system.particles.position[0], flight.path.end) << name_of(kind);
        }
        EXPECT_EQ(system.particles.velocity[0], flight.end_velocity) << name_of(kind);
    }
}

TEST(SystemIntegrator, ConservesMomentumToRounding) {
    for (const IntegratorKind kind : kAllKinds) {
        FreeSystem system({{0, 1, 0.9, 50.0, 0.4}, {1, 2, 1.1, 80.0, 0.0}, {2, 0, 0.5, 20.0, 0.2}});
        system.add({0, 0, 0}, {0.5, 0.1, 0.0}, 1.0);
        system.add({1, 0.2, 0}, {-0.2, 0.4, 0.3}, 3.0);
        system.add({0.3, 1, 0.4}, {0.0, -0.6, 0.1}, 0.5);
        const auto momentum = [&] {
            Vec3 sum;
            for (std::size_t i = 0; i < 3; ++i) sum += system.particles.mass[i] * system.particles.velocity[i];
            return sum;
        };
        const Vec3 before = momentum();
        system.run(kind, 2.0, 400);
        // Newton's method leaves a residual of the size of its tolerance. The other methods only round.
        const double allowed = kind == IntegratorKind::implicit_euler ? 1e-9 : 1e-13;
        EXPECT_LT(length(momentum() - before), allowed) << name_of(kind);
    }
}

TEST(SystemIntegrator, ImplicitEulerStaysStableWhenExplicitEulerDiverges) {
    // omega h = sqrt(2e8) * 0.01 = 141.
    const auto largest_after = [](IntegratorKind kind) {
        FreeSystem system({{0, 1, 1.0, 1e8, 0.0}});
        system.add({0, 0, 0}, {0, 0, 0}, 1.0);
        system.add({1.01, 0.002, 0}, {0, 0, 0}, 1.0);
        system.run(kind, 0.2, 20);
        return length(system.particles.position[1] - system.particles.position[0]);
    };
    EXPECT_GT(largest_after(IntegratorKind::forward_euler), 1e20);
    EXPECT_GT(largest_after(IntegratorKind::symplectic_euler), 1e20);
    EXPECT_NEAR(largest_after(IntegratorKind::implicit_euler), 1.0, 1e-3);
}

TEST(SystemIntegrator, ImplicitEulerSolvesItsEquationsWithDragAndCompressedSprings) {
    std::vector<std::unique_ptr<Force>> list;
    list.push_back(make_gravity({0, 0, -9.81}));
    list.push_back(make_acceleration([](const ForceInput& p) { return -20.0 * length(p.velocity) * p.velocity; }));
    list.push_back(make_acceleration([](const ForceInput& p) { return cross(p.velocity, Vec3{0, 0, 30.0}); }));
    FreeSystem system({{0, 1, 1.0, 2000.0, 1.0}, {1, 2, 1.0, 2000.0, 1.0}}, std::move(list));
    system.add({0, 0, 0}, {}, 1.0, true);
    system.add({0.6, 0.05, 0}, {1, 0, 0.5}, 0.2);
    system.add({0.9, -0.05, 0.1}, {-1, 2, 0}, 0.3);
    const std::vector<Vec3> x0 = system.particles.position;
    const std::vector<Vec3> v0 = system.particles.velocity;
    const double h = 0.02;
    ASSERT_TRUE(system.run(IntegratorKind::implicit_euler, h, 1));
    ParticleSystem end(system.forces, system.springs);
    const std::vector<std::uint32_t> all{0, 1, 2};
    end.assign(system.particles, all, h);
    std::vector<Vec3> a(3);
    for (std::size_t i = 1; i < 3; ++i) {
        a[i] = end.own_acceleration(i, h, end.positions()[i], end.velocities()[i]);
    }
    for (std::size_t k = 0; k < 2; ++k) {  // dampers resist the mean rate of the length
        const Vec3 apart = end.positions()[k + 1] - end.positions()[k];
        const double rate = (length(apart) - length(x0[k + 1] - x0[k])) / h;
        const Vec3 pull = (2000.0 * (length(apart) - 1.0) + 1.0 * rate) * normalized(apart);
        a[k] += pull / end.mass(k);
        a[k + 1] -= pull / end.mass(k + 1);
    }
    for (std::size_t i = 1; i < 3; ++i) {
        EXPECT_LT(length(end.velocities()[i] - v0[i] - h * a[i]), 1e-7) << i;
        EXPECT_LT(length(end.positions()[i] - x0[i] - h * end.velocities()[i]), 1e-15) << i;
    }
    EXPECT_EQ(end.positions()[0], x0[0]);
}

// If some nodes stop while others fly on, springs are compressed to zero length. The energy then has saddles, which
// Newton's method must pass without dozens of factorizations.
TEST(SystemIntegrator, ImplicitEulerSolvesViolentStepsInFewIterations) {
    for (const double damping : {0.0, 0.1}) {
        SCOPED_TRACE(damping);
        ClothSettings settings;
        settings.mass_per_area = 0.3;
        settings.stiffness = 1000.0;
        settings.bending_stiffness = 1.0;
        settings.damping = damping;
        const SpringBody cloth = make_cloth(sheet_mesh({}, {0.36, 0, 0}, {0, 0.36, 0}, 20, 20), settings);
        FreeSystem system(cloth.springs);
        for (const Particle& p : cloth.particles) system.add(p.position, {1.0, 0.3, -2.0}, p.mass);
        system.springs.bind(system.particles.id);
        ParticleSystem start(system.forces, system.springs);
        std::vector<std::uint32_t> all(cloth.particles.size());
        std::iota(all.begin(), all.end(), 0U);
        start.assign(system.particles, all, 0.0);
        std::vector<SupportConstraints> supports(all.size());
        for (std::size_t i = 0; i < supports.size(); i += 37) {
            supports[i].directions[0] = normalized(Vec3{0.3, 0.1, 1.0});
            supports[i].count = 1;
        }
        int iterations = 0;
        const SystemStep step =
            implicit_system_step(start, 0.01, supports, {}, {kNewtonTolerance, [&] { ++iterations; }});
        EXPECT_TRUE(step.solved);
        EXPECT_EQ(step.duration, 0.01);
        EXPECT_LT(iterations, 50);
        EXPECT_GT(iterations, 3);
    }
}

// A spring without length has no direction at first and gets one within the step. Its entries in the matrix must be
// allocated in advance.
TEST(SystemIntegrator, ImplicitEulerSeparatesCoincidentParticles) {
    for (const int others : {0, 1, 5}) {
        SCOPED_TRACE(others);
        std::vector<Spring> springs;
        for (std::uint64_t k = 0; k + 1 < 8; ++k) springs.push_back({k, k + 1, 0.5, 100.0, 0.1});
        FreeSystem system(std::move(springs));
        for (int k = 0; k < 8; ++k) system.add({k <= others ? 0.0 : k, 0, 0}, {0.1 * k, -0.2 * k, 0.3}, 1.0);
        EXPECT_TRUE(system.run(IntegratorKind::implicit_euler, 0.5, 10));
        Vec3 momentum;
        for (const Vec3& v : system.particles.velocity) momentum += v;
        EXPECT_NEAR(momentum.x, 2.8, 1e-12);
        EXPECT_NEAR(momentum.y, -5.6, 1e-12);
        EXPECT_NEAR(momentum.z, 2.4, 1e-12);
    }
}

TEST(SpringStability, BoundIsTheStepAtWhichAPairStartsToDiverge) {
    const std::vector<Spring> springs{{0, 1, 1.0, 100.0, 0.0}};
    std::vector<Particle> particles(2);
    for (const IntegratorKind kind : {IntegratorKind::symplectic_euler, IntegratorKind::velocity_verlet}) {
        const double bound = longest_stable_step(kind, springs, particles);
        EXPECT_NEAR(bound, 2.0 / std::sqrt(200.0), 1e-12);
        const auto apart_after = [&](double h) {
            FreeSystem system(springs);
            system.add({0, 0, 0}, {}, 1.0);
            system.add({1.001, 0, 0}, {}, 1.0);
            system.run(kind, 400 * h, 400);
            return length(system.particles.position[1] - system.particles.position[0]);
        };
        EXPECT_LT(apart_after(0.99 * bound), 1.1) << name_of(kind);
        EXPECT_GT(apart_after(1.02 * bound), 10.0) << name_of(kind);
    }
    EXPECT_TRUE(std::isinf(longest_stable_step(IntegratorKind::implicit_euler, springs, particles)));
    EXPECT_EQ(longest_stable_step(IntegratorKind::forward_euler, springs, particles), 0.0);
    EXPECT_TRUE(std::isinf(longest_stable_step(IntegratorKind::rk4, {}, particles)));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
