#include "ricochet/response/contact_solver/iterative_contact_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kGravity = 9.81;
constexpr double kStep = 1e-3;
const Vec3 kUp{0, 0, 1};

SolverBody ball(double mass, double radius, const Vec3& velocity = {}, const Vec3& spin = {}) {
    return {velocity, spin, 1.0 / mass, 2.5 / (mass * radius * radius), radius};
}

SolverContact on_wall(std::uint32_t a, const Vec3& normal, double friction = 0.0) {
    SolverContact contact;
    contact.a = a;
    contact.normal = normal;
    contact.friction = friction;
    return contact;
}

SolverContact between(std::uint32_t a, std::uint32_t b, const Vec3& normal, double friction = 0.0) {
    SolverContact contact = on_wall(a, normal, friction);
    contact.b = b;
    return contact;
}

SolverSettings exactly(double tolerance = 1e-15) {
    SolverSettings settings;
    settings.duration = kStep;
    settings.tolerance = tolerance;
    return settings;
}

double kinetic_energy(const std::vector<SolverBody>& bodies) {
    double sum = 0.0;
    for (const SolverBody& body : bodies) {
        sum += 0.5 * length_squared(body.velocity) / body.inverse_mass;
        if (body.inverse_inertia > 0.0) sum += 0.5 * length_squared(body.spin) / body.inverse_inertia;
    }
    return sum;
}

Vec3 momentum(const std::vector<SolverBody>& bodies) {
    Vec3 sum;
    for (const SolverBody& body : bodies) sum += body.velocity / body.inverse_mass;
    return sum;
}

/// Balls at random positions with small overlaps and random velocities. Near neighbours touch or nearly touch.
struct Heap {
    std::vector<SolverBody> bodies;
    std::vector<Vec3> centers;
    std::vector<SolverContact> contacts;
};

Heap random_heap(std::uint64_t seed, std::size_t count, bool with_walls) {
    RandomSequence random(seed, 0, 0);
    Heap heap;
    const double size = 2.1 * std::cbrt(static_cast<double>(count));
    while (heap.centers.size() < count) {
        const double radius = 0.5 + random.uniform();
        const Vec3 center{size * random.uniform(), size * random.uniform(), size * random.uniform()};
        bool is_free = true;
        for (std::size_t k = 0; k < heap.centers.size(); ++k) {
            is_free = is_free && length(heap.centers[k] - center) > 0.95 * (heap.bodies[k].radius + radius);
        }
        if (!is_free) continue;
        const Vec3 velocity = 2.0 * random.unit_vector() - Vec3{0, 0, 1};
        heap.bodies.push_back(ball(radius * radius * radius, radius, velocity, 3.0 * random.unit_vector()));
        heap.centers.push_back(center);
    }
    const double friction = random.uniform() < 0.3 ? 0.0 : random.uniform();
    for (std::uint32_t a = 0; a < count; ++a) {
        for (std::uint32_t b = 0; b < a; ++b) {
            const Vec3 apart = heap.centers[a] - heap.centers[b];
            const double gap = length(apart) - heap.bodies[a].radius - heap.bodies[b].radius;
            if (gap > 0.3) continue;
            SolverContact contact = between(a, b, normalized(apart), friction);
            contact.gap = std::max(gap, 0.0) * random.uniform();
            if (random.uniform() < 0.5) contact.gap = 0.0;
            contact.rolling_friction = random.uniform() < 0.3 ? 0.1 * heap.bodies[b].radius : 0.0;
            contact.restitution = random.uniform();
            contact.touched = random.uniform() < 0.2;
            heap.contacts.push_back(contact);
        }
        if (with_walls && heap.centers[a].z < 1.5) {
            SolverContact floor = on_wall(a, kUp, friction);
            floor.restitution = random.uniform();
            heap.contacts.push_back(floor);
        }
    }
    return heap;
}

