/// \file
/// One contact constraint ("row"), solved while all others keep their impulses. The templates also process four rows at
/// once (constraint_quads.h), with bit-identical results.
///
/// Lever arms are parallel to normals. A contact's normal impulse therefore changes only its approach speed, and its
/// friction only its slip. Both impulses have closed forms. Spins are stored as surface speeds: radius times spin.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ricochet/core/quad.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/contact_solver/contact_network.h"

namespace ricochet {

/// Current motion of a body or a wall.
struct alignas(64) SolverState {
    Vec3 velocity;
    Vec3 turning;                ///< radius times spin, in m/s
    double inverse_mass = 0;     ///< 1 / mass, in 1/kg
    double inverse_inertia = 0;  ///< radius^2 / moment of inertia, in 1/kg
};

/// Impulse of a contact without its moment, or a change of that impulse, in N s.
struct ConstraintImpulse {
    double normal = 0.0;
    Vec3 tangential;

    friend bool operator==(const ConstraintImpulse&, const ConstraintImpulse&) = default;
};

/// Data of a contact that every sweep needs. They fill two cache lines, and a sweep writes only the second one. Masses
/// are read from the states of the two bodies, which a sweep loads anyway.
struct alignas(64) ContactConstraint {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    Vec3 normal;
    double bound = 0.0;  ///< largest allowed approach speed, in m/s; -s requires a separation speed of at least s
    double friction = 0.0;
    double strictness = 1.0;    ///< square of SolverContact::exactness
    std::uint32_t rolling = 0;  ///< index of its RollingConstraint, or kNone
    ConstraintImpulse impulse;
    ConstraintImpulse direction;  ///< change of `impulse` in the last sweep, including its momentum step

    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
};

/// Rolling resistance of a contact.
struct RollingConstraint {
    std::uint32_t row = 0;
    double friction = 0.0;      ///< moment over normal force, in m
    double per_radius_a = 0.0;  ///< 1 / radius, in 1/m
    double per_radius_b = 0.0;
    Vec3 wall_turning;     ///< angular velocity of the wall, in rad/s
    double inertia = 0.0;  ///< angular impulse per change of the rolling velocity, in kg m^2
    Vec3 moment;           ///< angular impulse, in N m s
    Vec3 direction;        ///< change of `moment` in the last sweep, including its momentum step
};

/// Change of one row, or of each of four rows, in a sweep. See SweepChange.
template <class Number>
struct RowChange {
    Number normal_work{};       ///< change of the normal impulse times the velocity change that it causes, in J
    Number tangential_work{};   ///< the same for friction, in J
    Number approach_squared{};  ///< squared change of the approach speed times `strictness`, in m^2/s^2
    Number slip_squared{};
};

/// Change of the network in a sweep.
struct SweepChange {
    double squared = 0.0;           ///< sum of changes of impulses times the resulting changes of velocity, in J
    double approach_squared = 0.0;  ///< largest squared change of an approach speed, times `strictness`, in m^2/s^2
    double slip_squared = 0.0;      ///< largest squared change of a slip, likewise

