/// \file
/// Private to the solver of contact networks: four rows, or four bodies, at once, see network_rows.h.
#pragma once

#include <array>
#include <cstddef>

#include "ricochet/core/quad.h"
#include "ricochet/response/network/network_rows.h"

namespace ricochet {

inline constexpr std::size_t kQuad = 4;

/// Four of something, wherever they are.
template <class T>
using FourOf = std::array<T*, kQuad>;

/// Four NetworkState.
struct QuadState {
    QuadVec3 velocity;
    QuadVec3 turning;
    Quad mobility;
    Quad turnability;
};

/// Four NetworkPush.
struct QuadPush {
    Quad normal;
    QuadVec3 tangential;
};

/// Four NetworkRow.
struct QuadRow {
    QuadVec3 normal;
    Quad bound;
    Quad friction;
    QuadPush push;
    QuadPush direction;
    Quad parting;
    Quad rolling;  ///< the bits of the number, no double
};

/// Of those of four that nothing moves the copies are changed, and not stored.
[[nodiscard]] RICOCHET_INLINE bool is_written(const QuadState&) { return true; }

/// The part of four vectors' lengths that is left where they may be no longer than `most`.
[[nodiscard]] RICOCHET_INLINE Quad length_kept(const QuadVec3& v, const Quad& most) {
    const Quad squared = length_squared(v);
    return select(squared > most * most, most / root(squared), quad_of(1.0));
}

/// Doubles part * 4 ... part * 4 + 3 of each of four, transposed.
template <std::size_t part, class T>
RICOCHET_INLINE void load_part(const FourOf<T>& from, Quad& a, Quad& b, Quad& c, Quad& d) {
    static_assert(sizeof(T) % sizeof(Quad) == 0);
    const auto begin = [&](std::size_t k) { return reinterpret_cast<const double*>(from[k]) + part * kQuad; };
    a = load_quad(begin(0));
    b = load_quad(begin(1));
    c = load_quad(begin(2));
    d = load_quad(begin(3));
    transpose(a, b, c, d);
}

template <std::size_t part, class T>
RICOCHET_INLINE void store_part(const Quad& a, const Quad& b, const Quad& c, const Quad& d, const FourOf<T>& to) {
    std::array<Quad, kQuad> rows{a, b, c, d};
    transpose(rows[0], rows[1], rows[2], rows[3]);
    for (std::size_t k = 0; k < kQuad; ++k) store(rows[k], reinterpret_cast<double*>(to[k]) + part * kQuad);
}

static_assert(sizeof(NetworkState) == 8 * sizeof(double) && offsetof(NetworkState, turning) == 3 * sizeof(double) &&
              offsetof(NetworkState, mobility) == 6 * sizeof(double));

[[nodiscard]] RICOCHET_INLINE QuadState load_states(const FourOf<NetworkState>& from) {
    QuadState s;
    load_part<0>(from, s.velocity.x, s.velocity.y, s.velocity.z, s.turning.x);
    load_part<1>(from, s.turning.y, s.turning.z, s.mobility, s.turnability);
    return s;
}

RICOCHET_INLINE void store_states(const QuadState& s, const FourOf<NetworkState>& to) {
    store_part<0>(s.velocity.x, s.velocity.y, s.velocity.z, s.turning.x, to);
    store_part<1>(s.turning.y, s.turning.z, s.mobility, s.turnability, to);
}

static_assert(sizeof(NetworkRow) == 16 * sizeof(double) && offsetof(NetworkRow, normal) == sizeof(double) &&
              offsetof(NetworkRow, bound) == 4 * sizeof(double) && offsetof(NetworkRow, push) == 6 * sizeof(double) &&
              offsetof(NetworkRow, direction) == 10 * sizeof(double) &&
              offsetof(NetworkRow, rolling) == 15 * sizeof(double));

[[nodiscard]] RICOCHET_INLINE QuadRow load_rows(const FourOf<NetworkRow>& from) {
    QuadRow r;
    Quad bodies;
    load_part<0>(from, bodies, r.normal.x, r.normal.y, r.normal.z);
    load_part<1>(from, r.bound, r.friction, r.push.normal, r.push.tangential.x);
    load_part<2>(from, r.push.tangential.y, r.push.tangential.z, r.direction.normal, r.direction.tangential.x);
    load_part<3>(from, r.direction.tangential.y, r.direction.tangential.z, r.parting, r.rolling);
    return r;
}

/// What relax() may have changed, with what lies between.
RICOCHET_INLINE void store_rows(const QuadRow& r, const FourOf<NetworkRow>& to) {
    store_part<1>(r.bound, r.friction, r.push.normal, r.push.tangential.x, to);
    store_part<2>(r.push.tangential.y, r.push.tangential.z, r.direction.normal, r.direction.tangential.x, to);
    store_part<3>(r.direction.tangential.y, r.direction.tangential.z, r.parting, r.rolling, to);
}

}  // namespace ricochet
