#include "ricochet/response/exact.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "response/course.h"
#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;
using testing::floor_mesh;
using testing::mesh_collider;
using testing::plane_collider;

constexpr double kG = 9.81;
constexpr double kPi = 3.14159265358979323846;

ForceInput at(const Vec3& position, const Vec3& velocity = {}) { return {position, velocity, 1.0, 0.0, 0.0}; }

ColliderDescription ground() { return plane_collider({0, 0, 0}, {0, 0, 1}); }

class BouncingBall : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Restitutions, BouncingBall, ::testing::Values(0.5, 0.8, 0.9));

// Impact n is at t0 (1 + 2 (e + ... + e^n)) with t0 = sqrt(2 h / g). The apex after it has the height h e^(2n).
TEST_P(BouncingBall, ImpactsAndApexesMatchTheClosedForm) {
    const double e = GetParam();
    const double h = 1.0;
    const double t0 = std::sqrt(2.0 * h / kG);
    Course course({ground()}, {"", e, 0.0}, {0, 0, -kG});
    double t = t0;
    double half_hop = t0;
    for (int n = 0; n < 6; ++n) {
        half_hop *= e;
        ForceInput state = at({0, 0, h});
        const MoveOutcome outcome = course.move(state, t + half_hop);  // to the apex after impact n
        ASSERT_EQ(outcome.bounces, static_cast<std::uint32_t>(n + 1));
        EXPECT_NEAR(course.impact_times().back(), t, 1e-13 * t);
        EXPECT_NEAR(state.position.z, h * std::pow(e, 2.0 * (n + 1)), 1e-13);
        EXPECT_NEAR(state.velocity.z, 0.0, 1e-12);
        t += 2.0 * half_hop;
    }
}

TEST_P(BouncingBall, BallRestsAfterTheClosedFormTime) {
    const double e = GetParam();
    const double total = std::sqrt(2.0 / kG) * (1.0 + e) / (1.0 - e);
    Course course({ground()}, {"", e, 0.0}, {0, 0, -kG});
    ForceInput state = at({0, 0, 1});
    EXPECT_FALSE(course.move(state, 0.9 * total).is_resting());
    const MoveOutcome outcome = course.move(state, 0.2 * total);
    EXPECT_TRUE(outcome.is_resting());
    EXPECT_EQ(state.velocity, Vec3{});
    EXPECT_GT(state.position.z, 0.0);
    EXPECT_LT(state.position.z, 1e-12);
    const Vec3 before = state.position;
    EXPECT_TRUE(course.move(state, 1.0).is_resting());
    EXPECT_EQ(state.position, before);
}

// The parabola is exact for any time step, and a bounce loses no accuracy.
TEST_P(BouncingBall, ResultDoesNotDependOnTheTimeStep) {
    Course course({ground()}, {"", GetParam(), 0.0}, {0, 0, -kG});
    ForceInput whole = at({0, 0, 1}, {0.3, 0, 0});
    ForceInput steps = whole;
    (void)course.move(whole, 1.1);
    for (int k = 0; k < 110; ++k) (void)course.move(steps, 0.01);
    EXPECT_NEAR(length(whole.position - steps.position), 0.0, 1e-12);
    EXPECT_NEAR(length(whole.velocity - steps.velocity), 0.0, 1e-11);
}

TEST(ExactResponse, ElasticBallKeepsItsHeight) {
    Course course({ground()}, {"", 1.0, 0.0}, {0, 0, -kG});
    ForceInput state = at({0, 0, 1});
    for (int k = 0; k < test::scaled(20000); ++k) (void)course.move(state, 0.0625);
    const double energy = kG * state.position.z + 0.5 * length_squared(state.velocity);
    EXPECT_NEAR(energy / kG, 1.0, 1e-9);
}

// The method remains symplectic with bounces, so the energy error stays bounded.
TEST(ExactResponse, SymplecticEulerKeepsTheEnergyOfAnElasticBallBounded) {
    Course course({ground()}, {"", 1.0, 0.0}, {0, 0, -kG}, IntegratorKind::symplectic_euler);
    ForceInput state = at({0, 0, 1});
    double lowest = 2.0;
    double highest = 0.0;
    for (int k = 0; k < test::scaled(100000); ++k) {
        (void)course.move(state, 0.001);
        const double height = state.position.z + 0.5 * length_squared(state.velocity) / kG;
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
    }
    EXPECT_GT(lowest, 0.99);
    EXPECT_LT(highest, 1.01);
}

