/// \file
/// Private to the solver of contact networks: one contact, solved with all others as they are. What is a template does
/// the same for four at once (constraint_quads.h), with the same bits.
///
/// Arms are parallel to normals, so that of a contact's own impulses the normal one changes the approach alone, and
/// friction the slip alone: each has its answer in closed form. Spins enter as surface speeds, radius times spin.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ricochet/core/quad.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/contact_solver/contact_network.h"

namespace ricochet {

/// A body as it moves now, or a wall.
struct alignas(64) SolverState {
    Vec3 velocity;
    Vec3 turning;                ///< radius times spin, m/s
    double inverse_mass = 0;     ///< 1 / mass, 1/kg
    double inverse_inertia = 0;  ///< radius^2 / moment of inertia, 1/kg
};

/// A contact's impulse but for its moment, or a change of it.
struct ConstraintImpulse {
    double normal = 0.0;
    Vec3 tangential;

    friend bool operator==(const ConstraintImpulse&, const ConstraintImpulse&) = default;
};

/// What a contact needs in every sweep: two lines of memory, of which a sweep writes the second. Masses are those of
/// its two bodies, which are at hand.
struct alignas(64) ContactConstraint {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    Vec3 normal;
    double bound = 0.0;  ///< m/s, with which it may still approach; < 0: with which it has to leave
    double friction = 0.0;
    double strictness = 1.0;    ///< >= 1, squared: so many times larger its errors count
    std::uint32_t rolling = 0;  ///< its number among the rows that resist rolling; kNone
    ConstraintImpulse impulse;
    ConstraintImpulse direction;  ///< by what the last sweep has changed it, with the momentum before it

    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
};

/// The part of a contact that resists rolling.
struct RollingConstraint {
    std::uint32_t row = 0;
    double friction = 0.0;      ///< m
    double per_radius_a = 0.0;  ///< 1 / radius, 1/m
    double per_radius_b = 0.0;
    Vec3 wall_turning;     ///< rad/s, of the wall
    double inertia = 0.0;  ///< kg m^2, moment that changes the rolling by 1 rad/s
    Vec3 moment;           ///< N m s
    Vec3 direction;        ///< by what the last sweep has changed it, with the momentum before it
};

/// m/s, by which the conditions of contacts may be violated.
struct SolverLimits {
    double approach = 0.0;
    double slip = 0.0;  ///< the same of rolling
};

/// How much a row has changed, or each of four, see SweepChange.
template <class Number>
struct RowChange {
    Number normal_work{};       ///< J, by the normal impulse
    Number tangential_work{};   ///< J, by friction
    Number approach_squared{};  ///< m^2/s^2, as it counts
    Number slip_squared{};
};

/// How much a sweep has changed.
struct SweepChange {
    double squared = 0.0;           ///< J, sum of impulses times the velocities that they change
    double approach_squared = 0.0;  ///< m^2/s^2, of the largest change of a contact's approach, as it counts
    double slip_squared = 0.0;      ///< m^2/s^2, of the largest change of its slip, as it counts

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
    [[nodiscard]] bool is_within(const SolverLimits& limits) const {
        return std::sqrt(approach_squared) <= limits.approach && std::sqrt(slip_squared) <= limits.slip;
    }
};

template <class Row, class State>
[[nodiscard]] RICOCHET_INLINE auto approach_of(const Row& row, const State& a, const State& b) {
    return dot(row.normal, a.velocity - b.velocity);
}

/// Slip of a over b.
template <class Row, class State>
[[nodiscard]] RICOCHET_INLINE auto slip_of(const Row& row, const State& a, const State& b) {
    const auto between = a.velocity - b.velocity;
    return between - dot(row.normal, between) * row.normal - cross(a.turning + b.turning, row.normal);
}

/// Spin of a relative to b, across the normal.
[[nodiscard]] inline Vec3 rolling_of(const ContactConstraint& row, const RollingConstraint& rolling,
                                     const SolverState& a, const SolverState& b) {
    const Vec3 between = rolling.per_radius_a * a.turning - rolling.per_radius_b * b.turning - rolling.wall_turning;
    return between - dot(row.normal, between) * row.normal;
}

/// What nothing moves is not written to: threads share it.
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

/// The part of a vector's length that is left where it may be no longer than `most`.
[[nodiscard]] inline double length_kept(const Vec3& v, double most) {
    const double squared = length_squared(v);
    return squared > most * most ? most / std::sqrt(squared) : 1.0;
}

/// v, shortened to a length where it is longer.
[[nodiscard]] inline Vec3 shortened(const Vec3& v, double most) { return length_kept(v, most) * v; }

/// 1/kg, of the approach of two.
template <class State>
[[nodiscard]] RICOCHET_INLINE auto inverse_mass_of(const State& a, const State& b) {
    return a.inverse_mass + b.inverse_mass;
}

/// 1/kg, of their slip.
template <class State>
[[nodiscard]] RICOCHET_INLINE auto slip_inverse_mass_of(const State& a, const State& b) {
    return inverse_mass_of(a, b) + a.inverse_inertia + b.inverse_inertia;
}

/// Goes on with a row by a factor of its direction, as its bodies have gone already, and puts it right for the state
/// that there is.
template <class Row, class State>
RICOCHET_INLINE auto relax(Row& row, double factor, State& a, State& b) {
    RowChange<decltype(row.bound)> change;
    const auto violation = approach_of(row, a, b) + row.bound;
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

/// The same of its resistance to rolling; as a velocity counts that of the smaller sphere's surface.
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

/// It does nothing, has done nothing in the last sweep, and need not do anything now.
template <class Row, class State>
[[nodiscard]] RICOCHET_INLINE auto is_idle(const Row& row, const State& a, const State& b) {
    const auto& direction = row.direction.tangential;
    const auto has_rested = (row.impulse.normal == 0.0) & (row.direction.normal == 0.0) & (direction.x == 0.0) &
                            (direction.y == 0.0) & (direction.z == 0.0);
    return has_rested & (approach_of(row, a, b) + row.bound >= 0.0);
}

}  // namespace ricochet
