#include "ricochet/response/project.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "response/course.h"
#include "response/solids.h"
#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "support/counts.h"
#include "support/parity.h"
#include "support/random_draws.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;
using testing::floor_mesh;
using testing::mesh_collider;
using testing::plane_collider;

constexpr double kG = 9.81;
constexpr double kOffset = 1e-6;
const Vec3 kGravity{0, 0, -kG};

ColliderDescription ground() { return plane_collider({0, 0, 0}, {0, 0, 1}); }

MovingParticle particle_at(const Vec3& position, const Vec3& velocity = {}, double radius = 0.0) {
    return {{position, velocity, 2.5, radius, 0.0}, {}, 0, 0};
}

Course course_of(std::vector<ColliderDescription> colliders, const Material& material, const Vec3& gravity,
                 double offset = kOffset, IntegratorKind integrator = IntegratorKind::ballistic) {
    ResponseSettings settings;
    settings.integrator = integrator;
    settings.project.offset = offset;
    return {std::move(colliders), material, gravity, ResponseKind::project, settings};
}

/// Returns the energy over the mass, in J/kg, of a particle of any radius above the floor.
double energy(const MovingParticle& particle) {
    return kG * (particle.state.position.z - particle.state.radius) + 0.5 * length_squared(particle.state.velocity);
}

TEST(Project, DepthOfTheFreeStepIsReported) {
    for (const double radius : {0.0, 0.2}) {
        for (const double step : {0.07, 0.1, 0.13, 0.31}) {
            for (const bool is_mesh : {false, true}) {
                Course course = course_of({is_mesh ? mesh_collider(floor_mesh(2.0, 3)) : ground()}, {}, kGravity);
                MovingParticle ball = particle_at({0.1, 0.2, 1.0 + radius}, {}, radius);
                const double behind = std::ceil(std::sqrt(2.0 / kG) / step) * step;  // first step end below
                MoveOutcome outcome;
                while (ball.state.time < behind - 0.5 * step) {
                    EXPECT_EQ(outcome.depth, 0.0);
                    outcome = course.move(ball, step);
                }
                EXPECT_NEAR(outcome.depth, 0.5 * kG * behind * behind - 1.0, 1e-13);
                EXPECT_EQ(outcome.bounces, 1U);
                EXPECT_NEAR(ball.state.position.z, radius + kOffset, 1e-15);
                EXPECT_NEAR(ball.state.velocity.z, kG * behind, 1e-13);
            }
        }
    }
}

TEST(Project, ImpactIsResolvedAtTheEndOfItsStep) {
    const double t0 = std::sqrt(2.0 / kG);
    for (const double step : {0.1, 0.01, 0.003}) {
        Course course = course_of({ground()}, {}, kGravity);
        MovingParticle ball = particle_at({0, 0, 1});
        while (course.scratch.records.empty()) (void)course.move(ball, step);
        EXPECT_GE(course.impact_times().front(), t0);
        EXPECT_LE(course.impact_times().front(), t0 + step);
    }
}

TEST(Project, FirstBounceLiftsAnElasticBallByItsDepthAndTheOffset) {
    for (const double offset : {1e-9, 1e-6, 1e-3}) {
        for (const double step : {0.011, 0.1, 0.17}) {
            SCOPED_TRACE(::testing::Message() << "offset " << offset << ", step " << step);
            Course course = course_of({ground()}, {}, kGravity, offset);
            MovingParticle ball = particle_at({0, 0, 1});
            while (course.scratch.records.empty()) (void)course.move(ball, step);
            const double fallen = std::ceil(std::sqrt(2.0 / kG) / step) * step;
            const double depth = 0.5 * kG * fallen * fallen - 1.0;
            EXPECT_NEAR((energy(ball) - kG) / (kG * (depth + offset)), 1.0, 1e-9);
        }
    }
}

