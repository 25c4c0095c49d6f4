/// \file
/// Private to the solver of contact networks: one contact, solved with all others as they are.
///
/// Arms are parallel to normals, so that of a contact's own impulses the normal one changes the approach alone, and
/// friction the slip alone: each has its answer in closed form. Spins enter as surface speeds, radius times spin.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/network/contact_network.h"

namespace ricochet {

/// A body as it moves now, or a wall.
struct alignas(64) NetworkState {
    Vec3 velocity;
    Vec3 turning;            ///< radius times spin, m/s
    double mobility = 0;     ///< 1 / mass, 1/kg
    double turnability = 0;  ///< radius^2 / moment of inertia, 1/kg
};

/// A contact's impulse but for its moment, or a change of it.
struct NetworkPush {
    double normal = 0.0;
    Vec3 tangential;
};

/// What a contact needs in every sweep.
struct NetworkRow {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    Vec3 normal;
    double bound = 0.0;    ///< m/s, with which it may still approach; < 0: with which it has to leave
    double parting = 0.0;  ///< m/s, >= 0, with which what overlaps is parted
    double friction = 0.0;
    double normal_mass = 0.0;    ///< kg, impulse that changes the approach by 1 m/s
    double slip_mass = 0.0;      ///< kg, the same of the slip
    double mobility = 0.0;       ///< 1/kg, the inverse of the first: sweeps need not divide
    double slip_mobility = 0.0;  ///< 1/kg, of the second
    NetworkPush push;
    std::uint32_t rolling = 0;  ///< its number among the rows that resist rolling; kNone

    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
};

/// The part of a contact that resists rolling.
struct RollingRow {
    std::uint32_t row = 0;
    double friction = 0.0;      ///< m
    double per_radius_a = 0.0;  ///< 1 / radius, 1/m
    double per_radius_b = 0.0;
    Vec3 wall_turning;     ///< rad/s, of the wall
    double inertia = 0.0;  ///< kg m^2, moment that changes the rolling by 1 rad/s
    Vec3 moment;           ///< N m s
    Vec3 change;           ///< by the last sweep
    Vec3 direction;        ///< in which the sweeps go on
};

/// How much a sweep has changed.
struct SweepChange {
    double squared = 0.0;        ///< J, sum of impulses times the velocities that they change
    double worst_squared = 0.0;  ///< m^2/s^2, of the largest change of a contact's velocity

    void add(const SweepChange& other) {
        squared += other.squared;
        worst_squared = std::max(worst_squared, other.worst_squared);
    }
    [[nodiscard]] double worst() const { return std::sqrt(worst_squared); }
};

[[nodiscard]] inline double approach_of(const NetworkRow& row, const NetworkState& a, const NetworkState& b) {
    return dot(row.normal, a.velocity - b.velocity);
}

/// Slip of a over b.
[[nodiscard]] inline Vec3 slip_of(const NetworkRow& row, const NetworkState& a, const NetworkState& b) {
    const Vec3 between = a.velocity - b.velocity;
    return between - dot(row.normal, between) * row.normal - cross(a.turning + b.turning, row.normal);
}

/// Spin of a relative to b, across the normal.
[[nodiscard]] inline Vec3 rolling_of(const NetworkRow& row, const RollingRow& rolling, const NetworkState& a,
                                     const NetworkState& b) {
    const Vec3 between = rolling.per_radius_a * a.turning - rolling.per_radius_b * b.turning - rolling.wall_turning;
    return between - dot(row.normal, between) * row.normal;
}

/// What nothing moves is not written to: threads share it.
inline void apply(const Vec3& impulse, const Vec3& turn, NetworkState& body) {
    body.velocity += body.mobility * impulse;
    body.turning += body.turnability * turn;
}

inline void apply(const NetworkRow& row, const NetworkPush& push, NetworkState& a, NetworkState& b) {
    const Vec3 impulse = push.normal * row.normal + push.tangential;
    const Vec3 turn = -cross(row.normal, push.tangential);
    if (a.mobility != 0.0) apply(impulse, turn, a);
    if (b.mobility != 0.0) apply(-impulse, turn, b);
}

inline void apply_moment(const RollingRow& rolling, const Vec3& moment, NetworkState& a, NetworkState& b) {
    if (a.mobility != 0.0) a.turning += (a.turnability * rolling.per_radius_a) * moment;
    if (b.mobility != 0.0) b.turning -= (b.turnability * rolling.per_radius_b) * moment;
}

/// The part of a vector's length that is left where it may be no longer than `most`.
[[nodiscard]] inline double length_kept(const Vec3& v, double most) {
    const double squared = length_squared(v);
    return squared > most * most ? most / std::sqrt(squared) : 1.0;
}

/// v, shortened to a length where it is longer.
[[nodiscard]] inline Vec3 shortened(const Vec3& v, double most) { return length_kept(v, most) * v; }

/// Puts a row right for the state that there is; returns by what it has changed its impulse.
[[nodiscard]] inline NetworkPush relax(NetworkRow& row, NetworkState& a, NetworkState& b, SweepChange& change) {
    NetworkPush by;
    by.normal =
        std::max(-row.push.normal, -kNetworkOverRelaxation * row.normal_mass * (approach_of(row, a, b) + row.bound));
    const bool pushes = row.push.normal > 0.0 || by.normal != 0.0;
    if (!pushes) return by;
    row.push.normal += by.normal;
    const double velocity = by.normal * row.mobility;
    change.squared += by.normal * velocity;
    change.worst_squared = std::max(change.worst_squared, velocity * velocity);
    if (row.friction > 0.0) {
        const Vec3 wish = row.push.tangential - row.slip_mass * slip_of(row, a, b);
        const Vec3 cut = length_kept(wish, row.friction * row.push.normal) * wish;
        by.tangential = cut - row.push.tangential;
        row.push.tangential = cut;
        const double squared = length_squared(by.tangential) * row.slip_mobility;
        change.squared += squared;
        change.worst_squared = std::max(change.worst_squared, squared * row.slip_mobility);
    }
    apply(row, by, a, b);
    return by;
}

/// The same of its resistance to rolling; as a velocity counts that of the smaller sphere's surface.
inline void relax(const NetworkRow& row, RollingRow& rolling, NetworkState& a, NetworkState& b, SweepChange& change) {
    const Vec3 wish = rolling.moment - rolling.inertia * rolling_of(row, rolling, a, b);
    const Vec3 cut = shortened(wish, rolling.friction * row.push.normal);
    rolling.change = cut - rolling.moment;
    rolling.moment = cut;
    apply_moment(rolling, rolling.change, a, b);
    const double squared = length_squared(rolling.change) / rolling.inertia;
    change.squared += squared;
    const double per_radius = std::max(rolling.per_radius_a, rolling.per_radius_b);
    change.worst_squared = std::max(change.worst_squared, squared / (rolling.inertia * per_radius * per_radius));
}

}  // namespace ricochet