/// Returns the largest violation of the contact conditions without a rebound, in m/s.
double defect(const SolverContact& contact, const SolverImpulse& impulse, const std::vector<SolverBody>& bodies) {
    const SolverBody& a = bodies[contact.a];
    Vec3 u = a.velocity - a.radius * cross(a.spin, contact.normal) - contact.wall_velocity;
    double inverse_mass = a.inverse_mass;
    if (contact.b != SolverContact::kWall) {
        const SolverBody& b = bodies[contact.b];
        u -= b.velocity + b.radius * cross(b.spin, contact.normal);
        inverse_mass += b.inverse_mass;
    }
    const double opening = dot(u, contact.normal) + contact.gap / kStep;
    const Vec3 slip = u - dot(u, contact.normal) * contact.normal;
    double worst = std::max(0.0, -opening);
    worst = std::max(worst, std::min(opening, impulse.normal * inverse_mass));
    const double most = contact.friction * impulse.normal;
    EXPECT_GE(impulse.normal, 0.0);
    EXPECT_LE(length(impulse.tangential), most * (1.0 + 1e-12));
    // Friction opposes the slip and is at its bound; otherwise there is no slip.
    const Vec3 wish = impulse.tangential - slip / inverse_mass;
    const Vec3 cut = length(wish) > most ? (most / length(wish)) * wish : wish;
    return std::max(worst, length(cut - impulse.tangential) * inverse_mass);
}

TEST(IterativeContactSolver, ReboundingContactsAreReported) {
    std::vector<SolverBody> bodies{ball(1.0, 0.1, {0, 0, -1}), ball(1.0, 0.1, {0, 0, -1}), ball(1.0, 0.1, {0, 0, 1})};
    std::vector<SolverContact> contacts{on_wall(0, kUp), on_wall(1, kUp), on_wall(2, kUp)};
    for (SolverContact& contact : contacts) contact.restitution = 0.5;
    contacts[1].touched = true;
    IterativeContactSolver solver;
    static_cast<void>(solver.solve(bodies, contacts, exactly()));
    EXPECT_EQ(std::vector<int>(solver.rebounds().begin(), solver.rebounds().end()), (std::vector<int>{1, 0, 0}));
}

TEST(IterativeContactSolver, BallOnAFloorIsHeldByItsWeight) {
    std::vector<SolverBody> bodies{ball(2.0, 0.1, {0, 0, -kGravity * kStep})};
    const std::vector<SolverContact> contacts{on_wall(0, kUp)};
    IterativeContactSolver solver;
    const SolverReport report = solver.solve(bodies, contacts, exactly());
    EXPECT_TRUE(report.is_converged);
    EXPECT_NEAR(solver.impulses()[0].normal, 2.0 * kGravity * kStep, 1e-15);
    EXPECT_LT(max_abs(bodies[0].velocity), 1e-15);
}

TEST(IterativeContactSolver, BallMayFallThroughItsRemainingGap) {
    std::vector<SolverBody> bodies{ball(1.0, 0.1, {0, 0, -3})};
    std::vector<SolverContact> contacts{on_wall(0, kUp)};
    contacts[0].gap = 2e-3;
    IterativeContactSolver solver;
    static_cast<void>(solver.solve(bodies, contacts, exactly()));
    EXPECT_NEAR(bodies[0].velocity.z, -2.0, 1e-13);
    contacts[0].gap = 4e-3;
    bodies[0].velocity = {0, 0, -3};
    static_cast<void>(solver.solve(bodies, contacts, exactly()));
    EXPECT_EQ(bodies[0].velocity.z, -3.0);
    EXPECT_EQ(solver.impulses()[0].normal, 0.0);
}

TEST(IterativeContactSolver, ForcesInAColumnAreTheWeightsAbove) {
    constexpr std::uint32_t kCount = 20;
    std::vector<SolverBody> bodies(kCount, ball(0.3, 0.05, {0, 0, -kGravity * kStep}));
    std::vector<SolverContact> contacts{on_wall(0, kUp, 0.4)};
    for (std::uint32_t i = 1; i < kCount; ++i) contacts.push_back(between(i, i - 1, kUp, 0.4));
    IterativeContactSolver solver;
    EXPECT_TRUE(solver.solve(bodies, contacts, exactly(1e-15)).is_converged);
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const double weights = (kCount - i) * 0.3 * kGravity * kStep;
        EXPECT_NEAR(solver.impulses()[i].normal, weights, 1e-9 * weights);
    }
}