// Successive hops of an elastic ball down a slope have the lengths 8 h sin(theta) (1, 2, 3, ...), and all take 2 t0.
TEST(ExactResponse, HopsDownASlopeMatchTheClosedForm) {
    for (const double degrees : {30.0, 45.0}) {
        const double theta = degrees * kPi / 180.0;
        Course course({plane_collider({0, 0, 0}, {std::sin(theta), 0, std::cos(theta)})}, {"", 1.0, 0.0}, {0, 0, -kG});
        const double h = 1.0;
        const double t0 = std::sqrt(2.0 * h / kG);
        const Vec3 downhill{std::cos(theta), 0, -std::sin(theta)};
        ForceInput state = at({0, 0, h});
        (void)course.move(state, t0 * (1.0 + 1e-12));
        double travelled = 0.0;
        for (int hop = 1; hop <= 8; ++hop) {
            (void)course.move(state, 2.0 * t0);
            const double length_of_hop = dot(state.position, downhill) - travelled;
            const double expected = 8.0 * h * std::sin(theta) * hop;
            EXPECT_NEAR(length_of_hop, expected, 1e-10 * expected) << "hop " << hop;
            travelled += length_of_hop;
        }
    }
}

TEST(ExactResponse, CornerOfThreeWallsReflectsEverythingStraightBack) {
    const std::vector<ColliderDescription> walls{plane_collider({0, 0, 0}, {1, 0, 0}),
                                                 plane_collider({0, 0, 0}, {0, 1, 0}), ground()};
    Course course(walls, {"", 1.0, 0.0}, {});
    RandomSequence random(1, 0, 0);
    for (int i = 0; i < test::scaled(500); ++i) {
        const Vec3 v{-1.0 - random.uniform(), -1.0 - random.uniform(), -1.0 - random.uniform()};
        ForceInput state = at({1.0 + random.uniform(), 1.0 + random.uniform(), 1.0 + random.uniform()}, v);
        EXPECT_EQ(course.move(state, 10.0).bounces, 3U);
        EXPECT_EQ(state.velocity, -v) << i;
    }
    ForceInput into_the_corner = at({1, 1, 1}, {-1, -1, -1});
    (void)course.move(into_the_corner, 2.0);
    EXPECT_EQ(into_the_corner.velocity, (Vec3{1, 1, 1}));
    EXPECT_NEAR(length(into_the_corner.position - Vec3{1, 1, 1}), 0.0, 1e-13);
}

// G. Galperin, "Playing pool with pi", Regular and Chaotic Dynamics 8, 2003: a particle enters parallel to one wall of
// a wedge of arctan(10^-k). The number of its reflections is the first digits of pi. The exit follows by unfolding the
// wedge.
TEST(ExactResponse, ReflectionsInAWedgeCountTheDigitsOfPi) {
    for (const auto& [tangent, count] :
         {std::pair{0.1, 31U}, std::pair{0.01, 314U}, std::pair{0.001, 3141U}, std::pair{0.0001, 31415U}}) {
        const double angle = std::atan(tangent);
        const std::vector<ColliderDescription> walls{plane_collider({0, 0, 0}, {0, 1, 0}),
                                                     plane_collider({0, 0, 0}, {std::sin(angle), -std::cos(angle), 0})};
        Course course(walls, {"", 1.0, 0.0}, {}, IntegratorKind::ballistic, 100000);
        ForceInput state = at({200, 25.0 * tangent, 0}, {-1, 0, 0});
        const MoveOutcome outcome = course.move(state, 1000.0);
        EXPECT_EQ(outcome.bounces, count);
        EXPECT_EQ(outcome.unsimulated_time, 0.0);
        const double exit = count % 2 == 0 ? kPi - count * angle : (count + 1) * angle - kPi;
        EXPECT_NEAR(std::atan2(state.velocity.y, state.velocity.x), exit, 1e-11);
        EXPECT_NEAR(length(state.velocity), 1.0, 1e-12);
    }
}

