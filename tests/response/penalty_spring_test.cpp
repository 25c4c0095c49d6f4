// Stiffness, damping and stability of the penalty response, and the force of one contact.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/penalty.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kPi = 3.14159265358979323846;

/// Depth and its rate in units of 1 / omega, for x'' = -x - 2 zeta x'.
struct Oscillator {
    double x = 0.0;
    double v = 1.0;

    [[nodiscard]] Oscillator after(double h, double zeta) const {
        const auto slope = [&](double at_x, double at_v) { return std::pair{at_v, -at_x - 2.0 * zeta * at_v}; };
        const auto [a1, b1] = slope(x, v);
        const auto [a2, b2] = slope(x + 0.5 * h * a1, v + 0.5 * h * b1);
        const auto [a3, b3] = slope(x + 0.5 * h * a2, v + 0.5 * h * b2);
        const auto [a4, b4] = slope(x + h * a3, v + h * b3);
        return {x + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4), v + h / 6.0 * (b1 + 2.0 * (b2 + b3) + b4)};
    }
    /// Returns the contact's force, in the same units.
    [[nodiscard]] double contact_force(double zeta) const { return x + 2.0 * zeta * v; }
};

/// Returns the restitution of a contact that ends before its force would pull. Uses Runge-Kutta steps and bisects the
/// last one.
double integrated_restitution(double zeta) {
    constexpr double kStep = 1e-3;
    Oscillator now;
    Oscillator next = now.after(kStep, zeta);
    while (next.contact_force(zeta) > 0.0) {
        now = next;
        next = now.after(kStep, zeta);
    }
    double low = 0.0;
    double high = kStep;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (now.after(middle, zeta).contact_force(zeta) > 0.0 ? low : high) = middle;
    }
    return -now.after(low, zeta).v;
}

TEST(PenaltySpring, RestitutionOfDampingMatchesAnIntegratedContact) {
    for (const double zeta : {0.0, 0.01, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0, 1.05, 1.5, 2.0, 4.0}) {
        EXPECT_NEAR(restitution_of_damping(zeta), integrated_restitution(zeta), 1e-10) << zeta;
    }
}

TEST(PenaltySpring, RestitutionHasTheKnownLimits) {
    EXPECT_EQ(restitution_of_damping(0.0), 1.0);
    EXPECT_DOUBLE_EQ(restitution_of_damping(1.0), std::exp(-2.0));
    for (const double offset : {1e-4, 1e-8, 1e-12, 1e-15}) {  // smooth through critical damping
        EXPECT_NEAR(restitution_of_damping(1.0 - offset), std::exp(-2.0), offset + 1e-15);
        EXPECT_NEAR(restitution_of_damping(1.0 + offset), std::exp(-2.0), offset + 1e-15);
    }
    EXPECT_EQ(damping_ratio(1.0), 0.0);
    EXPECT_NEAR(damping_ratio(std::exp(-2.0)), 1.0, 1e-12);
    EXPECT_EQ(damping_ratio(0.0), damping_ratio(kMinPenaltyRestitution));
    // e = 1 - pi zeta + O(zeta^2)
    EXPECT_NEAR((1.0 - restitution_of_damping(1e-6)) / 1e-6, kPi, 1e-5);
}

TEST(PenaltySpring, DampingRatioInvertsTheRestitution) {
    double last = std::numeric_limits<double>::infinity();
    for (int k = 10; k <= 1000; ++k) {
        const double restitution = 0.001 * k;
        const double zeta = damping_ratio(restitution);
        EXPECT_NEAR(restitution_of_damping(zeta), restitution, 1e-10);
        EXPECT_LT(zeta, last);
        last = zeta;
    }
}

TEST(PenaltySpring, ContactWithoutAStiffnessLastsTheGivenNumberOfSubsteps) {
    ResponseSettings settings;
    settings.time_step = 0.01;
    settings.penalty.substeps = 4;
    settings.penalty.contact_steps = 25.0;
    for (const double mass : {0.01, 1.0, 300.0}) {
        const double stiffness = contact_stiffness(settings, mass);
        EXPECT_NEAR(kPi * std::sqrt(mass / stiffness), 25.0 * 0.0025, 1e-15);
        const ContactSpring spring = contact_spring(settings, mass, 0.5);
        EXPECT_EQ(spring.stiffness, stiffness);
        EXPECT_NEAR(spring.damping / (2.0 * std::sqrt(stiffness * mass)), damping_ratio(0.5), 1e-14);
    }
    settings.penalty.stiffness = 123.0;
    EXPECT_EQ(contact_stiffness(settings, 7.0), 123.0);
}

/// Returns the largest excursion, relative to the first, of central differences with lagging damping: v += h (-x - 2
/// zeta v), x += h v.
double largest_excursion(double h, double zeta, int steps) {
    double x = 1.0;
    double v = 0.0;
    double largest = 1.0;
    for (int k = 0; k < steps && largest < 1e100; ++k) {
        v += h * (-x - 2.0 * zeta * v);
        x += h * v;
        largest = std::max(largest, std::fabs(x));
    }
    return largest;
}