// A light ball transfers the weight of a heavy one to the floor. Sweeps alone would take as many as the mass ratio.
TEST(IterativeContactSolver, LightBallHoldsAHeavyOne) {
    for (const double ratio : {1e3, 1e6, 1e9}) {
        SCOPED_TRACE(ratio);
        const Vec3 fall{0, 0, -1.0 - kGravity * kStep};
        std::vector<SolverBody> bodies{ball(1.0, 0.1, fall), ball(ratio, 1.0, fall)};
        const std::vector<SolverContact> contacts{on_wall(0, kUp, 0.5), between(1, 0, kUp, 0.5)};
        SolverSettings settings = exactly(1e-6);
        settings.sweeps = 30;
        settings.most_sweeps = 300;
        IterativeContactSolver solver;
        const SolverReport report = solver.solve(bodies, contacts, settings);
        EXPECT_TRUE(report.is_converged);
        EXPECT_LT(length(bodies[0].velocity), 3e-6);
        EXPECT_LT(length(bodies[1].velocity), 3e-6);
        EXPECT_NEAR(solver.impulses()[1].normal / (ratio * length(fall)), 1.0, 3e-6);
        EXPECT_NEAR(solver.impulses()[0].normal / ((ratio + 1.0) * length(fall)), 1.0, 3e-6);
    }
}

TEST(IterativeContactSolver, WallsOfAGrooveShareABall) {
    // For walls at angles A and B to the horizontal: N_A sin A = N_B sin B, N_A cos A + N_B cos B = m g.
    const double a = 0.6;
    const double b = 1.1;
    std::vector<SolverBody> bodies{ball(1.5, 0.1, {0, 0, -kGravity * kStep})};
    const std::vector<SolverContact> contacts{on_wall(0, {std::sin(a), 0, std::cos(a)}),
                                              on_wall(0, {-std::sin(b), 0, std::cos(b)})};
    IterativeContactSolver solver;
    static_cast<void>(solver.solve(bodies, contacts, exactly()));
    const double weight = 1.5 * kGravity * kStep;
    EXPECT_NEAR(solver.impulses()[0].normal, weight * std::sin(b) / std::sin(a + b), 1e-12);
    EXPECT_NEAR(solver.impulses()[1].normal, weight * std::sin(a) / std::sin(a + b), 1e-12);
}

/// A ball on an incline rolls if friction is at least 2/7 of the slope's tangent, and slips below.
TEST(IterativeContactSolver, BallRollsOrSlipsAtTheLimitOfItsFrictionCone) {
    const double angle = 0.5;
    const Vec3 normal{std::sin(angle), 0, std::cos(angle)};
    const Vec3 down{std::cos(angle), 0, -std::sin(angle)};
    const double edge = 2.0 / 7.0 * std::tan(angle);
    for (const double part : {0.0, 0.5, 1.0 - 1e-9, 1.0 + 1e-9, 2.0}) {
        std::vector<SolverBody> bodies{ball(1.0, 0.2, {0, 0, -kGravity * kStep})};
        const std::vector<SolverContact> contacts{on_wall(0, normal, part * edge)};
        IterativeContactSolver solver;
        static_cast<void>(solver.solve(bodies, contacts, exactly()));
        const double fall = kGravity * std::sin(angle) * kStep;
        const double expected = part < 1.0 ? fall * (1.0 - 2.0 / 7.0 * part) : 5.0 / 7.0 * fall;
        EXPECT_NEAR(dot(bodies[0].velocity, down), expected, 1e-14) << part;
        EXPECT_NEAR(dot(bodies[0].velocity, normal), 0.0, 1e-15);
    }
}

TEST(IterativeContactSolver, RollingFrictionHoldsABallOnAnInclineUpToItsTangent) {
    const double angle = 0.1;
    const Vec3 normal{std::sin(angle), 0, std::cos(angle)};
    for (const double part : {0.99, 1.01}) {
        std::vector<SolverBody> bodies{ball(1.0, 0.2, {0, 0, -kGravity * kStep})};
        std::vector<SolverContact> contacts{on_wall(0, normal, 1.0)};
        contacts[0].rolling_friction = part * 0.2 * std::tan(angle);
        IterativeContactSolver solver;
        static_cast<void>(solver.solve(bodies, contacts, exactly()));
        // Beyond the limit: m g sin r - moment = 7/5 m r^2 alpha.
        const double rolls =
            kGravity * kStep * (std::sin(angle) - part * std::tan(angle) * std::cos(angle)) * 5.0 / 7.0;
        EXPECT_NEAR(length(bodies[0].velocity), std::max(0.0, rolls), 1e-13) << part;
    }
}