TEST(Project, EnergyGainIsTheSumOfTheLiftsOverManyBounces) {
    for (const double step : {1.0 / 60.0, 0.01, 0.0013}) {
        SCOPED_TRACE(step);
        Course course = course_of({ground()}, {}, kGravity);
        MovingParticle ball = particle_at({0, 0, 1});
        double lifts = 0.0;
        int bounces = 0;
        for (int k = 0; k < 20000; ++k) {
            const MoveOutcome outcome = course.move(ball, step);
            if (outcome.depth > 0.0) lifts += outcome.depth + kOffset;
            bounces += static_cast<int>(outcome.bounces);
        }
        EXPECT_GT(bounces, 1);
        EXPECT_NEAR((energy(ball) - kG) / (kG * lifts), 1.0, 1e-9);
        EXPECT_GT(lifts, 1e-3 * step);
    }
}

TEST(Project, VelocityOfASeparatingParticleStaysUnchanged) {
    Course course = course_of({ground()}, {"", 0.5, 0.3}, {});
    MovingParticle near_it = particle_at({0, 0, 0.1 * kOffset}, {1, 2, 1e-7});
    EXPECT_EQ(course.move(near_it, 0.1).bounces, 0U);
    EXPECT_EQ(near_it.state.velocity, (Vec3{1, 2, 1e-7}));
    EXPECT_NEAR(near_it.state.position.z, 0.1 * kOffset + 1e-8, 1e-20);  // not moved either
    MovingParticle behind = particle_at({0, 0, 1});
    course.enrol(behind);
    behind.sides[0] = {1, true, true};
    behind.state.position.z = -0.5;
    behind.state.velocity = {1, 2, 3};
    const MoveOutcome outcome = course.move(behind, 0.1);
    EXPECT_NEAR(outcome.depth, 0.2, 1e-15);
    EXPECT_EQ(outcome.bounces, 0U);
    EXPECT_EQ(behind.state.velocity, (Vec3{1, 2, 3}));
    EXPECT_NEAR(length(behind.state.position - Vec3{0.1, 0.2, kOffset}), 0.0, 1e-15);
}

class ProjectOnASlope : public ::testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Integrators, ProjectOnASlope,
                         ::testing::Values(IntegratorKind::ballistic, IntegratorKind::symplectic_euler,
                                           IntegratorKind::midpoint, IntegratorKind::rk4),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

constexpr double kAngle = 0.5;
const Vec3 kNormal{std::sin(kAngle), 0, std::cos(kAngle)};
const Vec3 kDownhill{std::cos(kAngle), 0, -std::sin(kAngle)};

// A step from rest covers g sin(theta) dt^2 / 2 on the parabola, and twice that with symplectic Euler.
TEST_P(ProjectOnASlope, CreepUnderStaticFrictionIsTheFreeDistanceOfAStep) {
    const double share = GetParam() == IntegratorKind::symplectic_euler ? 1.0 : 0.5;
    for (const double step : {0.02, 0.01, 0.001}) {
        SCOPED_TRACE(step);
        Course course = course_of({plane_collider({0, 0, 0}, kNormal)}, {"", 0.4, 1.1 * std::tan(kAngle)}, kGravity,
                                  kOffset, GetParam());
        MovingParticle block = particle_at(kOffset * kNormal);
        for (int k = 1; k <= 200; ++k) {
            EXPECT_TRUE(course.move(block, step).is_resting()) << k;
            EXPECT_EQ(block.state.velocity, Vec3{});
        }
        const double crept = 200 * share * kG * std::sin(kAngle) * step * step;
        EXPECT_NEAR(dot(block.state.position, kDownhill) / crept, 1.0, 1e-9);
        EXPECT_GE(dot(block.state.position, kNormal), 0.0);
        EXPECT_LE(dot(block.state.position, kNormal), kOffset * (1.0 + 1e-9));
    }
}

