// Spheres and points leave a ball, a table's edge and the top of a loop. Energy, normal force and the equation of slip
// determine the position at which they leave.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "claims/contact_scene.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;

/// State of a motion on a circle of radius rho: angle from the highest point, speed, and spin times radius. The
/// particle rolls or slips.
using Descent = std::array<double, 3>;

Descent descent_rates(const Descent& y, double rho, double friction, bool slips) {
    const double normal = kG * std::cos(y[0]) - y[1] * y[1] / rho;
    const double pull = kG * std::sin(y[0]);
    const double brake = slips ? friction * normal : 2.0 / 7.0 * pull;
    return {y[1] / rho, pull - brake, 2.5 * brake};
}

/// Returns the state when the normal force becomes zero, or at the given time. Slip begins when rolling would need more
/// friction than is available.
Descent reference_descent(double angle, double speed, double rho, double friction, bool rolls,
                          std::optional<double> time = {}) {
    Descent y{angle, speed, rolls ? speed : 0.0};
    bool slips = !rolls;
    const double h = time ? *time / std::ceil(*time / 1e-5) : 1e-5;
    const auto normal = [&](const Descent& z) { return kG * std::cos(z[0]) - z[1] * z[1] / rho; };
    for (double t = 0.0; time ? t < *time - 0.5 * h : true; t += h) {
        slips = slips || 2.0 / 7.0 * kG * std::sin(y[0]) > friction * normal(y);
        const Descent next =
            runge_kutta_step(y, h, [&](const Descent& z) { return descent_rates(z, rho, friction, slips); });
        if (normal(next) <= 0.0) {
            y[0] += (next[0] - y[0]) * normal(y) / (normal(y) - normal(next));
            break;
        }
        y = next;
    }
    return y;
}

/// Returns the angle from the vertical at which the parabola of a flight has the same curvature as the circle about
/// `center`. The condition is |v|^2 + (x - center) . g = 0. A motion on the circle leaves the circle at this angle.
double angle_of_leaving(const Particle& flying, const Vec3& center) {
    const Vec3 g{0, 0, -kG};
    const Vec3 x = flying.position - center;
    // The left side of the condition is 3/2 g . g t^2 + 3 v . g t + ... Newton's method finds the root closest to t =
    // 0.
    double t = 0.0;
    for (int k = 0; k < 50; ++k) {
        const Vec3 v = flying.velocity + t * g;
        const Vec3 r = x + t * flying.velocity + 0.5 * t * t * g;
        t -= (length_squared(v) + dot(r, g)) / (3.0 * dot(v, g));
    }
    const Vec3 r = x + t * flying.velocity + 0.5 * t * t * g;
    return std::acos(r.z / length(r));
}

/// Returns the first state in free flight, more than 1 mm off the circle of radius rho about `center`.
Particle first_in_flight(const ContactScene& scene, const Vec3& center, double rho) {
    Particle found = scene.particle;
    bool flies = false;
    watch(scene, [&](double, const Particle& p) {
        flies = length(p.position - center) > rho + 1e-3;
        if (flies) found = p;
        return !flies;
    });
    EXPECT_TRUE(flies);
    return found;
}

struct Off {
    const char* name;
    double radius, friction, angle;  ///< radius of the particle, friction coefficient, and start angle
};

ContactScene off_a_ball(const Off& off, double time_step) {
    ContactScene scene;
    scene.colliders = {{"ball", BallShape{1.0, {}}, 0}};
    scene.materials = {{"", 0.0, off.friction}};
    scene.particle =
        particle_of((1.0 + (off.radius > 0.0 ? off.radius : 1e-13)) * Vec3{std::sin(off.angle), 0, std::cos(off.angle)},
                    {}, off.radius);
    scene.time_step = time_step;
    scene.duration = 5.0;
    return scene;
}

class OffABall : public ::testing::TestWithParam<Off> {
protected:
    [[nodiscard]] double leaving_angle(double time_step) const {
        const Off& off = GetParam();
        return angle_of_leaving(first_in_flight(off_a_ball(off, time_step), {}, 1.0 + off.radius), {});
    }
};