TEST(IterativeContactSolver, MovingWallMovesTheBallOnIt) {
    std::vector<SolverBody> bodies{ball(1.0, 0.2, {0, 0, -kGravity * kStep})};
    std::vector<SolverContact> contacts{on_wall(0, kUp, 0.1)};
    contacts[0].wall_velocity = {3, 0, 0};
    IterativeContactSolver solver;
    static_cast<void>(solver.solve(bodies, contacts, exactly()));
    EXPECT_NEAR(bodies[0].velocity.x, 0.1 * kGravity * kStep, 1e-15);
    contacts[0].wall_velocity = {0, 0, 0.5};  // an approaching wall
    bodies[0] = ball(1.0, 0.2, {0, 0, -kGravity * kStep});
    static_cast<void>(solver.solve(bodies, contacts, exactly()));
    EXPECT_NEAR(bodies[0].velocity.z, 0.5, 1e-15);
}

TEST(IterativeContactSolver, ImpactReboundsByItsRestitution) {
    std::vector<SolverBody> bodies{ball(1.0, 0.1, {2, 0, 0}), ball(3.0, 0.1, {-1, 0, 0})};
    std::vector<SolverContact> contacts{between(0, 1, {-1, 0, 0})};
    contacts[0].restitution = 0.7;
    IterativeContactSolver solver;
    static_cast<void>(solver.solve(bodies, contacts, exactly()));
    EXPECT_NEAR(bodies[0].velocity.x - bodies[1].velocity.x, -0.7 * 3.0, 1e-13);
    EXPECT_NEAR(momentum({bodies[0], bodies[1]}).x, -1.0, 1e-13);
    contacts[0].touched = true;  // a pressing contact
    bodies = {ball(1.0, 0.1, {2, 0, 0}), ball(3.0, 0.1, {-1, 0, 0})};
    static_cast<void>(solver.solve(bodies, contacts, exactly()));
    EXPECT_NEAR(bodies[0].velocity.x, -0.25, 1e-13);
    EXPECT_NEAR(bodies[1].velocity.x, -0.25, 1e-13);
}

/// Moreau's law with e = 1: the row moves on as one body with the ball that is hit, and no energy is lost.
TEST(IterativeContactSolver, RowHitAtOneEndMovesAsOneBody) {
    constexpr std::uint32_t kCount = 6;
    std::vector<SolverBody> bodies(kCount, ball(0.2, 0.1));
    bodies[0].velocity = {1, 0, 0};
    std::vector<SolverContact> contacts;
    for (std::uint32_t i = 1; i < kCount; ++i) {
        contacts.push_back(between(i - 1, i, {-1, 0, 0}));
        contacts.back().restitution = 1.0;
        contacts.back().touched = i > 1;
    }
    IterativeContactSolver solver;
    const double before = kinetic_energy(bodies);
    EXPECT_TRUE(solver.solve(bodies, contacts, exactly(1e-15)).is_converged);
    EXPECT_NEAR(bodies[0].velocity.x, 2.0 / kCount - 1.0, 1e-12);
    for (std::uint32_t i = 1; i < kCount; ++i) EXPECT_NEAR(bodies[i].velocity.x, 2.0 / kCount, 1e-12);
    EXPECT_NEAR(kinetic_energy(bodies), before, 1e-12 * before);
}

TEST(IterativeContactSolver, SmallestRestitutionAppliesToEachConnectedImpactAlone) {
    std::vector<SolverBody> bodies{ball(1.0, 0.1, {0, 0, -1}), ball(1.0, 0.1, {0, 0, -1}), ball(1.0, 0.1, {0, 0, -1})};
    std::vector<SolverContact> contacts{on_wall(0, kUp), on_wall(1, kUp), between(2, 1, kUp)};
    contacts[0].restitution = 0.9;
    contacts[1].restitution = 0.5;
    contacts[2].restitution = 0.8;
    IterativeContactSolver solver;
    static_cast<void>(solver.solve(bodies, contacts, exactly()));
    EXPECT_NEAR(bodies[0].velocity.z, 0.9, 1e-12);
    EXPECT_NEAR(bodies[1].velocity.z, 0.5, 1e-12);
    EXPECT_NEAR(bodies[2].velocity.z, 0.5, 1e-12);  // it did not approach the other ball, which moves toward it
}