TEST(ExactResponse, SpentBudgetKeepsAValidPositionAndCountsTheTime) {
    const double angle = std::atan(0.01);
    const std::vector<ColliderDescription> walls{plane_collider({0, 0, 0}, {0, 1, 0}),
                                                 plane_collider({0, 0, 0}, {std::sin(angle), -std::cos(angle), 0})};
    Course course(walls, {"", 1.0, 0.0}, {}, IntegratorKind::ballistic, 50);
    ForceInput state = at({200, 0.5, 0}, {-1, 0, 0});
    std::uint32_t bounces = 0;
    double simulated = 0.0;
    int exhausted = 0;
    for (int step = 0; step < 14; ++step) {
        const MoveOutcome outcome = course.move(state, 100.0);
        EXPECT_LE(outcome.bounces, 50U);
        bounces += outcome.bounces;
        simulated += 100.0 - outcome.unsimulated_time;
        exhausted += outcome.unsimulated_time > 0.0 ? 1 : 0;
        EXPECT_GT(state.position.y, 0.0);
        EXPECT_EQ(course.world.side_of_surface(1, state.position), 1);
    }
    // Only time is lost: in the end all bounces have happened.
    EXPECT_EQ(bounces, 314U);
    EXPECT_GE(exhausted, 6);
    EXPECT_NEAR(state.time, simulated, 1e-9);
}

class Sliding : public ::testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Integrators, Sliding,
                         ::testing::Values(IntegratorKind::ballistic, IntegratorKind::symplectic_euler),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

/// A slope through the origin, and a point just above it.
struct Slope {
    explicit Slope(double angle)
        : normal{std::sin(angle), 0, std::cos(angle)}, downhill{std::cos(angle), 0, -std::sin(angle)} {}
    Vec3 normal;
    Vec3 downhill;
};

TEST_P(Sliding, SlideDownASlopeWithFrictionMatchesTheClosedForm) {
    const double angle = 0.6;
    const double friction = 0.25;
    const Slope slope(angle);
    const double a = kG * (std::sin(angle) - friction * std::cos(angle));
    Course course({plane_collider({0, 0, 0}, slope.normal)}, {"", 0.3, friction}, {0, 0, -kG}, GetParam());
    ForceInput state = at(1e-15 * slope.normal);
    constexpr int kSteps = 400;
    const double dt = 1.0 / kSteps;
    for (int k = 0; k < kSteps; ++k) (void)course.move(state, dt);
    EXPECT_NEAR(dot(state.velocity, slope.downhill), a, 1e-9);
    // The positions of symplectic Euler are first order: x = a t^2 (1 + dt / t) / 2.
    const double expected = GetParam() == IntegratorKind::ballistic ? 0.5 * a : 0.5 * a * (1.0 + dt);
    EXPECT_NEAR(dot(state.position, slope.downhill), expected, 1e-9);
    EXPECT_NEAR(dot(state.position, slope.normal), 0.0, 1e-12);
}

TEST_P(Sliding, StaticFrictionHolds) {
    const double angle = 0.6;
    const Slope slope(angle);
    Course course({plane_collider({0, 0, 0}, slope.normal)}, {"", 0.3, 1.01 * std::tan(angle)}, {0, 0, -kG},
                  GetParam());
    ForceInput state = at(1e-15 * slope.normal);
    (void)course.move(state, 0.01);
    const Vec3 settled = state.position;
    for (int k = 0; k < 1000; ++k) EXPECT_TRUE(course.move(state, 0.01).is_resting());
    EXPECT_EQ(state.velocity, Vec3{});
    EXPECT_EQ(state.position, settled);
}

TEST_P(Sliding, FrictionStopsTheParticleAfterTheClosedFormDistance) {
    Course course({ground()}, {"", 0.0, 0.5}, {0, 0, -kG}, GetParam());
    ForceInput state = at({0, 0, 1e-15}, {2, 0, 0});
    bool resting = false;
    const double dt = 1.0 / 512;
    for (int k = 0; k < 512; ++k) resting = course.move(state, dt).is_resting();
    EXPECT_TRUE(resting);
    EXPECT_EQ(state.velocity, Vec3{});
    const double distance = 4.0 / (2.0 * 0.5 * kG);
    EXPECT_NEAR(state.position.x, distance, GetParam() == IntegratorKind::ballistic ? 1e-9 : 2.0 * dt);
}