TEST_P(ProjectOnASlope, SlideAboveTheAngleOfFrictionMatchesCoulombsLaw) {
    for (const double part : {0.0, 0.5, 0.9}) {
        const double friction = part * std::tan(kAngle);
        Course course =
            course_of({plane_collider({0, 0, 0}, kNormal)}, {"", 0.4, friction}, kGravity, kOffset, GetParam());
        MovingParticle block = particle_at(kOffset * kNormal);
        constexpr double kStep = 0.01;
        for (int k = 0; k < 100; ++k) (void)course.move(block, kStep);
        const double expected = kG * (std::sin(kAngle) - friction * std::cos(kAngle));
        EXPECT_NEAR(dot(block.state.velocity, kDownhill), expected, 1e-9 * expected);
        // Friction acts only at the ends of steps, so the particle is ahead by at most a step's worth of friction and
        // distance.
        EXPECT_NEAR(dot(block.state.position, kDownhill), 0.5 * expected, kG * kStep);
        EXPECT_NEAR(dot(block.state.position, kNormal), 0.0, 2.0 * kOffset);
    }
}

/// Free particles that bounce without loss. Counts the particles on the wrong side after each step.
struct Flock {
    std::vector<MovingParticle> particles;
    std::uint64_t bounces = 0;
    int stayed = 0;

    template <class IsRight>
    int fly(Course& course, int steps, double step, const IsRight& is_right) {
        int wrong = 0;
        for (int k = 0; k < steps; ++k) {
            for (MovingParticle& particle : particles) {
                const MoveOutcome outcome = course.move(particle, step);
                bounces += outcome.bounces;
                stayed += static_cast<int>(outcome.stayed);
                wrong += is_right(particle.state.position) ? 0 : 1;
            }
        }
        return wrong;
    }
};

class ProjectAtSolids : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Meshes, ProjectAtSolids, ::testing::ValuesIn(testing::kSolids),
                         [](const auto& name) { return std::string(name.param); });

TEST_P(ProjectAtSolids, InsideParticlesStayInsideAtModerateSpeed) {
    const TriangleMesh mesh = testing::solid(GetParam());
    const testing::ParityOracle oracle(mesh);
    for (const double radius : {0.0, 0.03}) {
        Course course = course_of({mesh_collider(mesh)}, {}, {});
        RandomSequence random(7, 0, 0);
        Flock flock;
        while (flock.particles.size() < 20) {
            const Vec3 position = testing::random_vector(random, 1.2);
            if (!oracle.inside(position)) continue;
            flock.particles.push_back(
                particle_at(position, testing::scaled({random.unit_vector(), 0.5 + random.uniform()}), radius));
        }
        EXPECT_EQ(flock.fly(course, 400, 0.02, [&](const Vec3& p) { return oracle.inside(p); }), 0);
        EXPECT_GT(flock.bounces, 20U);
        EXPECT_EQ(flock.stayed, 0);
    }
}

TEST_P(ProjectAtSolids, OutsideParticlesStayOutsideAtModerateSpeed) {
    const TriangleMesh mesh = testing::solid(GetParam());
    const testing::ParityOracle oracle(mesh);
    const Vec3 corner{1.6, 1.6, 1.6};
    const auto is_right = [&](const Vec3& p) { return oracle.side(p) == Side::outside && max_abs(p) < corner.x; };
    for (const double radius : {0.0, 0.03}) {
        Course course = course_of({mesh_collider(mesh), mesh_collider(testing::box_mesh(-corner, corner))}, {}, {});
        RandomSequence random(8, 0, 0);
        Flock flock;
        while (flock.particles.size() < 20) {
            const Vec3 position =
                1.4 * (Vec3{random.uniform(), random.uniform(), random.uniform()} * 2.0 - Vec3{1, 1, 1});
            if (oracle.side(position) != Side::outside) continue;
            flock.particles.push_back(
                particle_at(position, testing::scaled({random.unit_vector(), 0.5 + random.uniform()}), radius));
        }
        EXPECT_EQ(flock.fly(course, 400, 0.02, is_right), 0);
        EXPECT_GT(flock.bounces, 20U);
        EXPECT_EQ(flock.stayed, 0);
    }
}

