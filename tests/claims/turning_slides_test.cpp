// Slides on flat surfaces with friction that changes its direction. Closed forms describe points and spheres on a
// slope, over seams and for any time step. The slope is modelled as a level floor under a tilted force.
#include <gtest/gtest.h>

#include <cmath>

#include "collision/worlds.h"
#include "response/course.h"
#include "ricochet/response/contact_motion.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;
using testing::floor_mesh;
using testing::mesh_collider;
using testing::plane_collider;

constexpr double kG = 9.81;
constexpr double kAngle = 0.4;

const Vec3 kForce{kG * std::sin(kAngle), 0.0, -kG* std::cos(kAngle)};

Course slope_of(const ColliderDescription& floor, double friction) {
    return Course({floor}, {"", 0.0, friction}, kForce);
}

MovingParticle kicked_sideways(double speed, double radius = 0.0) {
    return {{{0.0, 0.1, radius + 1e-14}, {0.0, speed, 0.0}, 1.0, radius, 0.0}, {}, 0, 0};
}

// If the slope has the angle of friction, the sum of the speed and the downhill velocity is constant.
TEST(APointKickedAcrossASlope, KeepsSpeedPlusDownhillVelocityAtTheAngleOfFriction) {
    for (const double step : {0.2, 0.05, 0.01}) {
        Course course = slope_of(mesh_collider(floor_mesh(50.0, 97)), std::tan(kAngle));
        MovingParticle point = kicked_sideways(3.0);
        double fastest = 3.0;
        for (double time = 0.0; time < 8.0; time += step) {
            ASSERT_EQ(course.move(point, step).unsimulated_time, 0.0);
            const double speed = length(point.state.velocity);
            EXPECT_NEAR(speed + point.state.velocity.x, 3.0, 4e-6) << "step " << step << ", time " << time;
            EXPECT_LE(speed, fastest * (1.0 + 1e-9));
            fastest = speed;
        }
        EXPECT_NEAR(fastest, 1.5, 1e-3);
        EXPECT_NEAR(point.state.position.z, 0.0, 1e-11);
    }
}

// Until the sphere rolls, its slip obeys the equation of a point whose friction coefficient is 7/2 times as large.
TEST(ASphereKickedAcrossASlope, KeepsSlipPlusDownhillSlip) {
    const double radius = 0.1;
    const double friction = std::tan(kAngle) / 3.5;
    for (const double step : {0.05, 0.01}) {
        Course course = slope_of(mesh_collider(floor_mesh(50.0, 97)), friction);
        MovingParticle sphere = kicked_sideways(3.0, radius);
        for (double time = 0.0; time < 2.0; time += step) {
            ASSERT_EQ(course.move(sphere, step).unsimulated_time, 0.0);
            const Vec3 slip = slip_velocity({sphere.state.velocity, sphere.spin}, radius, {0.0, 0.0, 1.0});
            EXPECT_NEAR(length(slip) + slip.x, 3.0, 4e-6) << "step " << step << ", time " << time;
        }
        EXPECT_NEAR(sphere.state.position.z, radius, 1e-11);
    }
}

TEST(ASlideThatTurns, EndsAtTheSamePositionOnAMeshAndOnAPlane) {
    Course plane = slope_of(plane_collider({}, {0.0, 0.0, 1.0}), 0.2);
    Course mesh = slope_of(mesh_collider(floor_mesh(50.0, 97)), 0.2);
    MovingParticle on_plane = kicked_sideways(3.0);
    MovingParticle on_mesh = on_plane;
    for (int k = 0; k < 100; ++k) {
        (void)plane.move(on_plane, 0.02);
        (void)mesh.move(on_mesh, 0.02);
        ASSERT_LT(length(on_plane.state.position - on_mesh.state.position), 1e-7) << k;
        ASSERT_LT(length(on_plane.state.velocity - on_mesh.state.velocity), 1e-7) << k;
    }
}

TEST(ASlideThatTurns, LosesTheEnergyThatFrictionTakesOnItsPath) {
    const double friction = 0.2;
    Course course = slope_of(mesh_collider(floor_mesh(50.0, 97)), friction);
    MovingParticle point = kicked_sideways(3.0);
    const auto energy = [&] { return 0.5 * length_squared(point.state.velocity) - dot(kForce, point.state.position); };
    const double start = energy();
    double path = 0.0;
    for (int k = 0; k < 4000; ++k) {
        const Vec3 before = point.state.position;
        (void)course.move(point, 0.0005);
        path += length(point.state.position - before);
    }
    EXPECT_NEAR(start - energy(), friction * kG * std::cos(kAngle) * path, 1e-6 * start);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