    void add(const SweepChange& other) {
        squared += other.squared;
        approach_squared = std::max(approach_squared, other.approach_squared);
        slip_squared = std::max(slip_squared, other.slip_squared);
    }
    void add(const RowChange<double>& row) {
        squared += row.normal_work;
        squared += row.tangential_work;
        approach_squared = std::max(approach_squared, row.approach_squared);
        slip_squared = std::max(slip_squared, row.slip_squared);
    }
    [[nodiscard]] double worst() const { return std::sqrt(std::max(approach_squared, slip_squared)); }
    /// Returns true if all changes are within a tolerance, in m/s. slip: replaces a smaller one for slip and rolling.
    [[nodiscard]] bool is_within(double tolerance, double slip) const {
        return std::sqrt(approach_squared) <= tolerance && std::sqrt(slip_squared) <= std::max(tolerance, slip);
    }
};

/// Returns the speed, in m/s, at which a and b separate along the normal; negative if they approach.
template <class Row, class State>
[[nodiscard]] RICOCHET_INLINE auto separation_speed_of(const Row& row, const State& a, const State& b) {
    return dot(row.normal, a.velocity - b.velocity);
}

/// Returns the slip velocity of a relative to b, in m/s.
template <class Row, class State>
[[nodiscard]] RICOCHET_INLINE auto slip_of(const Row& row, const State& a, const State& b) {
    const auto between = a.velocity - b.velocity;
    return between - dot(row.normal, between) * row.normal - cross(a.turning + b.turning, row.normal);
}

/// Returns the spin of a relative to b, perpendicular to the normal, in rad/s.
[[nodiscard]] inline Vec3 rolling_of(const ContactConstraint& row, const RollingConstraint& rolling,
                                     const SolverState& a, const SolverState& b) {
    const Vec3 between = rolling.per_radius_a * a.turning - rolling.per_radius_b * b.turning - rolling.wall_turning;
    return between - dot(row.normal, between) * row.normal;
}

/// Applies an impulse to a body. A fixed body is not written to, because several threads can use it.
RICOCHET_INLINE void apply(const Vec3& impulse, const Vec3& turn, SolverState& body) {
    if (body.inverse_mass == 0.0) return;
    body.velocity += body.inverse_mass * impulse;
    body.turning += body.inverse_inertia * turn;
}

template <class Row, class Impulse, class State>
RICOCHET_INLINE void apply(const Row& row, const Impulse& impulse, State& a, State& b) {
    const auto whole = impulse.normal * row.normal + impulse.tangential;
    const auto turn = -cross(row.normal, impulse.tangential);
    apply(whole, turn, a);
    apply(-whole, turn, b);
}

inline void apply_moment(const RollingConstraint& rolling, const Vec3& moment, SolverState& a, SolverState& b) {
    if (a.inverse_mass != 0.0) a.turning += (a.inverse_inertia * rolling.per_radius_a) * moment;
    if (b.inverse_mass != 0.0) b.turning -= (b.inverse_inertia * rolling.per_radius_b) * moment;
}

/// Returns the factor, at most 1, that limits the length of a vector to `most`.
[[nodiscard]] inline double length_kept(const Vec3& v, double most) {
    const double squared = length_squared(v);
    return squared > most * most ? most / std::sqrt(squared) : 1.0;
}

/// Returns v with its length limited to `most`.
[[nodiscard]] inline Vec3 shortened(const Vec3& v, double most) { return length_kept(v, most) * v; }

/// Returns the inverse effective mass of the approach of two bodies, in 1/kg.
template <class State>
[[nodiscard]] RICOCHET_INLINE auto inverse_mass_of(const State& a, const State& b) {
    return a.inverse_mass + b.inverse_mass;
}

/// Returns the inverse effective mass of the slip of two bodies, in 1/kg.
template <class State>
[[nodiscard]] RICOCHET_INLINE auto slip_inverse_mass_of(const State& a, const State& b) {
    return inverse_mass_of(a, b) + a.inverse_inertia + b.inverse_inertia;
}

/// Adds the momentum step, `factor` times the last change, to a row's impulse, and then solves the row for the current
/// velocities. The velocities of its bodies already include the momentum step.
template <class Row, class State>
RICOCHET_INLINE auto relax(Row& row, double factor, State& a, State& b) {
    RowChange<decltype(row.bound)> change;
    const auto violation = separation_speed_of(row, a, b) + row.bound;
    const decltype(row.impulse) step{factor * row.direction.normal, factor * row.direction.tangential};
    const auto inverse_mass = inverse_mass_of(a, b);
    const auto start = row.impulse.normal + step.normal;
    decltype(row.impulse) by{};
    by.normal = larger(-start, -kNetworkOverRelaxation * (1.0 / inverse_mass) * violation);
    row.impulse.normal = start + by.normal;
    row.impulse.tangential += step.tangential;
    const auto velocity = by.normal * inverse_mass;
    change.normal_work = by.normal * velocity;
    change.approach_squared = row.strictness * (velocity * velocity);
    if (const auto rubs = row.friction > 0.0; any(rubs)) {
        const auto slip_inverse_mass = slip_inverse_mass_of(a, b);
        const auto wish = row.impulse.tangential - (1.0 / slip_inverse_mass) * slip_of(row, a, b);
        const auto cut =
            select(rubs, length_kept(wish, row.friction * row.impulse.normal) * wish, row.impulse.tangential);
        by.tangential = select(rubs, cut - row.impulse.tangential, by.tangential);
        row.impulse.tangential = cut;
        change.tangential_work = length_squared(by.tangential) * slip_inverse_mass;
        change.slip_squared = row.strictness * (change.tangential_work * slip_inverse_mass);
    }
    row.direction = {step.normal + by.normal, step.tangential + by.tangential};
    apply(row, by, a, b);
    return change;
}

/// Relaxes the rolling resistance of a row. Its velocity change is measured at the surface of the smaller sphere.
inline void relax(const ContactConstraint& row, RollingConstraint& rolling, double factor, SolverState& a,
                  SolverState& b, SweepChange& change) {
    const Vec3 step = factor * rolling.direction;
    const Vec3 start = rolling.moment + step;
    const Vec3 wish = start - rolling.inertia * rolling_of(row, rolling, a, b);
    rolling.moment = shortened(wish, rolling.friction * row.impulse.normal);
    const Vec3 by = rolling.moment - start;
    rolling.direction = step + by;
    apply_moment(rolling, by, a, b);
    const double squared = length_squared(by) / rolling.inertia;
    change.squared += squared;
    const double per_radius = std::max(rolling.per_radius_a, rolling.per_radius_b);
    const double speed_squared = squared / (rolling.inertia * per_radius * per_radius);
    change.slip_squared = std::max(change.slip_squared, row.strictness * speed_squared);
}

/// Returns true if a row has no impulse, has not changed in the last sweep, and is not violated.
template <class Row, class State>
[[nodiscard]] RICOCHET_INLINE auto is_idle(const Row& row, const State& a, const State& b) {
    const auto& direction = row.direction.tangential;
    const auto has_rested = (row.impulse.normal == 0.0) & (row.direction.normal == 0.0) & (direction.x == 0.0) &
                            (direction.y == 0.0) & (direction.z == 0.0);
    return has_rested & (separation_speed_of(row, a, b) + row.bound >= 0.0);
}

}  // namespace ricochet