TEST(IterativeContactSolver, OverlapIsReducedByHalf) {
    std::vector<SolverBody> bodies{ball(1.0, 0.1), ball(1.0, 0.1)};
    std::vector<SolverContact> contacts{between(0, 1, kUp)};
    contacts[0].gap = -1e-6;
    IterativeContactSolver solver;
    const SolverReport report = solver.solve(bodies, contacts, exactly());
    EXPECT_NEAR(kStep * (bodies[0].velocity.z - bodies[1].velocity.z), kOverlapRelease * 1e-6, 1e-18);
    EXPECT_TRUE(report.is_converged);
}

TEST(IterativeContactSolver, RandomHeapsMeetTheConditions) {
    IterativeContactSolver solver;
    for (int seed = 0; seed < test::scaled(200); ++seed) {
        SCOPED_TRACE(seed);
        Heap heap = random_heap(static_cast<std::uint64_t>(seed), 60, true);
        for (SolverContact& contact : heap.contacts) contact.rolling_friction = contact.restitution = 0.0;
        const SolverReport report = solver.solve(heap.bodies, heap.contacts, exactly(1e-11));
        EXPECT_TRUE(report.is_converged) << report.residual;
        for (std::size_t i = 0; i < heap.contacts.size(); ++i) {
            EXPECT_LT(defect(heap.contacts[i], solver.impulses()[i], heap.bodies), 1e-10);
        }
    }
}

TEST(IterativeContactSolver, EnergyNeverGrowsEvenIfSweepsEndEarly) {
    IterativeContactSolver solver;
    for (int seed = 0; seed < test::scaled(600); ++seed) {
        SCOPED_TRACE(seed);
        Heap heap = random_heap(static_cast<std::uint64_t>(seed), 40, true);
        RandomSequence random(static_cast<std::uint64_t>(seed), 1, 0);
        for (SolverContact& contact : heap.contacts) {  // arbitrary, inconsistent starts
            contact.start.normal = random.uniform() < 0.5 ? 0.0 : 3.0 * random.uniform();
            contact.start.tangential = 3.0 * random.unit_vector();
        }
        SolverSettings settings = exactly(1e-10);
        settings.most_sweeps = seed % 3 == 0 ? 1 + seed % 7 : 2000;
        const double before = kinetic_energy(heap.bodies);
        const SolverReport report = solver.solve(heap.bodies, heap.contacts, settings);
        EXPECT_LE(kinetic_energy(heap.bodies), before * (1.0 + 1e-12));
        EXPECT_NEAR(kinetic_energy(heap.bodies) - before, report.energy_change, 1e-11 * before);
    }
}

TEST(IterativeContactSolver, MomentumIsConserved) {
    IterativeContactSolver solver;
    for (int seed = 0; seed < test::scaled(100); ++seed) {
        SCOPED_TRACE(seed);
        Heap heap = random_heap(static_cast<std::uint64_t>(seed), 60, false);
        double size = 0.0;
        for (const SolverBody& body : heap.bodies) size += length(body.velocity) / body.inverse_mass;
        const Vec3 before = momentum(heap.bodies);
        static_cast<void>(solver.solve(heap.bodies, heap.contacts, exactly(1e-10)));
        EXPECT_LT(length(momentum(heap.bodies) - before), 1e-12 * size);
    }
}

/// Accelerated sweeps update bodies and contacts separately.
TEST(IterativeContactSolver, VelocitiesOfBodiesMatchTheContactImpulses) {
    IterativeContactSolver solver;
    for (int seed = 0; seed < test::scaled(100); ++seed) {
        SCOPED_TRACE(seed);
        const Heap heap = random_heap(static_cast<std::uint64_t>(seed), 60, true);
        SolverSettings settings = exactly(1e-10);
        settings.most_sweeps = seed % 2 == 0 ? 10 + seed : 2000;
        std::vector<SolverBody> bodies = heap.bodies;
        static_cast<void>(solver.solve(bodies, heap.contacts, settings));
        std::vector<SolverBody> expected = heap.bodies;
        const auto give = [&](std::uint32_t k, const Vec3& impulse, const Vec3& turn) {
            expected[k].velocity += expected[k].inverse_mass * impulse;
            expected[k].spin += expected[k].inverse_inertia * turn;
        };
        double pushed = 0.0;
        for (std::size_t i = 0; i < heap.contacts.size(); ++i) {
            const SolverContact& contact = heap.contacts[i];
            const SolverImpulse& got = solver.impulses()[i];
            const Vec3 impulse = got.normal * contact.normal + got.tangential;
            const Vec3 arm = -cross(contact.normal, got.tangential);
            give(contact.a, impulse, heap.bodies[contact.a].radius * arm + got.moment);
            if (contact.b != SolverContact::kWall)
                give(contact.b, -impulse, heap.bodies[contact.b].radius * arm - got.moment);
            pushed = std::max(pushed, length(impulse));
        }
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            EXPECT_LT(length(bodies[k].velocity - expected[k].velocity), 1e-12 * (1.0 + pushed)) << k;
            EXPECT_LT(length(bodies[k].spin - expected[k].spin), 1e-12 * (1.0 + pushed)) << k;
        }
    }
}

