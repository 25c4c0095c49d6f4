#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

SimulationSetup pair_setup(double time_step, double duration, const PairContactSettings& contacts,
                           const Vec3& gravity = {}) {
    SimulationSetup setup = setup_of(time_step, duration, {}, gravity);
    setup.options.resting_speed = 0.0;
    setup.options.particle_contacts = contacts;
    return setup;
}

Simulation run(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

double largest(const Vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

struct Sums {
    Vec3 momentum;
    Vec3 angular_momentum;
    double energy = 0.0;
};

Sums sums_of(const Particles& p) {
    Sums sums;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const double inertia = 0.4 * p.mass[i] * p.radius[i] * p.radius[i];
        sums.momentum += p.mass[i] * p.velocity[i];
        sums.angular_momentum += p.mass[i] * cross(p.position[i], p.velocity[i]) + inertia * p.spin[i];
        sums.energy += 0.5 * p.mass[i] * length_squared(p.velocity[i]) + 0.5 * inertia * length_squared(p.spin[i]);
    }
    return sums;
}

// Every method must give the same result, because no other sphere is near.
TEST(PairContacts, HeadOnCollisionMatchesTheClosedForm) {
    for (const auto& [e, method] : {std::pair{0.0, PairMethod::automatic},
                                    {0.4, PairMethod::events},
                                    {0.4, PairMethod::contacts},
                                    {1.0, PairMethod::automatic},
                                    {1.0, PairMethod::contacts}}) {
        SCOPED_TRACE("restitution " + std::to_string(e));
        SimulationSetup setup = pair_setup(0.25, 1.0, {.restitution = e, .method = method});
        Particle a = particle_of({0, 0, 0}, {2, 0, 0}, 0.1);
        Particle b = particle_of({1, 0, 0}, {-1, 0, 0}, 0.2);
        a.mass = 1.5;
        b.mass = 4.0;
        setup.particles = {a, b};
        const Simulation simulation = run(std::move(setup));
        EXPECT_EQ(simulation.statistics().pair_impacts, 1U);
        const double impulse = (1.0 + e) * 3.0 / (1.0 / 1.5 + 1.0 / 4.0);
        const double va = 2.0 - impulse / 1.5;
        const double vb = -1.0 + impulse / 4.0;
        const double time = 0.7 / 3.0;
        const Particles& p = simulation.particles();
        EXPECT_NEAR(p.velocity[0].x, va, 1e-13);
        EXPECT_NEAR(p.velocity[1].x, vb, 1e-13);
        EXPECT_NEAR(p.position[0].x, 2.0 * time + va * (1.0 - time), 1e-13);
        EXPECT_NEAR(p.position[1].x, 1.0 - time + vb * (1.0 - time), 1e-13);
        EXPECT_EQ(largest(p.spin[0]), 0.0);
    }
}

// Friction changes the tangential velocities by the impulse that stops the slip, or by its limit if that is smaller.
TEST(PairContacts, ObliqueImpactWithFrictionAndSpinMatchesTheClosedForm) {
    for (const double mu : {0.05, 0.3, 10.0}) {
        SCOPED_TRACE("friction " + std::to_string(mu));
        const double e = 0.7;
        SimulationSetup setup = pair_setup(0.02, 0.2, {.restitution = e, .friction = mu}, {0, 0, -9.81});
        const Vec3 n = normalized(Vec3{0.6, 0.5, -0.3});  // from a to b at the impact
        const Vec3 va{1.3, 0.4, 0.2};
        const Vec3 vb{-0.8, -0.9, 1.1};
        const Vec3 wa{3, -2, 5};
        const Vec3 wb{-1, 7, 2};
        const double ra = 0.1;
        const double rb = 0.25;
        const double time = 0.0533;
        const Vec3 fall = (0.5 * time * time) * Vec3{0, 0, -9.81};
        const Vec3 meeting{0.2, -0.1, 0.4};  // a's centre at the impact
        Particle a = particle_of(meeting - time * va - fall, va, ra, wa);
        Particle b = particle_of(meeting + (ra + rb) * n - time * vb - fall, vb, rb, wb);
        a.mass = 0.8;
        b.mass = 2.0;
        setup.particles = {a, b};
        const Simulation simulation = run(std::move(setup));
        ASSERT_EQ(simulation.statistics().pair_impacts, 1U);
        const Vec3 u = (vb - va) - cross(ra * wa + rb * wb, n);
        const double inverse = 1.0 / a.mass + 1.0 / b.mass;
        const double normal = (1.0 + e) * -dot(u, n) / inverse;
        const Vec3 slip = u - dot(u, n) * n;
        const double along = std::min(mu * normal, length(slip) / (3.5 * inverse));
        const Vec3 impulse = normal * n - (along / length(slip)) * slip;
        const Vec3 gravity = 0.2 * Vec3{0, 0, -9.81};
        const Particles& p = simulation.particles();
        EXPECT_LT(largest(p.velocity[0] - (va - impulse / a.mass + gravity)), 1e-12);
        EXPECT_LT(largest(p.velocity[1] - (vb + impulse / b.mass + gravity)), 1e-12);
        EXPECT_LT(largest(p.spin[0] - (wa - (ra / (0.4 * a.mass * ra * ra)) * cross(n, impulse))), 1e-11);
        EXPECT_LT(largest(p.spin[1] - (wb - (rb / (0.4 * b.mass * rb * rb)) * cross(n, impulse))), 1e-11);
    }
}

TEST(PairContacts, SpheresThatMissEachOtherKeepTheirBits) {
    SimulationSetup with = pair_setup(0.1, 2.0, {});
    with.particles = {particle_of({0, 0, 0}, {1, 0, 0}, 0.1), particle_of({2, 0.2001, 0}, {-1, 0, 0}, 0.1)};
    SimulationSetup without = setup_of(0.1, 2.0);
    without.particles = with.particles;
    const Simulation first = run(std::move(with));
    const Simulation second = run(std::move(without));
    EXPECT_EQ(first.statistics().pair_impacts, 0U);
    EXPECT_EQ(first.state_hash(), second.state_hash());
}

TEST(PairContacts, PointsNeverCollide) {
    SimulationSetup setup = pair_setup(0.1, 1.0, {});
    setup.particles = {particle_of({0, 0, 0}, {1, 0, 0}), particle_of({1, 0, 0}, {-1, 0, 0})};
    EXPECT_EQ(run(std::move(setup)).statistics().pair_impacts, 0U);
}

// One ball goes out for one ball in, even if the balls touch.
TEST(PairContacts, CradleReleasesOneBallForOne) {
    for (const double gap : {0.0, 1e-9}) {
        SCOPED_TRACE("gap " + std::to_string(gap));
        SimulationSetup setup = pair_setup(0.05, 0.2, {});
        const double r = 0.05;
        for (int k = 0; k < 5; ++k) {
            setup.particles.push_back(particle_of({k * (2 * r + gap), 0, 0}, {}, r));
        }
        setup.particles.front().position.x = -0.13;
        setup.particles.front().velocity.x = 1.0;
        std::swap(setup.particles[0], setup.particles[3]);  // ids must not matter
        const Simulation simulation = run(std::move(setup));
        const Particles& p = simulation.particles();
        for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(p.velocity[i].x, i == 4 ? 1.0 : 0.0, 1e-12) << i;
        EXPECT_EQ(simulation.statistics().pair_impacts, 4U);
        EXPECT_LT(simulation.statistics().overlap_largest, 1e-12);
    }
}

SimulationSetup rack(double e, std::uint64_t order) {
    SimulationSetup setup = pair_setup(0.01, 0.3, {.restitution = e});
    const double r = 0.0286;
    std::vector<Particle> balls{particle_of({-0.5, 0, 0}, {4, 0, 0}, r)};
    for (int row = 0; row < 5; ++row) {
        for (int k = 0; k <= row; ++k) {
            balls.push_back(particle_of({row * r * std::sqrt(3.0), (2 * k - row) * r, 0}, {}, r));
        }
    }
    RandomSequence random(order, 1, 0);
    for (std::size_t k = balls.size() - 1; order > 0 && k > 0; --k) {
        std::swap(balls[k], balls[static_cast<std::size_t>(random.uniform() * static_cast<double>(k + 1))]);
    }
    setup.particles = balls;
    return setup;
}

// Each ball has its mirror image, for any order of ids.
TEST(PairContacts, SymmetricRackBreaksSymmetrically) {
    for (const double e : {1.0, 0.9}) {
        for (const std::uint64_t order : {0, 1, 2}) {
            SCOPED_TRACE("restitution " + std::to_string(e) + ", order " + std::to_string(order));
            const Simulation simulation = run(rack(e, order));
            const Particles& p = simulation.particles();
            EXPECT_GT(simulation.statistics().pair_impacts, 15U);
            for (std::size_t i = 0; i < p.size(); ++i) {
                const Vec3 mirrored{p.position[i].x, -p.position[i].y, p.position[i].z};
                double nearest = 1.0;
                for (std::size_t j = 0; j < p.size(); ++j) {
                    nearest = std::min(nearest, length(p.position[j] - mirrored));
                }
                EXPECT_LT(nearest, 1e-12) << i;
            }
            const Sums sums = sums_of(p);
            EXPECT_NEAR(sums.momentum.x, 4.0, 1e-12);
            EXPECT_NEAR(sums.momentum.y, 0.0, 1e-12);
            if (e == 1.0) {
                EXPECT_NEAR(sums.energy, 8.0, 1e-12);
            }
        }
    }
}

/// Returns spheres in a closed box.
SimulationSetup gas(const PairContactSettings& contacts, std::size_t count, double radius, double time_step,
                    double duration) {
    SimulationSetup setup = pair_setup(time_step, duration, contacts);
    const double half = 0.5;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            Vec3 normal;
            normal[axis] = -side;
            Vec3 point;
            point[axis] = side * half;
            ColliderDescription wall;
            wall.shape = PlaneShape{point, normal};
            setup.colliders.push_back(wall);
        }
    }
    const auto cells = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(count))));
    const double pitch = (2.0 * half - 2.0 * radius) / static_cast<double>(cells);
    RandomSequence random(7, 1, 0);
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3 at{static_cast<double>(k % cells), static_cast<double>(k / cells % cells),
                      static_cast<double>(k / cells / cells)};
        const Vec3 corner{-half + radius, -half + radius, -half + radius};
        const Vec3 direction = random.unit_vector();
        const double speed = 0.5 + random.uniform();
        const Vec3 spin = random.unit_vector();
        setup.particles.push_back(
            particle_of(corner + pitch * (at + Vec3{0.5, 0.5, 0.5}), speed * direction, radius, 10.0 * spin));
    }
    return setup;
}