INSTANTIATE_TEST_SUITE_P(Of, OffABall,
                         ::testing::Values(Off{"Rolling", 0.1, 1000.0, 0.02}, Off{"Sliding", 0.0, 0.0, 0.02},
                                           Off{"SphereWithoutFriction", 0.1, 0.0, 0.02},
                                           Off{"RollingThenSlipping", 0.1, 0.3, 0.02},
                                           Off{"LittleFriction", 0.1, 0.05, 0.02}),
                         [](const auto& test) { return std::string(test.param.name); });

double expected_angle(const Off& off) {
    if (off.friction >= 1000.0) return std::acos(10.0 / 17.0 * std::cos(off.angle));
    if (off.friction == 0.0) return std::acos(2.0 / 3.0 * std::cos(off.angle));
    const double rho = 1.0 + off.radius;
    return reference_descent(off.angle, 0.0, rho, off.friction, true)[0];
}

TEST_P(OffABall, LeavesAtTheAngleOfTheClosedForm) {
    EXPECT_NEAR(leaving_angle(1e-3), expected_angle(GetParam()), 1e-4);
}

TEST_P(OffABall, LeavesAtThatAngleToSecondOrderInTheStep) {
    const double expected = expected_angle(GetParam());
    const double coarse = std::fabs(leaving_angle(0.02) - expected);
    // At a quarter of the step, the error falls to a sixteenth. The limit 2e-5 is the accuracy of the reference and of
    // the angle.
    EXPECT_LT(std::fabs(leaving_angle(0.005) - expected), std::max(coarse / 16.0 * 1.5, 2e-5));
}

// The support must end in the same step in which the closed form leaves the ball.
TEST_P(OffABall, IsSupportedUntilItLeaves) {
    const ContactScene scene = off_a_ball(GetParam(), 1e-3);
    Simulation simulation = simulation_of(scene);
    double angle = 0.0;
    const auto angle_now = [&] {
        const Vec3& x = simulation.particles().position[0];
        return std::acos(x.z / length(x));
    };
    bool has_been_supported = false;
    while (!simulation.finished()) {
        simulation.step();
        if (simulation.particles().support[0][0] == kNoSupport && has_been_supported) break;
        has_been_supported = has_been_supported || simulation.particles().support[0][0] != kNoSupport;
        angle = angle_now();
    }
    const double expected = expected_angle(GetParam());
    EXPECT_LE(angle, expected + 1e-4);
    EXPECT_GE(angle_now(), expected - 1e-4);
}

/// Returns a sphere of 0.1 m that touches the edge x = 0, z = 0 of a table that fills x < 0, z < 0.
ContactScene on_the_edge(bool as_mesh, double angle, double time_step) {
    ContactScene scene;
    ColliderDescription box{"table", CuboidShape{{2, 2, 1}, {{-1, 0, -0.5}}}, 0};
    ColliderDescription mesh = mesh_collider(box_mesh({-2, -1, -1}, {0, 1, 0}));
    scene.colliders = {as_mesh ? mesh : box};
    scene.materials = {{"", 0.0, 1000.0}};
    scene.particle = particle_of(0.1 * Vec3{std::sin(angle), 0.3, std::cos(angle)}, {}, 0.1);
    scene.time_step = time_step;
    scene.duration = 1.0;
    return scene;
}

class TableEdge : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Of, TableEdge, ::testing::Values(false, true),
                         [](const auto& test) { return std::string(test.param ? "Mesh" : "Box"); });

/// Returns the angle by which a sphere has turned about the edge after `time`.
double pivoted(bool as_mesh, double angle, double time_step, double time) {
    ContactScene scene = on_the_edge(as_mesh, angle, time_step);
    scene.duration = time;
    const Particle end = end_of(scene);
    EXPECT_NEAR(std::hypot(end.position.x, end.position.z), 0.1, 1e-12);
    return std::atan2(end.position.x, end.position.z);
}

