// Friction on curved shapes depends on the whole normal force, including the part due to the centripetal acceleration.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "claims/contact_scene.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;
constexpr double kFriction = 0.02;  // small, so that spheres keep slipping

/// Motion along a circle of radius rho. On the outside, the normal force per mass is g cos(angle) - v^2 / rho, with the
/// angle from the highest point. On the inside, it is g cos(angle) + v^2 / rho, with the angle from the lowest point.
struct Slide {
    const char* name;
    double radius;
    bool inside, cylinder;
    double gravity;
};

/// Angle, speed and radius times spin of a particle that slips on a circle.
using State = std::array<double, 3>;

State rates(const Slide& slide, const State& y) {
    const double rho = slide.inside ? 1.0 - slide.radius : 1.0 + slide.radius;
    const double bend = y[1] * y[1] / rho;
    const double normal = slide.gravity * std::cos(y[0]) + (slide.inside ? bend : -bend);
    const double pull = slide.gravity * std::sin(y[0]) * (slide.inside ? -1.0 : 1.0);
    return {y[1] / rho, pull - kFriction * normal, slide.radius > 0.0 ? 2.5 * kFriction * normal : 0.0};
}

ContactScene scene_of(const Slide& slide, double angle, double speed, double time_step) {
    // Points are 1e-13 m off the surface, because a point rounded to the other side would stay there.
    const double off = slide.radius > 0.0 ? slide.radius : 1e-13;
    const double up = slide.inside ? -1.0 : 1.0;
    const double rho = 1.0 - up * -off;
    ContactScene scene;
    scene.colliders = {slide.cylinder
                           ? ColliderDescription{"cylinder", CylinderShape{1.0, 4.0, {{}, {1, 0, 0}, 90.0}}, 0}
                           : ColliderDescription{"ball", BallShape{1.0, {}}, 0}};
    scene.materials = {{"", 0.0, kFriction}};
    scene.gravity = {0, 0, -slide.gravity};
    scene.particle = particle_of(rho * Vec3{std::sin(angle), 0, up * std::cos(angle)},
                                 speed * Vec3{std::cos(angle), 0, -up * std::sin(angle)}, slide.radius);
    scene.time_step = time_step;
    scene.duration = 0.3;
    return scene;
}

class FrictionOnACurve : public ::testing::TestWithParam<Slide> {};

INSTANTIATE_TEST_SUITE_P(Of, FrictionOnACurve,
                         ::testing::Values(Slide{"PointsInABall", 0.0, true, false, kG},
                                           Slide{"PointsInACylinder", 0.0, true, true, kG},
                                           Slide{"PointsOnABall", 0.0, false, false, kG},
                                           Slide{"PointsInABallWithoutGravity", 0.0, true, false, 0.0},
                                           Slide{"SpheresInABall", 0.1, true, false, kG},
                                           Slide{"SpheresInACylinder", 0.1, true, true, kG},
                                           Slide{"SpheresOnABall", 0.1, false, false, kG},
                                           Slide{"SpheresInABallWithoutGravity", 0.1, true, false, 0.0}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(FrictionOnACurve, BrakesByTheWholeNormalForce) {
    const Slide& slide = GetParam();
    const double angle = slide.inside ? -0.3 : 0.1;
    const double speed = slide.inside ? 2.0 : 0.5;
    State y{angle, speed, 0.0};
    for (int k = 0; k < 3000; ++k) {
        y = runge_kutta_step(y, 1e-4, [&](const State& z) { return rates(slide, z); });
    }
    for (const double step : {0.001, 0.01}) {
        const ContactScene scene = scene_of(slide, angle, speed, step);
        const Particle end = end_of(scene);
        // The bounds are the same as for other motions on curves. The bound is 1e-4 at a step of 1e-3, and by second
        // order 1e-2 at a step of 1e-2.
        const double bound = 1e-4 * (step / 1e-3) * (step / 1e-3);
        EXPECT_NEAR(std::atan2(end.position.x, std::fabs(end.position.z)), y[0], bound) << step;
        EXPECT_NEAR(length(end.velocity), y[1], bound) << step;
        EXPECT_NEAR(slide.radius * std::fabs(end.spin.y), y[2], bound) << step;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
