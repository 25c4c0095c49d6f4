// Sliding points and rolling spheres swing like pendulums in a spherical bowl.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "claims/contact_scene.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;

ColliderDescription bowl() { return {"bowl", BallShape{1.0, {}}, 0}; }

/// Returns a sphere or point at rest on the inside of the unit ball, at an angle from the lowest point. Points are
/// 1e-13 m inside, because a point rounded to the other side would stay there.
ContactScene in_bowl(double angle, double radius, double friction, double time_step, double duration) {
    ContactScene scene;
    scene.colliders = {bowl()};
    scene.materials = {{"", 0.0, friction}};
    scene.particle =
        particle_of((1.0 - (radius > 0.0 ? radius : 1e-13)) * Vec3{std::sin(angle), 0, -std::cos(angle)}, {}, radius);
    scene.time_step = time_step;
    scene.duration = duration;
    return scene;
}

/// Returns the complete elliptic integral K(k), by the arithmetic-geometric mean.
double complete_elliptic_integral(double k) {
    double a = 1.0;
    double b = std::sqrt(1.0 - k * k);
    while (a - b > 1e-15) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return 0.5 * kPiNumber / a;
}

/// Returns the time at which x passes through zero between two states that are `h` apart in time. x is interpolated by
/// the cubic through both states. The interpolation error h^4 x''''/ 384 is below 1e-9 m for the swings and steps here.
double zero_between(const Particle& from, const Particle& to, double h) {
    double low = 0.0;
    double high = 1.0;
    const auto x = [&](double s) {
        const double r = 1.0 - s;
        return from.position.x * r * r * (1.0 + 2.0 * s) + to.position.x * s * s * (3.0 - 2.0 * s) +
               h * s * r * (from.velocity.x * r - to.velocity.x * s);
    };
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (x(middle) * from.position.x > 0.0 ? low : high) = middle;
    }
    return low * h;
}

/// Returns the mean period of five swings, measured between passages through the lowest point.
double period_of(const ContactScene& scene) {
    std::vector<double> passages;
    Particle last = scene.particle;
    watch(scene, [&](double time, const Particle& particle) {
        if (time > 0.0 && last.position.x * particle.position.x < 0.0) {
            passages.push_back(time - scene.time_step + zero_between(last, particle, scene.time_step));
        }
        last = particle;
        return passages.size() < 11;
    });
    EXPECT_EQ(passages.size(), 11U);
    return passages.size() < 11 ? 0.0 : (passages[10] - passages[0]) / 5.0;
}

TEST(APointInABowl, SwingsWithThePeriodOfAPendulumToSecondOrder) {
    for (const double angle : {0.1, 0.3, 0.5, 1.0, 1.5}) {
        const double expected = 4.0 * std::sqrt(1.0 / kG) * complete_elliptic_integral(std::sin(0.5 * angle));
        const auto error = [&](double step) {
            return std::fabs(period_of(in_bowl(angle, 0.0, 0.0, step, 20.0)) / expected - 1.0);
        };
        const double coarse = error(0.01);
        EXPECT_LT(coarse, 1e-4) << angle;
        // At half the step, the error falls to a quarter. The factor 1.01 allows for the next order. The limit 1e-9 is
        // the accuracy of the passage times.
        EXPECT_LT(error(0.005), std::max(0.25 * 1.01 * coarse, 1e-9)) << angle;
    }
}

// The pendulum swings with a small amplitude. The amplitude lengthens the period by the factor 1 + 6e-6 here. An
// amplitude of a tenth of a radian would lengthen it by 1 + 6e-4.
TEST(ASphereInABowl, RollsLikeAPendulumOfSevenFifthsOfItsLength) {
    for (const double radius : {0.01, 0.1, 0.4}) {
        const double expected = 2.0 * kPiNumber * std::sqrt(7.0 * (1.0 - radius) / (5.0 * kG));
        const double period = period_of(in_bowl(0.01, radius, 0.5, 0.01, 20.0));
        EXPECT_NEAR(period / expected, 1.0, 1e-4) << radius;
    }
}

/// Returns the largest change of total energy over a run, relative to the energy that the swing converts between
/// potential and kinetic energy.
double worst_energy(const ContactScene& scene, double inertia) {
    const double first = kG * scene.particle.position.z;
    const double swing = first + kG * (1.0 - scene.particle.radius);
    double worst = 0.0;
    watch(scene, [&](double, const Particle& p) {
        const double spin = 0.5 * inertia * p.radius * p.radius * length_squared(p.spin);
        const double energy = 0.5 * length_squared(p.velocity) + spin + kG * p.position.z;
        worst = std::max(worst, std::fabs(energy - first));
        return true;
    });
    return worst / swing;
}