TEST_P(Sliding, ParticleLeavesAConvexEdgeInFreeFlight) {
    Course course({mesh_collider(floor_mesh(1.0, 1))}, {"", 0.5, 0.0}, {0, 0, -kG}, GetParam());
    ForceInput state = at({0, 0.25, 1e-15}, {2, 0, 0});
    const double dt = 1.0 / 1024;
    for (int k = 0; k < 1024; ++k) (void)course.move(state, dt);
    EXPECT_NEAR(state.position.x, 2.0, 1e-12);
    // The particle leaves the edge at t = 0.5. Symplectic Euler falls a first-order amount further.
    const double fall = 0.5 * kG * 0.25;
    EXPECT_NEAR(state.position.z, -fall, GetParam() == IntegratorKind::ballistic ? 1e-9 : kG * dt);
}

TEST_P(Sliding, FloorOfManyTrianglesActsLikeAPlane) {
    Course plane({ground()}, {"", 0.2, 0.1}, {0, 0, -kG}, GetParam());
    Course mesh({mesh_collider(floor_mesh(8.0, 37))}, {"", 0.2, 0.1}, {0, 0, -kG}, GetParam());
    ForceInput on_plane = at({-3, 0.1, 1e-15}, {4, 0.3, 0});
    ForceInput on_mesh = on_plane;
    for (int k = 0; k < 300; ++k) {
        (void)plane.move(on_plane, 0.01);
        (void)mesh.move(on_mesh, 0.01);
    }
    EXPECT_NEAR(length(on_plane.position - on_mesh.position), 0.0, 1e-9);
    EXPECT_NEAR(length(on_plane.velocity - on_mesh.velocity), 0.0, 1e-9);
}

/// Returns a mesh of the walls of a pit. All walls pass through the origin and are steep enough to slide down.
TriangleMesh pit(int sides) {
    TriangleMesh mesh{{{0, 0, 0}}, {}};
    for (int k = 0; k < sides; ++k) {
        const double angle = 2.0 * kPi * k / sides;
        mesh.vertices.push_back({2.0 * std::cos(angle), 2.0 * std::sin(angle), 1.5});
    }
    for (int k = 0; k < sides; ++k) {
        mesh.triangles.push_back(
            {0, static_cast<std::uint32_t>(1 + k), static_cast<std::uint32_t>(1 + (k + 1) % sides)});
    }
    return mesh;
}

/// Returns a trough along y of two long quadrilaterals.
TriangleMesh trough() {
    return {{{-2, -5, 1.5}, {-2, 5, 1.5}, {0, -5, 0}, {0, 5, 0}, {2, -5, 1.5}, {2, 5, 1.5}},
            {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}}};
}

/// Lets a particle fall into a valley around the y axis or the origin. Returns true if it rests at the end.
bool settles_in(Course& course, ForceInput& state, int steps) {
    bool resting = false;
    for (int k = 0; k < steps; ++k) {
        const MoveOutcome outcome = course.move(state, 0.01);
        EXPECT_EQ(outcome.unsimulated_time, 0.0) << k;
        resting = outcome.is_resting();
    }
    return resting;
}

TEST(ValleyOfTwoWalls, ParticleComesToRest) {
    Course course({mesh_collider(trough())}, {"", 0.5, 0.2}, {0, 0, -kG});
    ForceInput state = at({0.7, 0.1, 2.0}, {0.5, 0.2, 0});
    EXPECT_TRUE(settles_in(course, state, 2000));
    EXPECT_EQ(state.velocity, Vec3{});
    EXPECT_LT(state.position.z, 1e-6);
}

TEST(ValleyOfThreeWalls, ParticleRestsAtTheBottomWithoutFriction) {
    Course course({mesh_collider(pit(3))}, {"", 0.4, 0.0}, {0, 0, -kG});
    ForceInput state = at({0.2, 0.1, 1.0});
    EXPECT_TRUE(settles_in(course, state, 4000));
    EXPECT_EQ(state.velocity, Vec3{});
    EXPECT_LT(state.position.z, 1e-6);
}