// The rotation of the sphere about the edge obeys 7/5 r theta'' = g sin theta. In 0.32 s the angle grows from 0.05 rad
// to about 0.4 rad.
TEST_P(TableEdge, LetsASpherePivotAsItsEquationPredictsToSecondOrder) {
    const double time = 0.32;
    const double expected = reference_descent(0.05, 0.0, 0.1, 1000.0, true, time)[0];
    ASSERT_GT(expected, 0.2);
    ASSERT_LT(expected, 0.8);
    EXPECT_NEAR(pivoted(GetParam(), 0.05, 1e-3, time), expected, 1e-4);
    // The longest step is 0.02 s, because a contact interval lasts at most 0.02 s here.
    const double coarse = std::fabs(pivoted(GetParam(), 0.05, 0.02, time) - expected);
    // At half the step, the error falls to a quarter. The limit 1e-9 is the accuracy of the reference.
    EXPECT_LT(std::fabs(pivoted(GetParam(), 0.05, 0.01, time) - expected), std::max(coarse / 4.0 * 1.2, 1e-9));
}

TEST_P(TableEdge, ReleasesItAtTenSeventeenths) {
    const ContactScene scene = on_the_edge(GetParam(), 0.05, 1e-3);
    const Vec3 edge{0, 0.03, 0};
    const double angle = angle_of_leaving(first_in_flight(scene, edge, 0.1), edge);
    EXPECT_NEAR(angle, std::acos(10.0 / 17.0 * std::cos(0.05)), 1e-4);
}

// The sphere rolls over the table and then over its edge. The contact continues from the plane to the edge without any
// loss of energy or time.
TEST_P(TableEdge, SupportsASphereThatRollsOverTheTable) {
    for (const double speed : {0.05, 0.3}) {
        ContactScene scene = on_the_edge(GetParam(), 0.0, 1e-3);
        scene.particle.position = {-0.021, 0.03, 0.1};
        scene.particle.velocity = {speed, 0, 0};
        scene.particle.spin = {0, speed / 0.1, 0};
        const Vec3 edge{0, 0.03, 0};
        const double angle = angle_of_leaving(first_in_flight(scene, edge, std::hypot(0.1, 0.021)), edge);
        EXPECT_NEAR(std::cos(angle), (10.0 + 7.0 * speed * speed / (kG * 0.1)) / 17.0, 1e-4) << speed;
    }
}

/// Returns a particle at the lowest point of a horizontal cylinder of radius 1 m along y. The start energy is `factor`
/// times the kinetic energy with which the particle just completes the loop.
ContactScene loop(double radius, double friction, double factor) {
    const double rho = 1.0 - radius;
    const double speed = std::sqrt(factor * (radius > 0.0 ? 27.0 / 7.0 : 5.0) * kG * rho);
    ContactScene scene;
    scene.colliders = {{"loop", CylinderShape{1.0, 4.0, {{}, {1, 0, 0}, 90.0}}, 0}};
    scene.materials = {{"", 0.0, friction}};
    scene.particle = particle_of({0, 0, -rho * (1.0 - 1e-14)}, {speed, 0, 0}, radius);
    if (radius > 0.0) scene.particle.spin = {0, speed / radius, 0};
    scene.time_step = 1e-3;
    scene.duration = 2.0;
    return scene;
}

/// Returns the largest distance from the wall before the particle is back at the lowest point, in m.
double farthest_off(const ContactScene& scene) {
    double farthest = 0.0;
    double height = 0.0;
    watch(scene, [&](double time, const Particle& p) {
        farthest = std::max(farthest, 1.0 - p.radius - std::hypot(p.position.x, p.position.z));
        height = std::max(height, p.position.z);
        return time < 0.3 || p.position.x < 0.0 || p.position.z > 0.0;
    });
    EXPECT_GT(height, 0.9 * (1.0 - scene.particle.radius));
    return farthest;
}

struct Loop {
    const char* name;
    double radius, friction;
};
class LoopInACylinder : public ::testing::TestWithParam<Loop> {};
INSTANTIATE_TEST_SUITE_P(Of, LoopInACylinder, ::testing::Values(Loop{"Sliding", 0.0, 0.0}, Loop{"Rolling", 0.1, 10.0}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(LoopInACylinder, IsCompletedATenthOfAPercentAboveTheLimitAndNotBelow) {
    const auto [name, radius, friction] = GetParam();
    // The particle is in contact on the whole loop, up to the rounding of positions of about 1 m.
    EXPECT_LT(farthest_off(loop(radius, friction, 1.001)), 1e-12);
    // Below the limit energy, the parabola near the top has a curvature 0.5 % smaller than the loop. The particle
    // separates by about 1e-4 m.
    EXPECT_GT(farthest_off(loop(radius, friction, 0.999)), 1e-5);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
