// Tests of integrators in free flight: orders of convergence against closed forms, invariants of symplectic methods,
// and the tolerance of the adaptive method.
#include "ricochet/dynamics/integrator.h"
#include "ricochet/dynamics/flight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kPi = std::numbers::pi;

ForceField field_of(std::function<Vec3(const ForceInput&)> force) {
    std::vector<std::unique_ptr<Force>> list;
    list.push_back(make_force(std::move(force)));
    return ForceField(std::move(list));
}

/// Flies freely for `duration` in equal steps, which an adaptive method subdivides.
ForceInput fly(const Integrator& integrator, const ForceField& forces, ForceInput state, double duration, int steps) {
    const double h = duration / steps;
    for (int k = 0; k < steps; ++k) {
        const double end = h * (k + 1);
        Flight flight;
        for (bool first = true; first || end - state.time > 1e-12 * h; first = false) {
            flight = first ? begin_flight(integrator, forces, state, end - state.time)
                           : resume_flight(integrator, forces, state, flight, end - state.time);
            state.position = flight.path.end;
            state.velocity = flight.end_velocity;
            state.time += flight.path.duration;
        }
        state.time = end;
    }
    return state;
}

/// Motion with a known final state.
struct KnownMotion {
    std::string name;
    std::function<Vec3(const ForceInput&)> force;
    ForceInput start;
    double duration;
    Vec3 position;  // at the end
    Vec3 velocity;
};

/// Returns almost one period of a harmonic oscillator of mass 2 and angular frequency 3.
KnownMotion oscillator() {
    const double t = 1.7;
    const double w = 3.0;
    return {"oscillator",
            [](const ForceInput& p) { return -18.0 * p.position; },
            {{1, 0, 0}, {0, 1.5, 0}, 2.0, 0.0, 0.0},
            t,
            {std::cos(w * t), 0.5 * std::sin(w * t), 0},
            {-w * std::sin(w * t), 1.5 * std::cos(w * t), 0}};
}

/// Returns a part of an ellipse of eccentricity 0.4 about a centre of strength 1, from the pericentre to the eccentric
/// anomaly 2.5. A whole ellipse is unsuitable, because the errors of the two half kicks of symplectic Euler would
/// cancel.
KnownMotion kepler() {
    const double e = 0.4;
    const double anomaly = 2.5;
    const double b = std::sqrt(1.0 - e * e);
    const double rate = 1.0 / (1.0 - e * std::cos(anomaly));
    return {"kepler",
            [](const ForceInput& p) {
                const double r = length(p.position);
                return (-p.mass / (r * r * r)) * p.position;
            },
            {{1.0 - e, 0, 0}, {0, std::sqrt((1.0 + e) / (1.0 - e)), 0}, 1.0, 0.0, 0.0},
            anomaly - e * std::sin(anomaly),
            {std::cos(anomaly) - e, b * std::sin(anomaly), 0},
            {-rate * std::sin(anomaly), rate * b * std::cos(anomaly), 0}};
}

/// Returns a fall with linear drag, in which the speed approaches the terminal speed.
KnownMotion drag() {
    const double tau = 0.5;
    const double g = 9.81;
    const double t = 1.2;
    const double fade = std::exp(-t / tau);
    const Vec3 v0{3, 0, 1};
    const Vec3 terminal{0, 0, -g * tau};
    return {"drag",
            [](const ForceInput& p) {
                return p.mass * (Vec3{0, 0, -9.81} - p.velocity / 0.5);
            },
            {{}, v0, 0.7, 0.0, 0.0},
            t,
            t * terminal + (tau * (1.0 - fade)) * (v0 - terminal),
            terminal + fade * (v0 - terminal)};
}

/// Returns a particle dragged along by a rigid vortex, the flow w x r. x'' = (w x x - x') / tau is solved as z'' +
/// z'/tau = i w z/tau.
KnownMotion vortex() {
    const double tau = 0.3;
    const double w = 2.0;
    const double t = 1.5;
    using Complex = std::complex<double>;
    const Complex root = std::sqrt(Complex(1.0 / (tau * tau), 4.0 * w / tau));
    const Complex a = 0.5 * (-1.0 / tau + root);
    const Complex b = 0.5 * (-1.0 / tau - root);
    const Complex z0(1.0, 0.0);
    const Complex v0(0.0, 0.5);
    const Complex ca = (v0 - b * z0) / (a - b);
    const Complex cb = z0 - ca;
    const Complex z = ca * std::exp(a * t) + cb * std::exp(b * t);
    const Complex v = ca * a * std::exp(a * t) + cb * b * std::exp(b * t);
    return {"vortex",
            [](const ForceInput& p) {
                const Vec3 flow{-2.0 * p.position.y, 2.0 * p.position.x, 0};
                return p.mass * (flow - p.velocity) / 0.3;
            },
            {{1, 0, 0}, {0, 0.5, 0}, 1.0, 0.0, 0.0},
            t,
            {z.real(), z.imag(), 0},
            {v.real(), v.imag(), 0}};
}