// Symplectic Euler drifts without force. A kick may therefore move the particle by up to g dt^2.
TEST(PitOfFourFaces, CirclingParticleComesToRestWithoutSpendingTheBudget) {
    // Four faces, as planes through one point, between which a particle circled on a rocky terrain.
    const std::vector<Vec3> normals{
        {0.7241, -0.4512, 0.5215}, {-0.2919, -0.6258, 0.7233}, {-0.3135, 0.5465, 0.7766}, {0.7505, 0.3803, 0.5405}};
    std::vector<ColliderDescription> planes;
    for (const Vec3& normal : normals) planes.push_back(plane_collider({0, 0, 0}, normal));
    Course course(std::move(planes), {"rock", 0.35, 0.2}, {0, 0, -kG});
    ForceInput state{{0, 0, 1e-4}, {-1e-3, 1e-2, -7e-3}, 1.0, 0.0, 0.0};
    MoveOutcome outcome;
    for (int step = 0; step < 20; ++step) {
        outcome = course.move(state, 1.0 / 60.0);
        EXPECT_EQ(outcome.unsimulated_time, 0.0) << "step " << step;
        EXPECT_LT(outcome.bounces, 500U) << "step " << step;
        for (const Vec3& normal : normals) EXPECT_GT(dot(state.position, normal), 0.0) << "step " << step;
    }
    EXPECT_TRUE(outcome.is_resting());
    EXPECT_LT(length(state.position), 1e-4);
}

TEST(Valleys, ParticleStaysWithinOneKickOfTheBottomWithSymplecticEuler) {
    for (const TriangleMesh& valley : {trough(), pit(3)}) {
        Course course({mesh_collider(valley)}, {"", 0.4, 0.1}, {0, 0, -kG}, IntegratorKind::symplectic_euler);
        ForceInput state = at({0.2, 0.1, 1.0});
        (void)settles_in(course, state, 2000);
        for (int k = 0; k < 100; ++k) {
            (void)course.move(state, 0.01);
            EXPECT_LT(state.position.z, kG * 0.01 * 0.01);
        }
    }
}

TEST(ExactResponse, ParticleExactlyOnASurfaceIsOnTheSideOfTheNormal) {
    for (const auto& collider : {ground(), mesh_collider(floor_mesh(2.0, 2))}) {
        for (const IntegratorKind kind : {IntegratorKind::ballistic, IntegratorKind::symplectic_euler}) {
            Course course({collider}, {"", 0.5, 0.0}, {0, 0, -kG}, kind);
            ForceInput rests = at({0.1, 0.2, 0});
            const MoveOutcome outcome = course.move(rests, 0.1);
            EXPECT_LE(outcome.bounces, 2U);
            EXPECT_GT(rests.position.z, 0.0);
            EXPECT_TRUE(outcome.is_resting());
            ForceInput rises = at({0.1, 0.2, 0}, {0, 0, 5});
            EXPECT_EQ(course.move(rises, 0.1).bounces, 0U);
            EXPECT_GT(rises.position.z, 0.4);
            ForceInput falls = at({0.0, 0.0, 0}, {0, 0, -5});
            EXPECT_GE(course.move(falls, 0.1).bounces, 1U);
            EXPECT_GT(falls.position.z, 0.1);
        }
    }
}

TEST(ExactResponse, ParticleOnASurfaceWithoutForcesStaysThere) {
    Course course({ground()}, {"", 1.0, 0.0}, {});
    ForceInput state = at({1, 2, 0});
    const MoveOutcome outcome = course.move(state, 1.0);
    EXPECT_EQ(outcome.bounces, 0U);
    EXPECT_EQ(outcome.unsimulated_time, 0.0);
    EXPECT_NEAR(state.position.z, 0.0, 1e-14);
}

// The contact offset depends on the contact point alone, so the resolution of the mesh changes no bit.
TEST(ExactResponse, TwoTrianglesManyTrianglesAndAPlaneGiveEqualBounces) {
    for (const double restitution : {1.0, 0.8}) {
        for (const IntegratorKind kind : {IntegratorKind::ballistic, IntegratorKind::symplectic_euler}) {
            Course plane({ground()}, {"", restitution, 0.1}, {0, 0, -kG}, kind);
            Course two({mesh_collider(floor_mesh(50.0, 1))}, {"", restitution, 0.1}, {0, 0, -kG}, kind);
            Course many({mesh_collider(floor_mesh(50.0, 81))}, {"", restitution, 0.1}, {0, 0, -kG}, kind);
            RandomSequence random(5, 0, 0);
            for (int i = 0; i < test::scaled(100); ++i) {
                const Vec3 velocity = 3.0 * random.unit_vector();
                ForceInput a = at({random.uniform(), random.uniform(), 1.0}, velocity);
                ForceInput b = a;
                ForceInput c = a;
                for (int k = 0; k < 60; ++k) {
                    (void)plane.move(a, 1.0 / 60);
                    (void)two.move(b, 1.0 / 60);
                    (void)many.move(c, 1.0 / 60);
                }
                EXPECT_EQ(a.position, b.position) << i;
                EXPECT_EQ(a.position, c.position) << i;
                EXPECT_EQ(a.velocity, b.velocity) << i;
                EXPECT_EQ(a.velocity, c.velocity) << i;
            }
        }
    }
}