TEST(IterativeContactSolver, SweepsForAColumnGrowLikeItsHeight) {
    IterativeContactSolver solver;
    const auto sweeps_of = [&](std::uint32_t count) {
        std::vector<SolverBody> bodies(count, ball(1.0, 0.1, -kGravity * kStep * kUp));
        std::vector<SolverContact> contacts{on_wall(0, kUp)};
        for (std::uint32_t k = 1; k < count; ++k) contacts.push_back(between(k, k - 1, kUp));
        const SolverReport report = solver.solve(bodies, contacts, exactly(1e-3 * kGravity * kStep));
        EXPECT_TRUE(report.is_converged);
        return report.sweeps;
    };
    const int low = sweeps_of(20);
    const int high = sweeps_of(80);
    EXPECT_LT(high, 6 * low) << low;  // not sixteen times as many
    EXPECT_LT(high, 240);
}

TEST(IterativeContactSolver, SlipHasItsOwnErrorLimitAndApproachDoesNot) {
    IterativeContactSolver solver;
    int all = 0;
    int fewer = 0;
    for (int seed = 0; seed < test::scaled(60); ++seed) {
        SCOPED_TRACE(seed);
        Heap heap = random_heap(static_cast<std::uint64_t>(seed), 60, true);
        for (SolverContact& contact : heap.contacts) {
            contact.restitution = contact.rolling_friction = 0.0;
            contact.friction = 0.5;
        }
        std::vector<SolverBody> bodies = heap.bodies;
        all += solver.solve(bodies, heap.contacts, exactly(1e-8)).sweeps;
        SolverSettings settings = exactly(1e-8);
        settings.slip = 1e-3;
        bodies = heap.bodies;
        const SolverReport report = solver.solve(bodies, heap.contacts, settings);
        fewer += report.sweeps;
        EXPECT_TRUE(report.is_converged);
        for (std::size_t i = 0; i < heap.contacts.size(); ++i) {
            const SolverContact& contact = heap.contacts[i];
            const Vec3 other = contact.b == SolverContact::kWall ? Vec3{} : bodies[contact.b].velocity;
            const double opening = dot(contact.normal, bodies[contact.a].velocity - other) + contact.gap / kStep;
            EXPECT_GT(opening, -1e-7) << i;
            if (solver.impulses()[i].normal > 0.0) {
                EXPECT_LT(opening, 1e-7) << i;
            }
        }
    }
    EXPECT_LT(fewer, all);
}

TEST(IterativeContactSolver, ContactBetweenTwoFixedBodiesHasNoImpulse) {
    std::vector<SolverBody> bodies(3, ball(1.0, 0.1));
    bodies[0].inverse_mass = bodies[0].inverse_inertia = bodies[1].inverse_mass = bodies[1].inverse_inertia = 0.0;
    bodies[2].velocity = -kGravity * kStep * kUp;
    SolverContact fixed = between(0, 1, kUp, 0.5);
    fixed.start.normal = 1.0;
    fixed.start.tangential = {0.1, 0, 0};
    const std::vector<SolverContact> contacts{fixed, between(2, 0, kUp, 0.5)};
    IterativeContactSolver solver;
    EXPECT_TRUE(solver.solve(bodies, contacts, exactly()).is_converged);
    EXPECT_EQ(solver.impulses()[0], SolverImpulse{});
    EXPECT_NEAR(solver.impulses()[1].normal, kGravity * kStep, 1e-15);
    EXPECT_NEAR(bodies[2].velocity.z, 0.0, 1e-15);
}