double error_of(const Integrator& integrator, const KnownMotion& motion, int steps) {
    const ForceInput end = fly(integrator, field_of(motion.force), motion.start, motion.duration, steps);
    return length(end.position - motion.position) + length(end.velocity - motion.velocity);
}

/// Returns the slope of log(error) against log(step), over numbers of steps that grow by a constant factor.
double measured_order(IntegratorKind kind, const KnownMotion& motion, int from, int count) {
    double sx = 0.0;
    double sy = 0.0;
    double sxx = 0.0;
    double sxy = 0.0;
    double steps = from;
    for (int k = 0; k < count; ++k, steps *= 1.2) {
        const int n = static_cast<int>(std::lround(steps));
        const double x = std::log(motion.duration / n);
        const double y = std::log(error_of(kind, motion, n));
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

struct Order {
    IntegratorKind kind;
    double order;
    int from;  // in steps
};

class FreeFlight : public ::testing::TestWithParam<Order> {};
INSTANTIATE_TEST_SUITE_P(Methods, FreeFlight,
                         ::testing::Values(Order{IntegratorKind::forward_euler, 1.0, 4000},
                                           Order{IntegratorKind::symplectic_euler, 1.0, 4000},
                                           Order{IntegratorKind::implicit_euler, 1.0, 4000},
                                           Order{IntegratorKind::midpoint, 2.0, 800},
                                           Order{IntegratorKind::velocity_verlet, 2.0, 800},
                                           Order{IntegratorKind::rk4, 4.0, 150}),
                         [](const auto& of) { return std::string(name_of(of.param.kind)); });

TEST_P(FreeFlight, HasTheOrderOfItsMethod) {
    for (const KnownMotion& motion : {oscillator(), kepler(), drag(), vortex()}) {
        SCOPED_TRACE(motion.name);
        EXPECT_NEAR(measured_order(GetParam().kind, motion, GetParam().from, 12), GetParam().order, 0.1);
    }
}

TEST(DormandPrince, IsOfOrderFiveIfItDoesNotSubdivideTheStep) {
    const ErrorTolerance generous{1e6, 1e6};
    for (const KnownMotion& motion : {oscillator(), kepler(), drag(), vortex()}) {
        SCOPED_TRACE(motion.name);
        const int n = motion.name == "kepler" ? 40 : 16;
        const double coarse = error_of({IntegratorKind::dormand_prince, generous}, motion, n);
        const double fine = error_of({IntegratorKind::dormand_prince, generous}, motion, 4 * n);
        EXPECT_NEAR(std::log2(coarse / fine) / 2.0, 5.0, 0.5);
    }
}

// The tolerance applies to one substep. Over a run the errors add up, and on orbits they grow with time.
TEST(DormandPrince, MeetsItsToleranceInOneHugeStep) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
        for (const KnownMotion& motion : {oscillator(), kepler(), drag(), vortex()}) {
            SCOPED_TRACE(motion.name);
            EXPECT_LT(error_of({IntegratorKind::dormand_prince, {tolerance, tolerance}}, motion, 1), 200.0 * tolerance);
        }
    }
}

TEST(DormandPrince, TakesMoreSubstepsForASmallerTolerance) {
    const KnownMotion motion = kepler();
    std::vector<int> counts;
    for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
        int evaluations = 0;
        const ForceField forces = field_of([&](const ForceInput& p) {
            ++evaluations;
            return motion.force(p);
        });
        (void)fly({IntegratorKind::dormand_prince, {tolerance, tolerance}}, forces, motion.start, motion.duration, 1);
        counts.push_back(evaluations);
    }
    EXPECT_LT(2 * counts[0], counts[1]);
    EXPECT_LT(2 * counts[1], counts[2]);
}