TEST(ExactResponse, ImpulsesAddUpToTheChangeOfMomentum) {
    Course course({mesh_collider(testing::box_mesh({-1, -1, -1}, {1, 1, 1}))}, {"", 0.7, 0.2}, {});
    ForceInput state{{0.1, 0.2, 0.3}, {3, 4, 5}, 2.5, 0.0, 0.0};
    const Vec3 before = state.velocity;
    (void)course.move(state, 2.0);
    Vec3 given;
    for (const SurfaceHit& hit : course.scratch.hits) given += hit.impulse;
    EXPECT_LE(length(given + 2.5 * (state.velocity - before)), 1e-13);
    EXPECT_GT(course.impact_times().size(), 3U);
}

// Covers flight, bounces, impact cascades, sliding into walls, rolling and rest. The impulse on the surfaces equals
// gravity's impulse minus the particle's change of momentum.
TEST(ExactResponse, MomentumIsRecordedInEveryKindOfContact) {
    for (const IntegratorKind kind :
         {IntegratorKind::ballistic, IntegratorKind::rk4, IntegratorKind::symplectic_euler}) {
        for (const double radius : {0.0, 0.05}) {
            SCOPED_TRACE(std::string(name_of(kind)) + ", radius " + std::to_string(radius));
            Course course({mesh_collider(testing::box_mesh({-1, -1, 0}, {1, 1, 3}))}, {"", 0.6, 0.15}, {0, 0, -kG},
                          kind);
            MovingParticle particle{{{0.1, 0.2, 0.6}, {3.0, 1.7, 1.0}, 2.0, radius, 0.0}, {}, 0, 0};
            const Vec3 start = particle.state.velocity;
            Vec3 given;
            bool resting = false;
            for (int k = 0; k < 400; ++k) {
                resting = course.move(particle, 0.01).is_resting();
                for (const SurfaceHit& hit : course.scratch.hits) given += hit.impulse;
                const double time = 0.01 * (k + 1);
                const Vec3 expected = 2.0 * (time * Vec3{0, 0, -kG} - (particle.state.velocity - start));
                ASSERT_LT(length(given - expected), 1e-10) << "step " << k;
            }
            EXPECT_EQ(resting, radius == 0.0);  // a sphere continues to roll
        }
    }
}

TEST(ExactResponse, RestingContactTransfersTheWeight) {
    Course course({ground()}, {"", 0.5, 0.3}, {0, 0, -kG});
    ForceInput state{{0, 0, 1e-15}, {}, 2.0, 0.0, 0.0};
    (void)course.move(state, 0.5);
    Vec3 given;
    for (const SurfaceHit& hit : course.scratch.hits) given += hit.impulse;
    EXPECT_NEAR(given.z, -2.0 * kG * 0.5, 1e-6);
}

TEST(ExactResponse, StatesOutsideTheValidRangeAreFrozen) {
    Course course({ground()}, {"", 0.5, 0.0}, {0, 0, -kG});
    for (const Vec3& v : {Vec3{1e300, 0, 0}, Vec3{0, std::nan(""), 0}, Vec3{0, 0, -INFINITY}}) {
        ForceInput state = at({0, 0, 1}, v);
        const MoveOutcome outcome = course.move(state, 1.0);
        EXPECT_TRUE(outcome.is_frozen());
        EXPECT_EQ(state.position, (Vec3{0, 0, 1}));
    }
    ForceInput lost = at({0, 0, std::nan("")});
    EXPECT_TRUE(course.move(lost, 1.0).is_frozen());
}

TEST(ExactResponse, LosslessContactNeverRests) {
    Course course({ground()}, {"", 1.0, 0.0}, {0, 0, -kG});
    ForceInput state = at({0, 0, 1e-9});
    const MoveOutcome outcome = course.move(state, 0.01);
    EXPECT_FALSE(outcome.is_resting());
    EXPECT_GT(outcome.bounces, 100U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