TEST(PairContacts, ElasticGasKeepsItsEnergyAndStaysInTheBox) {
    SimulationSetup setup = gas({}, 500, 0.03, 0.01, 2.0);
    setup.options.verify = true;
    const double before = Simulation(gas({}, 500, 0.03, 0.01, 2.0)).kinetic_energy();
    const Simulation simulation = run(std::move(setup));
    EXPECT_GT(simulation.statistics().pair_impacts, 4000U);
    EXPECT_NEAR(simulation.kinetic_energy() / before, 1.0, 1e-12);
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    EXPECT_LT(simulation.statistics().overlap_largest, 1e-12);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
}

TEST(PairContacts, RoughGasConservesMomentumAndAngularMomentumAndLosesEnergy) {
    SimulationSetup setup = gas({.restitution = 0.8, .friction = 0.4, .rolling_friction = 0.1}, 400, 0.02, 0.02, 1.0);
    setup.colliders.clear();
    // Contacts planned before they close use lever arms that are too short by part of the gap.
    setup.options.particle_contacts->method = PairMethod::events;
    for (Particle& particle : setup.particles) particle.velocity = -3.0 * particle.position + 0.2 * particle.velocity;
    Simulation simulation(std::move(setup));
    const Sums first = sums_of(simulation.particles());
    while (!simulation.finished()) simulation.step();
    const Sums last = sums_of(simulation.particles());
    EXPECT_GT(simulation.statistics().pair_impacts, 300U);
    EXPECT_LT(largest(last.momentum - first.momentum), 1e-12);
    EXPECT_LT(largest(last.angular_momentum - first.angular_momentum), 1e-10);
    EXPECT_LT(last.energy, first.energy);
}

