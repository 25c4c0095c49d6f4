#include "ricochet/dynamics/driven_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "ricochet/core/checks.h"
#include "ricochet/core/error.h"
#include "ricochet/dynamics/settings_table.h"

namespace ricochet {
namespace {

/// A mathematical constant.
constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Returns true if every principal minor of order k is at least `least` times the k-th power of the trace (Sylvester).
bool is_definite(const SymmetricMatrix& a, double least) {
    const double size = a.trace();
    const auto is_good = [&](double minor, int power) { return minor >= least * std::pow(size, power); };
    return is_good(a.xx, 1) && is_good(a.yy, 1) && is_good(a.zz, 1) && is_good(a.xx * a.yy - a.xy * a.xy, 2) &&
           is_good(a.xx * a.zz - a.xz * a.xz, 2) && is_good(a.yy * a.zz - a.yz * a.yz, 2) &&
           is_good(a.determinant(), 3);
}

/// Returns true if the tensor can be the inertia of a distribution of mass. Its moments must be above 0. Half the trace
/// minus the tensor is the sum of m x x^T, so it must have no negative eigenvalue. A flat body has a zero eigenvalue.
bool is_inertia(const SymmetricMatrix& a) {
    // Local: tolerance for the rounding of input values.
    constexpr double kRounding = 1e-12;
    const SymmetricMatrix spread = diagonal_matrix(0.5 * a.trace()) + (-1.0) * a;
    return std::isfinite(a.determinant()) && std::isnormal(a.determinant()) && is_definite(a, 0.0) &&
           a.determinant() > 0.0 && is_definite(spread, -kRounding);
}

/// Coordinate of a joint, relative to the rest position of its spring, and its rate.
struct JointState {
    double coordinate;
    double rate;
};

/// Returns the displacement and rate of x'' = n - stiffness x - damping x' after h seconds, minus those of motion at
/// the constant start rate. stiffness in 1/s^2, damping in 1/s. n changes linearly from n[0] to n[1]. The solution is a
/// power series in time. The step is split into intervals that are short enough for fast convergence.
JointState oscillated(const JointState& start, double stiffness, double damping, const std::array<double, 2>& n,
                      double h) {
    // Local: after this number of terms, the rest of the series is below rounding. The limit of 10 000 intervals bounds
    // the cost.
    constexpr int kMostTerms = 40;
    const int parts = 1 + static_cast<int>(std::min(1e4, h * (std::sqrt(stiffness) + damping)));
    const double s = h / parts;
    const double slope = h > 0.0 ? (n[1] - n[0]) / h : 0.0;
    JointState gained{0.0, 0.0};
    for (int part = 0; part < parts; ++part) {
        double forcing = n[0] + part * s * slope;
        // x and v are consecutive terms of the coordinate's series: derivatives times s^k / k!.
        double x = start.coordinate + part * s * start.rate + gained.coordinate;
        double v = s * (start.rate + gained.rate);
        gained.coordinate += s * gained.rate;
        for (int k = 2; k <= kMostTerms && (x != 0.0 || v != 0.0 || forcing != 0.0); ++k) {
            const double a = (s * s / (k * (k - 1.0))) * (forcing - stiffness * x) - (s / k) * damping * v;
            forcing = k == 2 ? s * slope : 0.0;
            x = std::exchange(v, a);
            gained.coordinate += a;
            gained.rate += k * a / s;
        }
    }
    return gained;
}

// Returns true if spring and damper can be integrated in closed form. Dry friction and a motor exclude the closed form,
// because the plan must reach the rate that they enforce exactly.
bool is_oscillator(const JointSettings& joint) {
    const bool is_steady = joint.friction == 0.0 && joint.motor_most == 0.0;
    return is_steady && (joint.spring > 0.0 || joint.damping > 0.0);
}

/// Returns the coefficients of t, t^2 and t^3 of a cubic path. The path ends in the state that spring and damper reach
/// after h seconds. now: state at the start. predicted: estimated state at the end. accelerations: accelerations by all
/// forces in these two states.
std::array<double, 3> oscillation(const JointSettings& joint, double inertia, const JointState& now,
                                  const JointState& predicted, const std::array<double, 2>& accelerations, double h) {
    const double stiffness = joint.spring / inertia;
    const double damping = joint.damping / inertia;
    const auto without = [&](const JointState& state, double acceleration) {
        return acceleration + stiffness * (state.coordinate - joint.spring_rest) + damping * state.rate;
    };
    const std::array<double, 2> others{without(now, accelerations[0]), without(predicted, accelerations[1])};
    const JointState gained = oscillated({now.coordinate - joint.spring_rest, now.rate}, stiffness, damping, others, h);
    const double by_rate = h * gained.rate;
    return {now.rate, (3.0 * gained.coordinate - by_rate) / (h * h), (by_rate - 2.0 * gained.coordinate) / (h * h * h)};
}

void check(const BodyDescription& body) {
    const auto of_body = [&](const char* what) { return fmt::format("body '{}': {}", body.frame, what); };
    detail::require_positive(body.mass, of_body("the mass"), "kg");
    detail::require_finite(body.center, of_body("the centre of mass"), "m");
    require_settings(body, kBodyMotionTable, of_body(""));
    require_settings(body.settings, kJointTable, of_body(""));
    if (!is_inertia(body.inertia)) {
        throw InputError(
            of_body("the inertia is impossible for a body with a volume (moments above 0, none above the sum of "
                    "the others, consistent products)"));
    }
}

}  // namespace

DrivenBody::DrivenBody(BodyDescription description, const AffineMap& world_from_frame)
    : description_(std::move(description)), start_(world_from_frame), map_(world_from_frame) {
    check(description_);
    const BodyDescription& body = description_;
    inverse_inertia_ = body.inertia.inverse();
    center_ = map_.point(body.center);
    pivot_ = map_.translation;
    if (body.joint == JointKind::free) {
        velocity_ = body.velocity;
        angular_momentum_ = congruent(map_, body.inertia) * body.angular_velocity;
        return;
    }
    description_.axis = detail::unit_direction(body.axis, fmt::format("body '{}': the axis", body.frame));
    axis_ = map_.direction(description_.axis);
    rate_ = body.rate;
    inertia_ = body.mass;
    if (body.joint == JointKind::hinge) {
        const Vec3 arm = cross(axis_, center_ - pivot_);
        inertia_ = dot(description_.axis, body.inertia * description_.axis) + body.mass * dot(arm, arm);
    }
}

BodyPath DrivenBody::plan(const ForceField& forces, const Wrench& load, double begin, double end) const {
    return description_.joint == JointKind::free ? plan_free(forces, load, begin, end)
                                                 : plan_joint(forces, load, begin, end);
}

BodyPath DrivenBody::plan_free(const ForceField& forces, const Wrench& load, double begin, double end) const {
    const double h = end - begin;
    const Vec3 by_load = load.impulse / description_.mass;
    const Vec3 first = acceleration_at(forces, center_, velocity_, begin) + by_load;
    const Vec3 reached = center_ + h * (velocity_ + (0.5 * h) * first);
    const Vec3 last = acceleration_at(forces, reached, velocity_ + h * first, end) + by_load;
    BodyPath path{begin, end, map_, description_.center};
    path.center_path = {velocity_, 0.5 * first, h > 0.0 ? (last - first) / (6.0 * h) : Vec3{}};
    const Vec3 now = inverse_inertia(map_) * angular_momentum_;
    // The angular velocity in the middle of the step is computed after a rotation for half the step at the start's
    // angular velocity.
    const auto turned = [&](const Vec3& spin, double duration) {
        BodyPath turning{0.0, duration, map_, {}};
        if (spin == Vec3{}) return turning;
        turning.axis = normalized(map_.direction_back(spin));
        turning.turns[0] = length(spin) * kDegrees;
        return turning;
    };
    const AffineMap middle = turned(now, 0.5 * h).at(0.5 * h).world_from_frame;
    const Vec3 spin = inverse_inertia(middle) * (angular_momentum_ + (0.5 * h) * load.moment);
    const BodyPath turning = turned(spin, h);
    path.axis = turning.axis;
    path.turns = turning.turns;
    return path;
}

BodyPath DrivenBody::plan_joint(const ForceField& forces, const Wrench& load, double begin, double end) const {
    const double h = end - begin;
    const double by_load = along_joint(load) / inertia_;
    const double first = joint_acceleration(forces, coordinate_, rate_, begin) + by_load;
    // The prediction includes friction and motor, so that the damping is computed from the resulting rate.
    const auto held_at = [&](double rate) { return h > 0.0 ? constrained_change(rate, h) / h : 0.0; };
    const double predicted = first + held_at(rate_ + h * first);
    const double reached = coordinate_ + h * (rate_ + 0.5 * h * predicted);
    const double last = joint_acceleration(forces, reached, rate_ + h * predicted, end) + by_load;
    const double held = held_at(rate_ + 0.5 * h * (first + last));
    std::array<double, 3> center_path{rate_, 0.5 * (first + held), h > 0.0 ? (last - first) / (6.0 * h) : 0.0};
    if (is_oscillator(description_.settings) && h > 0.0) {
        center_path = oscillation(description_.settings, inertia_, {coordinate_, rate_},
                                  {reached, rate_ + h * predicted}, {first, last}, h);
    }
    BodyPath path{begin, end, map_, {}};
    path.axis = description_.axis;
    if (description_.joint == JointKind::slider) {
        for (std::size_t k = 0; k < center_path.size(); ++k) path.center_path[k] = center_path[k] * axis_;
        return path;
    }
    path.at_begin = start_;
    path.degrees = degrees_;
    for (std::size_t k = 0; k < center_path.size(); ++k) path.turns[k] = kDegrees * center_path[k];
    return path;
}

/// Returns the component of a wrench along the joint.
double DrivenBody::along_joint(const Wrench& wrench) const {
    return dot(axis_, description_.joint == JointKind::hinge ? wrench.moment : wrench.impulse);
}

/// Returns the acceleration of the joint's coordinate, in rad/s^2 or m/s^2, without friction and motor.
double DrivenBody::joint_acceleration(const ForceField& forces, double coordinate, double rate, double time) const {
    const JointSettings& joint = description_.settings;
    const bool turns = description_.joint == JointKind::hinge;
    const Vec3 center = center_at(coordinate);
    const Vec3 velocity = turns ? rate * cross(axis_, center - pivot_) : rate * axis_;
    const Vec3 force = description_.mass * acceleration_at(forces, center, velocity, time);
    const double of_forces = turns ? dot(axis_, cross(center - pivot_, force)) : dot(axis_, force);
    const double of_joint = joint.drive - joint.spring * (coordinate - joint.spring_rest) - joint.damping * rate;
    return (of_forces + of_joint) / inertia_;
}

/// Returns the change of the joint's rate by motor and dry friction. The motor accelerates the joint towards the target
/// rate, against friction. Friction slows the resulting motion, or stops it.
double DrivenBody::constrained_change(double rate, double duration) const {
    const JointSettings& joint = description_.settings;
    const double motor = joint.motor_most * duration / inertia_;
    const double friction = joint.friction * duration / inertia_;
    const auto driven = [&](double slowed) { return slowed + std::clamp(joint.motor_rate - slowed, -motor, motor); };
    const double forwards = driven(rate - friction);
    if (forwards > 0.0) return forwards - rate;
    const double backwards = driven(rate + friction);
    return backwards < 0.0 ? backwards - rate : -rate;
}

Vec3 DrivenBody::acceleration_at(const ForceField& forces, const Vec3& center, const Vec3& velocity,
                                 double time) const {
    if (!description_.feels_forces) return {};
    const Vec3 a = forces.acceleration({center, velocity, description_.mass, 0.0, time});
    if (!is_finite(a)) {
        throw DivergedError(
            fmt::format("at t = {:.6g} s the forces on the body '{}' are not finite", time, description_.frame));
    }
    return a;
}

Vec3 DrivenBody::center_at(double coordinate) const {
    if (coordinate == coordinate_) return center_;
    if (description_.joint == JointKind::slider) return center_ + (coordinate - coordinate_) * axis_;
    BodyPath turned{0.0, 0.0, start_, {}};
    turned.axis = description_.axis;
    turned.degrees = kDegrees * coordinate;
    return turned.at(0.0).point(description_.center);
}

SymmetricMatrix DrivenBody::inverse_inertia(const AffineMap& map) const { return congruent(map, inverse_inertia_); }

void DrivenBody::follow(const BodyPath& path, const Wrench& load, const Wrench& wrench) {
    const double h = path.end - path.begin;
    const auto moved = [h](const auto& c) { return h * (c[0] + h * (c[1] + h * c[2])); };
    const auto rate = [h](const auto& c) { return c[0] + h * (2.0 * c[1] + (3.0 * h) * c[2]); };
    // Impulses that the path does not include.
    const Wrench rest{wrench.impulse - h * load.impulse, wrench.moment - h * load.moment};
    const Vec3 before = center_;
    map_ = path.at(path.end).world_from_frame;
    center_ = map_.point(description_.center);
    if (description_.joint == JointKind::free) {
        velocity_ = rate(path.center_path);
        // Moments are about the start position of the centre. The load acted during the whole step. The other impulses
        // act at the end of the step.
        const Vec3 mean =
            h * (path.center_path[0] / 2.0 + h * (path.center_path[1] / 3.0 + (0.25 * h) * path.center_path[2]));
        angular_momentum_ += h * load.moment - cross(mean, h * load.impulse);
        take({rest.impulse, rest.moment - cross(center_ - before, rest.impulse)});
        return;
    }
    if (description_.joint == JointKind::slider) {
        coordinate_ += dot(axis_, moved(path.center_path));
        rate_ = dot(axis_, rate(path.center_path));
    } else {
        degrees_ = path.degrees + moved(path.turns);
        coordinate_ = degrees_ / kDegrees;
        rate_ = rate(path.turns) / kDegrees;
    }
    take(rest);
}

void DrivenBody::take(const Wrench& wrench) {
    if (description_.joint == JointKind::free) {
        velocity_ += wrench.impulse / description_.mass;
        angular_momentum_ += wrench.moment;
    } else {
        rate_ += along_joint(wrench) / inertia_;
    }
}

Mobility DrivenBody::mobility() const {
    if (description_.joint == JointKind::free) {
        return {diagonal_matrix(1.0 / description_.mass), inverse_inertia_, description_.center};
    }
    const SymmetricMatrix along = (1.0 / inertia_) * outer_product(description_.axis);
    return description_.joint == JointKind::hinge ? Mobility{{}, along, {}} : Mobility{along, {}, {}};
}

double DrivenBody::quadratic_energy(const Wrench& wrench) const {
    return std::max(0.0, mobility().seen_by(map_).energy_by(wrench));  // rounding can make the energy negative
}

Vec3 DrivenBody::velocity_change(const Wrench& wrench, const Vec3& where) const {
    return mobility().seen_by(map_).change_at(where, wrench);
}

Vec3 DrivenBody::velocity() const {
    if (description_.joint == JointKind::free) return velocity_;
    return description_.joint == JointKind::slider ? rate_ * axis_ : rate_ * cross(axis_, center_ - pivot_);
}

Vec3 DrivenBody::angular_velocity() const {
    if (description_.joint == JointKind::slider) return {};
    return description_.joint == JointKind::hinge ? rate_ * axis_ : inverse_inertia(map_) * angular_momentum_;
}

Vec3 DrivenBody::angular_momentum() const {
    if (description_.joint == JointKind::free) return angular_momentum_;
    return congruent(map_, description_.inertia) * angular_velocity();
}

double DrivenBody::kinetic_energy() const {
    if (description_.joint != JointKind::free) return 0.5 * inertia_ * rate_ * rate_;
    return 0.5 * (description_.mass * dot(velocity_, velocity_) + dot(angular_momentum_, angular_velocity()));
}

}  // namespace ricochet