/// Returns the angle from the lowest point, in rad, of a sphere of radius r that rolls in the unit bowl. The classical
/// Runge-Kutta method integrates phi'' = -5 g sin(phi) / (7 (1 - r)) in small steps.
double rolled_angle(double angle, double radius, double time) {
    constexpr int kSteps = 20000;
    const double h = time / kSteps;
    const auto pull = [&](double phi) { return -5.0 * kG * std::sin(phi) / (7.0 * (1.0 - radius)); };
    double rate = 0.0;
    for (int k = 0; k < kSteps; ++k) {
        const double a1 = pull(angle);
        const double r2 = rate + 0.5 * h * a1;
        const double a2 = pull(angle + 0.5 * h * rate);
        const double r3 = rate + 0.5 * h * a2;
        const double a3 = pull(angle + 0.5 * h * r2);
        const double r4 = rate + h * a3;
        const double a4 = pull(angle + h * r3);
        angle += h / 6.0 * (rate + 2.0 * (r2 + r3) + r4);
        rate += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
    }
    return angle;
}

// The bowl curves away from the straight path of a step. For a small sphere, the end of this path is outside the bowl.
// That must not count as a reversal of the motion.
TEST(ASphereInABowl, RollsOnForAnyRadius) {
    const double start = kPiNumber / 6.0;
    for (const double radius : {0.1, 1e-3, 1e-5, 1e-6, 1e-9}) {
        for (const auto& [step, bound] : {std::pair{0.01, 1e-6}, std::pair{0.1, 2e-3}}) {
            ContactScene scene = in_bowl(start, radius, 0.9, step, 2.0);
            scene.integrator = {IntegratorKind::rk4};
            double x = 0.0;
            watch(scene, [&](double, const Particle& p) {
                x = p.position.x;
                return true;
            });
            EXPECT_NEAR(x / (1.0 - radius), std::sin(rolled_angle(start, radius, 2.0)), bound) << radius << " " << step;
        }
    }
}

// The bounds are required. In comparison, a rounding error of about 1e-16 g R per step is 2e-14 of the energy of a
// swing, which is 0.005 g R.
TEST(APointInABowl, ConservesTheEnergyOfAHundredSwingsInTheWholeProgram) {
    for (const auto& [angle, bound] : {std::pair{1.0, 1e-10}, std::pair{0.1, 5e-10}}) {
        EXPECT_LT(worst_energy(in_bowl(angle, 0.0, 0.0, 0.02, 220.0), 0.0), bound) << angle;
    }
}

TEST(ASphereInABowl, ConservesTheEnergyOfAHundredSwingsWhileItRolls) {
    for (const auto& [angle, bound] : {std::pair{1.0, 1e-10}, std::pair{0.1, 5e-10}}) {
        EXPECT_LT(worst_energy(in_bowl(angle, 0.1, 10.0, 0.02, 220.0), 0.4), bound) << angle;
    }
}

// The speed obeys v' = -mu v^2 / R without gravity, because only the curvature of the surface causes a normal force.
TEST(APointInABowl, IsSlowedByFrictionOfTheCentripetalForceWithEveryIntegrator) {
    for (const IntegratorKind kind :
         {IntegratorKind::ballistic, IntegratorKind::forward_euler, IntegratorKind::symplectic_euler,
          IntegratorKind::implicit_euler, IntegratorKind::midpoint, IntegratorKind::velocity_verlet,
          IntegratorKind::rk4, IntegratorKind::dormand_prince}) {
        ContactScene scene = in_bowl(0.0, 0.0, 0.2, 0.01, 1.0);
        scene.gravity = {};
        scene.particle.velocity = {3, 0, 0};
        scene.integrator = kind;
        EXPECT_NEAR(length(end_of(scene).velocity), 3.0 / (1.0 + 0.2 * 3.0), 1e-6) << name_of(kind);
    }
}

/// Returns the angle and its rate after one second. The point slides up a bowl, stops at 0.424 s and slides back.
std::array<double, 2> slid_up_and_back(double friction, double speed) {
    std::array<double, 2> state{0.0, speed};
    const double step = 1e-5;
    double sign = 1.0;
    const auto rate = [&](const std::array<double, 2>& y) {
        const double pressing = kG * std::cos(y[0]) + y[1] * y[1];
        return std::array<double, 2>{y[1], -kG * std::sin(y[0]) - sign * friction * pressing};
    };
    for (int k = 0; k < 100'000; ++k) {
        const std::array<double, 2> next = runge_kutta_step(state, step, rate);
        const bool turns = sign > 0.0 && next[1] < 0.0;
        const double until_turn = turns ? step * state[1] / (state[1] - next[1]) : step;
        state = runge_kutta_step(state, until_turn, rate);
        if (turns) sign = -1.0;
        if (turns) state = runge_kutta_step(state, step - until_turn, rate);
    }
    return state;
}

TEST(APointInABowl, SlidesBackToSecondOrderAfterItsSlipReverses) {
    const double expected = slid_up_and_back(0.2, 3.0)[0];
    for (const auto& [step, bound] : {std::pair{0.02, 1e-5}, std::pair{0.01, 2.5e-6}, std::pair{0.0025, 1.6e-7}}) {
        ContactScene scene = in_bowl(0.0, 0.0, 0.2, step, 1.0);
        scene.particle.velocity = {3, 0, 0};
        const Vec3 end = end_of(scene).position;
        EXPECT_NEAR(std::atan2(end.x, -end.z), expected, bound) << step;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