TEST(PairContacts, BitsDoNotDependOnTheNumberOfThreads) {
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        hashes.push_back(run(gas({.restitution = 0.9, .friction = 0.2}, 600, 0.03, 0.01, 0.5)).state_hash());
    }
    EXPECT_EQ(hashes[1], hashes[0]);
    EXPECT_EQ(hashes[2], hashes[0]);
}

TEST(PairContacts, VerificationChangesNoBit) {
    SimulationSetup verified = gas({.restitution = 0.95}, 300, 0.02, 0.02, 1.0);
    verified.options.verify = true;
    const Simulation first = run(std::move(verified));
    const Simulation second = run(gas({.restitution = 0.95}, 300, 0.02, 0.02, 1.0));
    EXPECT_GT(first.statistics().pair_impacts, 100U);
    EXPECT_EQ(first.state_hash(), second.state_hash());
}

TEST(PairContacts, OptimisationsChangeNoBit) {
    SimulationSetup plain = gas({.restitution = 0.95, .friction = 0.1}, 300, 0.02, 0.02, 1.0);
    plain.forces.push_back(make_gravity({0, 0, -1}));
    plain.acceleration = {.look_ahead = false, .deferred_steps = false, .sleeping = false, .spatial_order = false};
    SimulationSetup fast = gas({.restitution = 0.95, .friction = 0.1}, 300, 0.02, 0.02, 1.0);
    fast.forces.push_back(make_gravity({0, 0, -1}));
    EXPECT_EQ(run(std::move(plain)).state_hash(), run(std::move(fast)).state_hash());
}