TEST(PenaltySpring, LongestStableStepMatchesLaggingDamping) {
    for (const double zeta : {0.0, 0.05, 0.2, 0.5, 1.0, 3.0}) {
        const double stiffness = 400.0;
        const double mass = 0.25;  // omega = 40 / s
        const ContactSpring spring{stiffness, 2.0 * zeta * std::sqrt(stiffness * mass)};
        const double bound = 40.0 * longest_stable_step(spring, mass);
        EXPECT_NEAR(bound, 2.0 * (std::sqrt(1.0 + zeta * zeta) - zeta), 1e-14);
        EXPECT_LT(largest_excursion(bound / 1.02, zeta, 10000), 10.0) << zeta;
        EXPECT_GT(largest_excursion(bound * 1.02, zeta, 10000), 1e50) << zeta;
    }
}

PenaltyContact contact(double depth) { return {depth, {0, 0, 1}, 1000.0, 20.0, 0.3, 0.0}; }

TEST(PenaltyContact, SpringAndDamperPushAndNeverPull) {
    EXPECT_EQ(force_of(contact(0.01), {}, 0.0, {1e-3, 1e-9}).force, (Vec3{0, 0, 10}));
    EXPECT_EQ(force_of(contact(0.01), {{0, 0, -2}, {}}, 0.0, {1e-3, 1e-9}).force, (Vec3{0, 0, 50}));
    EXPECT_EQ(force_of(contact(0.01), {{0, 0, 0.25}, {}}, 0.0, {1e-3, 1e-9}).force, (Vec3{0, 0, 5}));
    EXPECT_EQ(force_of(contact(0.01), {{0, 0, 2}, {}}, 0.0, {1e-3, 1e-9}).force, Vec3{});
}

TEST(PenaltyContact, FrictionGrowsWithSlipUpToCoulombsLimit) {
    for (const double slip : {1e-5, 5e-4, 1e-3, 0.1, 10.0}) {
        const Vec3 force = force_of(contact(0.01), {{slip, 0, 0}, {}}, 0.0, {1e-3, 1e-9}).force;
        EXPECT_NEAR(force.x, -0.3 * 10.0 * std::min(1.0, slip / 1e-3), 1e-14);
        EXPECT_EQ(force.z, 10.0);
    }
}

TEST(PenaltyContact, SlippingSphereIsTurnedAndRollingSphereIsNot) {
    const double radius = 0.1;
    const ContactForce slips = force_of(contact(0.01), {{2, 0, 0}, {}}, radius, {1e-3, 1e-9});
    EXPECT_NEAR(slips.force.x, -3.0, 1e-14);
    EXPECT_NEAR(slips.torque.y, 3.0 * radius, 1e-14);  // rolls towards +x about +y
    const ContactForce rolls = force_of(contact(0.01), {{2, 0, 0}, {0, 20, 0}}, radius, {1e-3, 1e-9});
    EXPECT_NEAR(length(rolls.force - Vec3{0, 0, 10}), 0.0, 1e-12);
    EXPECT_NEAR(length(rolls.torque), 0.0, 1e-12);
}

TEST(PenaltyContact, RollingResistanceMatchesItsCoefficient) {
    PenaltyContact soft = contact(0.01);
    soft.rolling_friction = 0.05;
    const ContactForce rolls = force_of(soft, {{2, 0, 0}, {0, 20, 0}}, 0.1, {1e-3, 1e-9});
    EXPECT_NEAR(rolls.torque.y, -0.05 * 10.0 * 0.1, 1e-12);
}

TEST(PenaltyContact, BrakingStopsAtMostWithinTheStep) {
    PenaltyContact rough = contact(0.01);
    rough.friction = 10.0;
    rough.rolling_friction = 10.0;
    rough.damping = 1e6;
    rough.mass = 0.5;
    const double h = 0.01;
    // For a point, the slip ends exactly, and the damper removes the approach and no more.
    const Vec3 v{0.3, 0, -0.2};
    const ContactForce point = force_of(rough, {v, {}}, 0.0, {1e-3, h});
    EXPECT_NEAR(v.x + h * point.force.x / rough.mass, 0.0, 1e-15);
    EXPECT_NEAR(v.z + h * (point.force.z - rough.stiffness * 0.01) / rough.mass, 0.0, 1e-15);
    // For a sphere, friction changes velocity and spin so that its slip ends.
    const double radius = 0.1;
    rough.rolling_friction = 0.0;
    const ContactForce sphere = force_of(rough, {{0.3, 0, 0}, {}}, radius, {1e-3, h});
    const double velocity = 0.3 + h * sphere.force.x / rough.mass;
    const double spin = h * sphere.torque.y / (0.4 * rough.mass * radius * radius);
    EXPECT_NEAR(velocity - radius * spin, 0.0, 1e-15);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