/// A cube of balls with six contacts each. Factorisations would take minutes.
TEST(IterativeContactSolver, ProblemTooLargeForTheDirectSolverIsLeftToSweeps) {
    constexpr std::uint32_t kSide = 16;
    SolverState ball;
    ball.velocity = {0, 0, -1};
    ball.inverse_mass = 1.0;
    ball.inverse_inertia = 2.5;
    std::vector<SolverState> states(std::size_t{kSide} * kSide * kSide, ball);
    std::vector<ContactConstraint> rows;
    const auto touch = [&](std::uint32_t a, std::uint32_t b, const Vec3& normal) {
        ContactConstraint row;
        row.a = a;
        row.b = b;
        row.normal = normal;
        row.friction = 0.5;
        row.rolling = ContactConstraint::kNone;
        rows.push_back(row);
    };
    const auto count = static_cast<std::uint32_t>(states.size());
    for (std::uint32_t k = 0; k < count; ++k) {
        if (k % kSide > 0) touch(k, k - 1, {1, 0, 0});
        if (k / kSide % kSide > 0) touch(k, k - kSide, {0, 1, 0});
        touch(k, k < kSide * kSide ? count : k - kSide * kSide, kUp);
    }
    states.push_back({});  // the floor
    const std::vector<SolverState> before = states;
    std::vector<RollingConstraint> rolling;
    DirectContactSolver direct;
    EXPECT_FALSE(direct.improve({before, states, count, rows, rolling}, 1e-6));
    for (std::uint32_t k = 0; k < count; ++k) ASSERT_EQ(states[k].velocity, before[k].velocity);
    for (const ContactConstraint& row : rows) ASSERT_EQ(row.impulse, ConstraintImpulse{});
}

TEST(IterativeContactSolver, BitsDoNotDependOnTheNumberOfThreads) {
    const Heap heap = random_heap(5, 3000, true);
    ASSERT_GT(heap.contacts.size(), 3000U);
    std::vector<SolverBody> expected;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        std::vector<SolverBody> bodies = heap.bodies;
        IterativeContactSolver solver;
        SolverSettings settings = exactly(1e-6);
        settings.most_sweeps = 60;
        static_cast<void>(solver.solve(bodies, heap.contacts, settings));
        if (expected.empty()) expected = bodies;
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            EXPECT_EQ(bodies[i].velocity, expected[i].velocity);
            EXPECT_EQ(bodies[i].spin, expected[i].spin);
        }
    }
}

/// Without friction the velocities are unique, but the distribution of load among rigid contacts is not.
TEST(IterativeContactSolver, OrderOfContactsChangesVelocitiesWithinTheToleranceOnly) {
    IterativeContactSolver solver;
    for (int seed = 0; seed < test::scaled(30); ++seed) {
        SCOPED_TRACE(seed);
        const Heap heap = random_heap(static_cast<std::uint64_t>(seed), 60, true);
        std::vector<SolverContact> contacts = heap.contacts;
        for (SolverContact& contact : contacts) {
            contact.friction = contact.rolling_friction = contact.restitution = 0.0;
        }
        std::vector<SolverBody> bodies = heap.bodies;
        static_cast<void>(solver.solve(bodies, contacts, exactly(1e-12)));
        std::reverse(contacts.begin(), contacts.end());
        std::rotate(contacts.begin(), contacts.begin() + 7, contacts.end());
        std::vector<SolverBody> others = heap.bodies;
        static_cast<void>(solver.solve(others, contacts, exactly(1e-12)));
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            EXPECT_LT(length(bodies[i].velocity - others[i].velocity), 1e-9);
        }
    }
}

TEST(IterativeContactSolver, MatchingWarmStartNeedsOneSweep) {
    Heap heap = random_heap(8, 100, true);
    for (SolverContact& contact : heap.contacts) contact.restitution = 0.0;
    std::vector<SolverBody> bodies = heap.bodies;
    IterativeContactSolver solver;
    const int cold = solver.solve(bodies, heap.contacts, exactly(1e-10)).sweeps;
    for (std::size_t i = 0; i < heap.contacts.size(); ++i) heap.contacts[i].start = solver.impulses()[i];
    bodies = heap.bodies;
    EXPECT_EQ(solver.solve(bodies, heap.contacts, exactly(1e-9)).sweeps, 1);
    EXPECT_GT(cold, 10);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