TEST(PairContacts, ResumedRunHasTheSameBits) {
    const auto setup = [] { return gas({.restitution = 0.9, .friction = 0.3}, 200, 0.03, 0.02, 0.6); };
    Simulation whole(setup());
    std::vector<std::byte> bytes;
    while (!whole.finished()) {
        if (whole.step_index() == 11) {
            whole.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
        }
        whole.step();
    }
    Simulation resumed(setup());
    std::size_t at = 0;
    resumed.restore([&](std::span<std::byte> part) {
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), part.size(), part.begin());
        at += part.size();
    });
    while (!resumed.finished()) resumed.step();
    EXPECT_EQ(resumed.state_hash(), whole.state_hash());
    EXPECT_EQ(resumed.statistics().pair_impacts, whole.statistics().pair_impacts);
    EXPECT_GT(whole.statistics().pair_impacts, 100U);
}

// Under a uniform acceleration the time step changes nothing, until rounding errors have grown.
TEST(PairContacts, TimeStepChangesNoImpact) {
    const auto positions = [](double time_step) {
        SimulationSetup setup = gas({.restitution = 0.9, .friction = 0.2}, 60, 0.04, time_step, 0.5);
        setup.forces.push_back(make_gravity({0, 0, -2}));
        const Simulation simulation = run(std::move(setup));
        EXPECT_GT(simulation.statistics().pair_impacts, 20U);
        return simulation.particles().position;
    };
    const std::vector<Vec3> coarse = positions(0.1);
    const std::vector<Vec3> fine = positions(0.003);
    for (std::size_t i = 0; i < coarse.size(); ++i) EXPECT_LT(largest(coarse[i] - fine[i]), 1e-9) << i;
}

/// Returns the time of a pair's impact under the spring force a = -k x, by bisection on the exact motion.
double meeting_of_oscillators(double x, double v, double rate, double distance) {
    double low = 0.0;
    double high = 0.5;
    for (int k = 0; k < 200; ++k) {
        const double t = 0.5 * (low + high);
        const double gap = x * std::cos(rate * t) + v / rate * std::sin(rate * t);
        (gap > distance ? low : high) = t;
    }
    return 0.5 * (low + high);
}

// The relative motion of two particles in one spring field is that of one. Equal elastic spheres exchange velocities.
TEST(PairContacts, OtherIntegratorsFindTheImpactWithTheirOwnOrder) {
    const double rate = 3.0;
    const double time = meeting_of_oscillators(1.0, -2.0, rate, 0.2);
    const double velocity = -1.0 * rate * std::sin(rate * time) - 2.0 * std::cos(rate * time);
    const double left = 0.5 - time;
    const double expected = 0.2 * std::cos(rate * left) - velocity / rate * std::sin(rate * left);
    const auto error_of = [&](IntegratorKind kind, double time_step) {
        SimulationSetup setup = pair_setup(time_step, 0.5, {});
        setup.options.integrator = kind;
        setup.forces.push_back(make_force([=](const ForceInput& input) { return -(rate * rate) * input.position; }));
        setup.particles = {particle_of({-0.5, 0, 0}, {1, 0, 0}, 0.1), particle_of({0.5, 0, 0}, {-1, 0, 0}, 0.1)};
        const Simulation simulation = run(std::move(setup));
        EXPECT_EQ(simulation.statistics().pair_impacts, 1U);
        const std::vector<Vec3>& x = simulation.particles().position;
        return std::fabs((x[1] - x[0]).x - expected);
    };
    for (const auto& [kind, order] : {std::pair(IntegratorKind::rk4, 4.0),
                                      {IntegratorKind::midpoint, 2.0},
                                      {IntegratorKind::velocity_verlet, 2.0},
                                      {IntegratorKind::symplectic_euler, 1.0},
                                      {IntegratorKind::forward_euler, 1.0}}) {
        SCOPED_TRACE(name_of(kind));
        const double coarse = error_of(kind, 0.02);
        const double fine = error_of(kind, 0.0025);
        EXPECT_LT(fine, coarse * std::pow(8.0, -order + 0.7));
    }
}

