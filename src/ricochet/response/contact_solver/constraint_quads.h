/// \file
/// The functions of contact_constraints.h for four rows or four bodies at once.
#pragma once

#include <array>
#include <cstddef>

#include "ricochet/core/quad.h"
#include "ricochet/response/contact_solver/contact_constraints.h"

namespace ricochet {

inline constexpr std::size_t kQuad = 4;

/// Pointers to four objects anywhere in memory.
template <class T>
using FourOf = std::array<T*, kQuad>;

/// Four SolverState, and the changes to add to them.
struct QuadState {
    QuadVec3 velocity;
    QuadVec3 turning;
    Quad inverse_mass;
    Quad inverse_inertia;
    QuadVec3 velocity_change;
    QuadVec3 turning_change;
};

struct QuadImpulse {
    Quad normal;
    QuadVec3 tangential;
};

struct QuadConstraint {
    QuadVec3 normal;
    Quad bound;
    Quad friction;
    Quad strictness;
    QuadImpulse impulse;
    QuadImpulse direction;
};

RICOCHET_INLINE void apply(const QuadVec3& impulse, const QuadVec3& turn, QuadState& body) {
    body.velocity_change = body.inverse_mass * impulse;
    body.turning_change = body.inverse_inertia * turn;
}

/// Returns the factors, at most 1, that limit the lengths of four vectors to `most`.
[[nodiscard]] RICOCHET_INLINE Quad length_kept(const QuadVec3& v, const Quad& most) {
    const Quad squared = length_squared(v);
    return select(squared > most * most, most / root(squared), quad_of(1.0));
}

static_assert(sizeof(SolverState) == 8 * sizeof(double) && offsetof(SolverState, velocity) == 0 &&
              offsetof(SolverState, turning) == 3 * sizeof(double) &&
              offsetof(SolverState, inverse_mass) == 6 * sizeof(double));
static_assert(sizeof(ContactConstraint) == 16 * sizeof(double) &&
              offsetof(ContactConstraint, normal) == sizeof(double) &&
              offsetof(ContactConstraint, bound) == 4 * sizeof(double) &&
              offsetof(ContactConstraint, friction) == 5 * sizeof(double) &&
              offsetof(ContactConstraint, strictness) == 6 * sizeof(double) &&
              offsetof(ContactConstraint, impulse) == 8 * sizeof(double) &&
              offsetof(ContactConstraint, direction) == 12 * sizeof(double));

/// Returns the address of four consecutive doubles of an object. The first is double number 4 * part.
template <class T>
[[nodiscard]] RICOCHET_INLINE double* part_of(T* one, std::size_t part) {
    return reinterpret_cast<double*>(one) + part * kQuad;
}

/// Loads one part of each of four objects, see part_of(), and transposes them: result k contains double k of all four.
template <class T>
[[nodiscard]] RICOCHET_INLINE std::array<Quad, kQuad> load_part(const FourOf<T>& from, std::size_t part) {
    std::array<Quad, kQuad> rows{load_quad(part_of(from[0], part)), load_quad(part_of(from[1], part)),
                                 load_quad(part_of(from[2], part)), load_quad(part_of(from[3], part))};
    transpose(rows[0], rows[1], rows[2], rows[3]);
    return rows;
}

[[nodiscard]] RICOCHET_INLINE QuadState load_states(const FourOf<SolverState>& from) {
    const std::array<Quad, kQuad> first = load_part(from, 0);
    const std::array<Quad, kQuad> second = load_part(from, 1);
    QuadState states{};
    states.velocity = {first[0], first[1], first[2]};
    states.turning = {first[3], second[0], second[1]};
    states.inverse_mass = second[2];
    states.inverse_inertia = second[3];
    return states;
}

/// Adds the changes to the states of bodies. Fixed bodies are not written to, because several threads can use them.
RICOCHET_INLINE void store_changes(const QuadState& states, const FourOf<SolverState>& to) {
    const Quad none{};
    const QuadVec3& v = states.velocity_change;
    const QuadVec3& t = states.turning_change;
    std::array<Quad, kQuad> first{v.x, v.y, v.z, t.x};
    std::array<Quad, kQuad> second{t.y, t.z, none, none};
    transpose(first[0], first[1], first[2], first[3]);
    transpose(second[0], second[1], second[2], second[3]);
    for (std::size_t k = 0; k < kQuad; ++k) {
        if (to[k]->inverse_mass == 0.0) continue;
        store(load_quad(part_of(to[k], 0)) + first[k], part_of(to[k], 0));
        store(load_quad(part_of(to[k], 1)) + second[k], part_of(to[k], 1));
    }
}

[[nodiscard]] RICOCHET_INLINE QuadConstraint load_rows(const FourOf<ContactConstraint>& from) {
    const std::array<Quad, kQuad> first = load_part(from, 0);
    const std::array<Quad, kQuad> second = load_part(from, 1);
    const std::array<Quad, kQuad> impulse = load_part(from, 2);
    const std::array<Quad, kQuad> direction = load_part(from, 3);
    QuadConstraint rows;
    rows.normal = {first[1], first[2], first[3]};
    rows.bound = second[0];
    rows.friction = second[1];
    rows.strictness = second[2];
    rows.impulse = {impulse[0], {impulse[1], impulse[2], impulse[3]}};
    rows.direction = {direction[0], {direction[1], direction[2], direction[3]}};
    return rows;
}

RICOCHET_INLINE void store_impulse(const QuadImpulse& impulse, const FourOf<ContactConstraint>& to, std::size_t part) {
    std::array<Quad, kQuad> rows{impulse.normal, impulse.tangential.x, impulse.tangential.y, impulse.tangential.z};
    transpose(rows[0], rows[1], rows[2], rows[3]);
    for (std::size_t k = 0; k < kQuad; ++k) store(rows[k], part_of(to[k], part));
}

/// Stores the members that relax() changes.
RICOCHET_INLINE void store_impulses(const QuadConstraint& rows, const FourOf<ContactConstraint>& to) {
    store_impulse(rows.impulse, to, 2);
    store_impulse(rows.direction, to, 3);
}

}  // namespace ricochet
