// A sphere rolls on a floor along a wall. A frictionless wall has no effect. With a rough wall, the motion matches an
// integration of the equations of motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "claims/contact_scene.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;
constexpr double kSphereRadius = 0.1;

/// Returns a sphere on the floor z = 0 that touches the wall y = 0. A component of gravity of `press` m/s^2 presses the
/// sphere onto the wall.
ContactScene along_the_wall(double floor_friction, double wall_friction, double press, double time_step) {
    ContactScene scene;
    scene.colliders = {plane_collider({}, {0, 0, 1}), plane_collider({}, {0, 1, 0})};
    scene.materials = {{"floor", 0.5, floor_friction}, {"wall", 0.5, wall_friction}};
    scene.gravity = {0, -press, -kG};
    scene.particle =
        particle_of({0, kSphereRadius, kSphereRadius}, {1, 0, 0}, kSphereRadius, {0, 1 / kSphereRadius, 0});
    scene.time_step = time_step;
    scene.duration = 2.0;
    return scene;
}

TEST(AWallWithoutFriction, DoesNotBrakeASphereThatRollsAlongIt) {
    for (const double press : {0.01, 1.0, 20.0}) {
        for (const double friction : {0.0, 0.3, 2.0}) {
            for (const double step : {0.001, 0.02, 0.1}) {
                const Particle end = end_of(along_the_wall(friction, 0.0, press, step));
                // The bounds are required. No force acts along the wall, so the errors are rounding errors.
                EXPECT_NEAR(end.position.x, 2.0, 2e-9) << press << ", " << friction << ", " << step;
                EXPECT_NEAR(end.velocity.x, 1.0, 1e-9) << press << ", " << friction << ", " << step;
            }
        }
    }
}

/// State of the sphere: path length, speed v, and the three components of w, the spin times the radius.
/// The slip on the floor is (v - w_y, w_x) along (x, y). The slip on the wall is (v + w_z, -w_x) along (x, z).
using State = std::array<double, 5>;
using Slip = std::array<double, 2>;

Slip floor_slip(const State& y) { return {y[1] - y[3], y[2]}; }
Slip wall_slip(const State& y) { return {y[1] + y[4], -y[2]}; }
double size(const Slip& slip) { return std::hypot(slip[0], slip[1]); }

/// Slip speed, in m/s, below which a slip counts as ended. The friction of the ignored slip would move the sphere by
/// less than 1e-10 m.
constexpr double kEnded = 1e-11;

/// Equations of motion, with forces per mass. After its slip has ended, a surface sticks. This is valid in the cases
/// here, because the required friction is 1/3.5 of the other surface's friction and below the limit.
class Walls {
public:
    Walls(double floor_friction, double wall_friction, double press)
        : floor_(floor_friction), wall_(wall_friction), press_(press) {}

    /// Returns the state after `time` s.
    State after(State y, double time) {
        while (time > 0.0) {
            stop_slips(y);
            double h = std::min(time, 1e-4);
            const State rate = rates(y);
            for (const auto& slip : {floor_slip, wall_slip}) {
                const double change = std::hypot(slip(rate)[0], slip(rate)[1]);
                // A slip reaches zero at a finite rate, so the step is limited in proportion to the slip.
                if (size(slip(y)) > kEnded && change > 0.0) h = std::min(h, 0.05 * size(slip(y)) / change);
            }
            y = runge_kutta_step(y, h, [&](const State& z) { return rates(z); });
            time -= h;
        }
        return y;
    }

private:
    void stop_slips(State& y) {
        floor_slips_ = floor_slips_ && size(floor_slip(y)) > kEnded;
        wall_slips_ = wall_slips_ && size(wall_slip(y)) > kEnded;
        if (!floor_slips_ || !wall_slips_) y[2] = 0.0;
        if (!floor_slips_) y[3] = y[1];
        if (!wall_slips_) y[4] = -y[1];
    }
    /// Returns the time derivatives. The normal forces are N_floor = g - W_z and N_wall = press - F_y. F and W are the
    /// friction forces of the floor and the wall, each opposite to its slip.
    [[nodiscard]] State rates(const State& y) const {
        const Slip f = floor_slips_ ? along(floor_slip(y), floor_) : Slip{};
        const Slip w = wall_slips_ ? along(wall_slip(y), wall_) : Slip{};
        const double determinant = 1.0 - f[1] * w[1];
        const double n_f = (kG - press_ * w[1]) / determinant;
        const double n_w = (press_ - kG * f[1]) / determinant;
        Slip force_f{n_f * f[0], n_f * f[1]};
        Slip force_w{n_w * w[0], n_w * w[1]};
        // The friction of a sticking surface follows from the friction of the other surface.
        if (!floor_slips_) force_f = {-force_w[0] / 3.5, force_w[1]};
        if (!wall_slips_) force_w = {-force_f[0] / 3.5, force_f[1]};
        return {y[1], force_f[0] + force_w[0], 2.5 * (force_f[1] - force_w[1]), -2.5 * force_f[0], 2.5 * force_w[0]};
    }
    static Slip along(const Slip& slip, double friction) {
        const double factor = -friction / std::max(size(slip), 1e-300);
        return {factor * slip[0], factor * slip[1]};
    }

    double floor_, wall_, press_;
    bool floor_slips_ = true;
    bool wall_slips_ = true;
};

struct Case {
    double floor_friction, wall_friction, press;
    Vec3 spin;  ///< initial spin times the radius
};

TEST(AWallWithFriction, BrakesARollingSphereAsTheEquationsPredict) {
    for (const Case& c :
         {Case{0.3, 0.3, 0.01, {0, 1, 0}}, Case{0.3, 0.2, 1.0, {0, 1, 0}}, Case{0.5, 0.5, 8.0, {0, 1, 0}},
          Case{0.1, 0.6, 3.0, {0, 0.5, 2}}, Case{0.2, 0.1, 3.0, {0.7, -0.4, 0.3}}, Case{0.1, 0.6, 3.0, {-1, 0.5, 2}},
          Case{0.6, 0.6, 9.0, {1, 3, -4}}}) {
        ContactScene scene = along_the_wall(c.floor_friction, c.wall_friction, c.press, 0.01);
        scene.particle.spin = c.spin / kSphereRadius;
        for (const double time : {0.1, 2.0}) {
            const State expected =
                Walls(c.floor_friction, c.wall_friction, c.press).after({0, 1, c.spin.x, c.spin.y, c.spin.z}, time);
            for (const double step : {0.001, 0.01, 0.1}) {
                scene.time_step = step;
                scene.duration = time;
                const Particle end = end_of(scene);
                // The bounds are required.
                EXPECT_NEAR(end.position.x, expected[0], 1e-6) << c.press << ", " << time << ", " << step;
                EXPECT_NEAR(end.velocity.x, expected[1], 1e-6) << c.press << ", " << time << ", " << step;
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