// The sweep uses the path between the ends of a substep.
TEST(DormandPrince, ThePathStaysWithinTheToleranceOfTheTrajectory) {
    const double tolerance = 1e-6;
    const KnownMotion motion = kepler();
    const ForceField forces = field_of(motion.force);
    const Integrator integrator{IntegratorKind::dormand_prince, {tolerance, tolerance}};
    ForceInput state = motion.start;
    Flight flight = begin_flight(integrator, forces, state, motion.duration);
    for (int k = 0; k < 50 && state.time < motion.duration; ++k) {
        for (const double part : {0.25, 0.5, 0.75}) {
            const double s = part * flight.path.duration;
            const ForceInput there =
                fly(IntegratorKind::rk4, forces, {state.position, state.velocity, 1, 0, 0}, s, 200);
            EXPECT_LT(length(flight.path.position(s) - there.position), 4.0 * tolerance);
        }
        state.position = flight.path.end;
        state.velocity = flight.end_velocity;
        state.time += flight.path.duration;
        flight = resume_flight(integrator, forces, state, flight, motion.duration - state.time);
    }
}

TEST(UniformForce, EveryMethodOfOrderTwoFollowsTheExactParabola) {
    std::vector<std::unique_ptr<Force>> list;
    list.push_back(make_gravity({0, 0, -9.81}));
    const ForceField forces(std::move(list));
    const ForceInput start{{1, 2, 3}, {4, -5, 6}, 1.0, 0.0, 0.0};
    const Flight exact = begin_flight(IntegratorKind::ballistic, forces, start, 0.7);
    for (const auto kind : {IntegratorKind::midpoint, IntegratorKind::velocity_verlet, IntegratorKind::rk4,
                            IntegratorKind::dormand_prince}) {
        const Flight flight = begin_flight(kind, forces, start, 0.7);
        EXPECT_EQ(flight.path.end, exact.path.end) << name_of(kind);
        EXPECT_EQ(velocity_at(kind, forces, flight, 0.3), velocity_at(IntegratorKind::ballistic, forces, exact, 0.3));
    }
}

TEST(VelocityOnTheWay, EqualsTheVelocityAfterAShorterStep) {
    const KnownMotion motion = vortex();
    const ForceField forces = field_of(motion.force);
    for (const auto kind : {IntegratorKind::forward_euler, IntegratorKind::midpoint, IntegratorKind::velocity_verlet,
                            IntegratorKind::rk4}) {
        const Flight flight = begin_flight(kind, forces, motion.start, 0.2);
        const Flight shorter = begin_flight(kind, forces, motion.start, 0.05);
        EXPECT_LT(length(velocity_at(kind, forces, flight, 0.05) - shorter.end_velocity), 1e-15) << name_of(kind);
        EXPECT_LT(length(state_at(kind, forces, flight, 0.05).position - shorter.path.end), 1e-15) << name_of(kind);
    }
}

/// Largest relative deviation of an oscillator's energy over many periods, and its mean over the last of them.
struct Drift {
    double largest = 0.0;
    double late_mean = 0.0;
};

Drift drift_of(IntegratorKind kind, int periods, int steps_per_period) {
    const ForceField forces = field_of([](const ForceInput& p) { return -p.position; });
    ForceInput state{{1, 0, 0}, {}, 1.0, 0.0, 0.0};
    const double h = 2.0 * kPi / steps_per_period;
    Drift drift;
    int late = 0;
    for (int k = 0; k < periods; ++k) {
        for (int i = 0; i < steps_per_period; ++i) {
            const Flight flight = begin_flight(kind, forces, state, h);
            state.position = flight.path.end;
            state.velocity = flight.end_velocity;
            const double energy = length_squared(state.position) + length_squared(state.velocity);
            drift.largest = std::max(drift.largest, std::fabs(energy - 1.0));
            if (k < periods - periods / 10) continue;
            drift.late_mean += energy - 1.0;
            ++late;
        }
    }
    drift.late_mean /= late;
    return drift;
}

// The energy error stays below h / 2 for symplectic Euler and below h^2 / 4 for Verlet. The energy of forward Euler
// grows by h^2 per step.
TEST(SymplecticMethods, KeepTheEnergyBoundedOverAHundredThousandPeriods) {
    const double h = 2.0 * kPi / 40;
    const Drift euler = drift_of(IntegratorKind::symplectic_euler, 100000, 40);
    EXPECT_LT(euler.largest, 0.6 * h);
    const Drift verlet = drift_of(IntegratorKind::velocity_verlet, 100000, 40);
    EXPECT_LT(verlet.largest, 0.3 * h * h);
    EXPECT_LT(std::fabs(verlet.late_mean), 0.2 * h * h);
    EXPECT_GT(drift_of(IntegratorKind::forward_euler, 20, 40).largest, 1.0);
}

TEST(IntegratorNames, AreInTheOrderOfTheEnumeration) {
    const std::vector<std::string_view> names = integrator_names();
    for (std::size_t k = 0; k < names.size(); ++k) EXPECT_EQ(name_of(static_cast<IntegratorKind>(k)), names[k]);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