// A particle flies out over the rim of a sheet and back underneath. Its path equals the path without a sheet, bit for
// bit.
TEST(ProjectAtARim, ParticleMayGoAroundTheRimAndKeepsItsNewSide) {
    for (const double beyond : {1e-3, 0.01, 0.2}) {  // m beyond the rim, at the plane of the sheet
        SCOPED_TRACE(beyond);
        const Vec3 wind{-6, 0, -2};
        Course course = course_of({mesh_collider(floor_mesh(1.0, 4))}, {}, wind);
        Course nothing = course_of({}, {}, wind);
        const double through = 0.1 + std::sqrt(0.11);  // 0.1 + 0.2 t - t^2 = 0
        const double reached = 3.0 * through - 3.0 * through * through;
        MovingParticle around = particle_at({1.0 + beyond - reached, 0.1, 0.1}, {3, 0, 0.2});
        MovingParticle free = around;
        for (int k = 0; k < 100; ++k) {
            EXPECT_EQ(course.move(around, 0.01).bounces, 0U) << k;
            (void)nothing.move(free, 0.01);
            ASSERT_EQ(around.state.position, free.state.position) << k;
        }
        EXPECT_LT(around.state.position.x, 0.9);
        EXPECT_LT(around.state.position.z, -0.5);
        around.state.velocity = {0, 0, 4};
        std::uint32_t bounces = 0;
        for (int k = 0; k < 40; ++k) {
            bounces += course.move(around, 0.01).bounces;
            ASSERT_LT(around.state.position.z, 0.0);
        }
        EXPECT_EQ(bounces, 1U);
    }
}

TEST(ProjectAtARim, FlightOverTheRimAndBackKeepsTheSide) {
    Course course = course_of({mesh_collider(floor_mesh(1.0, 4))}, {"", 0.9, 0.0}, kGravity);
    MovingParticle ball = particle_at({0.5, 0.1, 1.0}, {4, 0, 0});
    for (int k = 0; k < 25; ++k) (void)course.move(ball, 0.01);  // out over the rim
    EXPECT_GT(ball.state.position.x, 1.4);
    ball.state.velocity = {-4, 0, 1};
    std::uint32_t bounces = 0;
    for (int k = 0; k < 30; ++k) {
        bounces += course.move(ball, 0.01).bounces;
        ASSERT_GT(ball.state.position.z, 0.0) << k;
    }
    EXPECT_LT(ball.state.position.x, 0.9);
    for (int k = 0; k < 30; ++k) bounces += course.move(ball, 0.01).bounces;
    EXPECT_EQ(bounces, 1U);
}

// A documented limit: a particle that ends a step in the far half of a plate is moved to its far side.
TEST(ProjectAtAPlate, ParticleInTheFarHalfIsMovedToTheFarSide) {
    const TriangleMesh plate = testing::box_mesh({0, -1, -1}, {0.1, 1, 1});
    for (const double depth : {0.03, 0.049, 0.051, 0.07}) {
        Course course = course_of({mesh_collider(plate)}, {}, {});
        MovingParticle bullet = particle_at({-0.5, 0.1, 0.2}, {10.0 * (0.5 + depth), 0, 0});
        const MoveOutcome outcome = course.move(bullet, 0.1);
        const bool is_near = depth < 0.05;
        EXPECT_NEAR(outcome.depth, is_near ? depth : 0.1 - depth, 1e-14);
        EXPECT_NEAR(bullet.state.position.x, is_near ? -kOffset : 0.1 + kOffset, 1e-14);
        EXPECT_EQ(bullet.state.velocity.x > 0.0, !is_near);
    }
}

TEST(ProjectInACorner, ParticleIsMovedInFrontOfAllWalls) {
    const std::vector<ColliderDescription> corner{plane_collider({0, 0, 0}, {1, 0, 0}),
                                                  plane_collider({0, 0, 0}, {0, 1, 0}), ground()};
    RandomSequence random(9, 0, 0);
    for (int i = 0; i < test::scaled(200); ++i) {
        Course course = course_of(corner, {}, {});
        const Vec3 v{-1.0 - random.uniform(), -1.0 - random.uniform(), -1.0 - random.uniform()};
        MovingParticle particle = particle_at({0.5, 0.5, 0.5}, v);
        EXPECT_EQ(course.move(particle, 1.0).stayed, 0U);
        EXPECT_EQ(particle.state.velocity, -v);
        for (const double offset : {particle.state.position.x, particle.state.position.y, particle.state.position.z}) {
            EXPECT_NEAR(offset, kOffset, 1e-15);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
