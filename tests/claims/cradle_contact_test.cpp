// A sphere that rolls between curved surfaces follows its equations of motion and gains no energy. The tests include
// rolling and spinning resistance and every kind of integrator.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "claims/contact_scene.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;

/// Sphere of radius 0.2 m at rest between two balls of radius 0.5 m, at an angle from the highest position between
/// them. The centres of the balls are on the x axis, 1.2 m apart. The sphere's centre moves on a circle of radius
/// `height` about the x axis. The distance of the contact points from the sphere's axis of rotation is `arm`.
struct Saddle {
    double away = 0.6;
    double distance = 0.7;
    double radius = 0.2;
    double height = std::sqrt(distance * distance - away * away);
    double arm = height * radius / distance;
};

ContactScene in_saddle(const Saddle& saddle, double angle, const Material& material, double time_step) {
    ContactScene scene;
    scene.colliders = {{"left", BallShape{0.5, {{-saddle.away, 0, 0}}}, 0},
                       {"right", BallShape{0.5, {{saddle.away, 0, 0}}}, 0}};
    scene.materials = {material};
    scene.colliders[1].material = 0;
    scene.particle = particle_of(saddle.height * Vec3{0, std::sin(angle), std::cos(angle)}, {}, saddle.radius);
    scene.time_step = time_step;
    scene.duration = 0.3;
    return scene;
}

/// Returns the angle 0.3 s after the start from rest. The rolling sphere obeys h (1 + 2/5 r^2 / arm^2) angle'' = g sin
/// angle.
double angle_of_reference(const Saddle& saddle, double angle) {
    const double ratio = saddle.radius / saddle.arm;
    const double factor = kG / (saddle.height * (1.0 + 0.4 * ratio * ratio));
    std::array<double, 2> state{angle, 0.0};
    for (int k = 0; k < 3000; ++k) {
        state = runge_kutta_step(state, 1e-4, [&](const std::array<double, 2>& y) {
            return std::array<double, 2>{y[1], factor * std::sin(y[0])};
        });
    }
    return state[0];
}

TEST(ASphereBetweenTwoBalls, RollsOffAsItsEquationPredicts) {
    const Saddle saddle;
    const double expected = angle_of_reference(saddle, 0.5);
    for (const double step : {0.05, 0.02, 0.01, 0.005}) {
        const Vec3 end = end_of(in_saddle(saddle, 0.5, {"", 0.0, 3.0}, step)).position;
        EXPECT_NEAR(std::atan2(end.y, end.z), expected, 1e-4) << step;
        EXPECT_NEAR(end.x, 0.0, 1e-9) << step;
    }
}

double energy_of(const Particle& p) {
    return 0.5 * length_squared(p.velocity) + 0.2 * p.radius * p.radius * length_squared(p.spin) + kG * p.position.z;
}

TEST(ASphereBetweenTwoBalls, GainsNoEnergyFromResistance) {
    const Saddle saddle;
    for (const auto& [rolling, spinning] : {std::pair{0.3, 0.0}, std::pair{0.0, 0.02}, std::pair{0.3, 0.02}}) {
        for (const double step : {0.05, 0.02, 0.005}) {
            for (const double angle : {0.05, 0.5, 0.8}) {
                Material material{"", 0.0, 2.0};
                material.rolling_friction = rolling;
                material.spinning_friction = spinning;
                double last = kG;  // larger than any energy in the run
                watch(in_saddle(saddle, angle, material, step), [&](double time, const Particle& p) {
                    if (time > 0.0) {
                        EXPECT_LE(energy_of(p), last + 1e-11)
                            << material.rolling_friction << ", " << material.spinning_friction << ", " << step;
                    }
                    last = energy_of(p);
                    return true;
                });
            }
        }
    }
}

// The normal turns while the sphere rolls. The resistance to spinning about the normal must act during the whole
// motion. The spin must not end and start again repeatedly.
TEST(ASphereThatRollsOverACylinder, IsBrakedBySpinningResistanceWithoutLossOfTime) {
    ContactScene scene;
    scene.colliders = {{"log", CylinderShape{0.26, 1.6, {{0.6, 0, -0.07}, {1.19, 0.75, 0.72}, 140.0}}, 0}};
    scene.materials = {{"", 0.0, 0.5}};
    scene.materials[0].spinning_friction = 0.02;
    scene.particle = particle_of({0.636, 0.069, 0.5}, {1.5, 0.3, -0.7}, 0.2, {-1.8, 8.4, -0.2});
    for (const double step : {0.05, 0.02, 0.005}) {
        scene.time_step = step;
        scene.duration = 0.3;
        Simulation simulation = simulation_of(scene);
        while (!simulation.finished()) simulation.step();
        expect_no_time_lost(simulation);
        EXPECT_LT(simulation.statistics().bounces_per_step_max, 100U) << step;
    }
}

// A rolling sphere obeys m v' = -rolling_friction m g 5/7. Its spin about the normal decreases at the rate
// spinning_friction g / (2/5 r^2).
TEST(ResistanceToTurning, BrakesWithAnyIntegrator) {
    for (const auto kind : {IntegratorKind::forward_euler, IntegratorKind::symplectic_euler,
                            IntegratorKind::implicit_euler, IntegratorKind::midpoint, IntegratorKind::velocity_verlet,
                            IntegratorKind::rk4, IntegratorKind::dormand_prince, IntegratorKind::ballistic}) {
        ContactScene scene;
        scene.colliders = {{"floor", PlaneShape{{}, {0, 0, 1}}, 0}};
        scene.materials = {{"", 0.0, 1.0}};
        scene.materials[0].rolling_friction = 0.02;
        scene.materials[0].spinning_friction = 0.003;
        scene.particle = particle_of({0, 0, 0.1 + 1e-12}, {1, 0, 0}, 0.1, {0, 10, 20});
        scene.integrator = kind;
        scene.time_step = 0.01;
        scene.duration = 1.0;
        const Particle end = end_of(scene);
        // The sphere falls 1e-12 m before contact, which takes 5e-7 s. With forward Euler the fall takes two steps,
        // because the path of the first step is straight.
        const double late = kind == IntegratorKind::forward_euler ? 1.01 * scene.time_step : 1e-6;
        const double braking = 5.0 / 7.0 * 0.02 * kG;
        const double slowing = 0.003 * kG / (0.4 * 0.01);
        EXPECT_NEAR(end.velocity.x, 1.0 - braking, late * braking) << name_of(kind);
        EXPECT_NEAR(end.spin.z, 20.0 - slowing, late * slowing) << name_of(kind);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