TEST(PairContacts, InitiallyOverlappingSpheresSeparateAndGetNoDeeper) {
    SimulationSetup setup = pair_setup(0.05, 1.0, {.restitution = 0.5});
    setup.particles = {particle_of({0, 0, 0}, {0.5, 0, 0}, 0.1), particle_of({0.15, 0, 0}, {-0.5, 0, 0}, 0.1),
                       particle_of({5, 0, 0}, {-0.1, 0, 0}, 0.1), particle_of({5.1, 0, 0}, {0.1, 0, 0}, 0.1)};
    const Simulation simulation = run(std::move(setup));
    const Particles& p = simulation.particles();
    EXPECT_EQ(simulation.statistics().pair_impacts, 1U);
    EXPECT_NEAR(p.velocity[1].x, 0.25, 1e-14);
    EXPECT_NEAR(p.velocity[2].x, -0.1, 0.0);
    EXPECT_LT(simulation.statistics().overlap_largest, 1.0);
}

TEST(PairContacts, SphereThatSpendsItsBudgetIsCountedAndStays) {
    SimulationSetup setup =
        pair_setup(0.5, 0.5, {.restitution = 0.5, .method = PairMethod::events, .impact_budget = 3});
    ColliderDescription floor;
    floor.shape = PlaneShape{{0, 0, 0}, {0, 0, 1}};
    setup.colliders.push_back(floor);
    setup.forces.push_back(make_gravity({0, 0, -10}));
    setup.particles = {particle_of({0, 0, 0.1}, {}, 0.1), particle_of({0, 0, 0.31}, {}, 0.1)};
    const Simulation simulation = run(std::move(setup));
    EXPECT_GT(simulation.statistics().unsimulated_time, 0.1);
    EXPECT_GT(simulation.statistics().budget_exhausted, 0U);
    EXPECT_LT(simulation.statistics().overlap_largest, 1e-9);
}

TEST(PairContacts, BallAtRestOnTheFloorRollsAwayWhenHit) {
    SimulationSetup setup = pair_setup(0.02, 1.0, {.restitution = 0.9, .friction = 0.1}, {0, 0, -9.81});
    setup.options.resting_speed = 1e-3;
    setup.options.verify = true;
    setup.materials[0] = {.name = "cloth", .restitution = 0.5, .friction = 0.2};
    ColliderDescription floor;
    floor.shape = PlaneShape{{0, 0, 0}, {0, 0, 1}};
    setup.colliders.push_back(floor);
    setup.particles = {particle_of({0, 0, 0.03}, {}, 0.03), particle_of({-0.5, 0, 0.03}, {2, 0, 0}, 0.03)};
    const Simulation simulation = run(std::move(setup));
    const Particles& p = simulation.particles();
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
    EXPECT_GT(p.position[0].x, 0.5);
    EXPECT_GT(p.position[0].x, p.position[1].x + 0.06);
    EXPECT_NEAR(p.position[0].z, 0.03, 1e-6);
    EXPECT_NEAR(p.spin[0].y, p.velocity[0].x / 0.03, 1e-6);  // the ball rolls
}

TEST(PairContacts, IncompatibleFeaturesAreRefusedByName) {
    const auto complaint = [](const std::function<void(SimulationSetup&)>& change) {
        SimulationSetup setup = pair_setup(0.1, 1.0, {});
        setup.particles = {particle_of({0, 0, 0}, {}, 0.1), particle_of({1, 0, 0}, {}, 0.1)};
        change(setup);
        try {
            const Simulation simulation(std::move(setup));
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    EXPECT_EQ(complaint([](SimulationSetup&) {}), "none");
    const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    EXPECT_TRUE(has(complaint([](auto& s) { s.options.response = ResponseKind::penalty; }), "response"));
    EXPECT_TRUE(has(complaint([](auto& s) { s.options.particle_contacts->restitution = 1.5; }), "restitution"));
    EXPECT_TRUE(has(complaint([](auto& s) { s.options.particle_contacts->impact_budget = 0; }), "impact_budget"));
    EXPECT_TRUE(has(complaint([](auto& s) {
                        s.options.integrator = IntegratorKind::symplectic_euler;
                        FrameDescription frame;
                        frame.name = "hoist";
                        s.frames = std::make_shared<const FrameTree>(FrameTree({frame}));
                        s.colliders.push_back({"plate", PlaneShape{{0, 0, -1}, {0, 0, 1}}});
                        s.colliders.back().frame = "hoist";
                    }),
                    "integrator"));
    EXPECT_TRUE(has(complaint([](auto& s) {
                        s.springs.push_back({0, 1, 1.0});
                        s.options.integrator = IntegratorKind::implicit_euler;
                    }),
                    "integrator"));
}

// The upper sphere gives its momentum to the lower one, which bounces off the floor at once and returns it.
TEST(PairContacts, SphereThatFallsOnOneOnTheFloorRebounds) {
    for (const PairMethod method : {PairMethod::automatic, PairMethod::events, PairMethod::contacts}) {
        for (const double aside : {0.0, 0.05}) {
            SimulationSetup setup = pair_setup(1e-3, 0.6, {.method = method}, {0, 0, -9.81});
            setup.options.verify = true;
            setup.materials[0].restitution = 1.0;
            setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}}};
            setup.particles = {particle_of({0, 0, 0.1}, {}, 0.1), particle_of({aside, 0, 0.8}, {}, 0.1)};
            const Simulation simulation = run(std::move(setup));
            EXPECT_EQ(simulation.statistics().energy_violations, 0U);
            double energy = 0.0;
            for (const std::size_t i : {0U, 1U}) {
                energy += 0.5 * length_squared(simulation.particles().velocity[i]) +
                          9.81 * simulation.particles().position[i].z;
            }
            EXPECT_NEAR(energy, 9.81 * 0.9, 1e-9) << aside;
            if (aside > 0.0) continue;
            const double lands = std::sqrt(2.0 * 0.5 / 9.81);
            EXPECT_NEAR(simulation.particles().velocity[1].z, 9.81 * lands - 9.81 * (0.6 - lands), 1e-7);
        }
    }
}

// Friction computed from the slip before the impact may act in the wrong direction after it.
TEST(PairContacts, NoEnergyIsGainedIfFrictionActsInSeveralContactsAtOnce) {
    for (const double e : {0.0, 0.5, 1.0}) {
        for (const double friction : {0.1, 0.3, 1.0}) {
            SimulationSetup setup = pair_setup(0.01, 0.05, {.restitution = e, .friction = friction});
            setup.options.verify = true;
            const double side = std::sqrt(0.0075);
            setup.particles = {particle_of({-0.05, 0, 0}, {5, 0, 0}, 0.05), particle_of({side, -0.05, 0}, {}, 0.05),
                               particle_of({side, 0.05, 0}, {}, 0.05)};
            const Simulation simulation = run(std::move(setup));
            EXPECT_LE(sums_of(simulation.particles()).energy, 12.5 * (1.0 + 1e-14)) << e << ' ' << friction;
            EXPECT_EQ(simulation.statistics().pair_violations, 0U);
        }
    }
}

TEST(PairContacts, IncomparableMassesAreRefused) {
    for (const double mass : {1e-300, 1e200}) {
        SimulationSetup setup = pair_setup(0.01, 0.05, {});
        setup.particles = {particle_of({0, 0, 0}, {1, 0, 0}, 0.1), particle_of({1, 0, 0}, {}, 0.1)};
        setup.particles[1].mass = mass;
        EXPECT_THROW(Simulation{std::move(setup)}, InputError) << mass;
    }
}

// Nothing is planned as long as impacts are sparse, with few or many spheres.
TEST(PairContacts, DissipativeGasUsesSingleImpactsForAnyNumberOfSpheres) {
    for (const std::size_t count : {200U, 600U}) {
        const auto energy_by = [&](PairMethod method) {
            return run(gas({.restitution = 0.95, .method = method}, count, 0.03, 0.02, 0.3)).kinetic_energy();
        };
        const double exact = energy_by(PairMethod::events);
        EXPECT_NEAR(energy_by(PairMethod::automatic) / exact, 1.0, 1e-9) << count;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
