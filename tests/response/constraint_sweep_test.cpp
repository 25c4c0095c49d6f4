#include "ricochet/response/contact_solver/constraint_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Constraints and their bodies. No two constraints share a moving body.
struct Rows {
    std::vector<ContactConstraint> rows;
    std::vector<RollingConstraint> rolling;
    std::vector<SolverState> states;  // the first one is a wall
    std::vector<SolverState> last;
};

Vec3 some_vector(RandomSequence& random) { return 3.0 * random.uniform() * random.unit_vector(); }

SolverState some_body(RandomSequence& random) {
    SolverState state{some_vector(random), some_vector(random), 0.1 + random.uniform(), 2.5 * random.uniform()};
    if (random.uniform() < 0.15) state.inverse_mass = state.inverse_inertia = 0.0;  // fixed
    return state;
}

std::uint32_t add_body(Rows& all, RandomSequence& random) {
    all.states.push_back(some_body(random));
    return static_cast<std::uint32_t>(all.states.size() - 1);
}

/// Adds a constraint with or without friction. Some are idle, and some join two fixed bodies, which the solver skips.
void add_row(Rows& all, RandomSequence& random, bool rolls) {
    ContactConstraint row;
    row.a = add_body(all, random);
    row.b = random.uniform() < 0.3 ? 0 : add_body(all, random);
    row.normal = random.unit_vector();
    row.bound = random.uniform() - 0.5;
    row.friction = random.uniform() < 0.3 ? 0.0 : random.uniform();
    row.rolling = ContactConstraint::kNone;
    if (all.states[row.a].inverse_mass + all.states[row.b].inverse_mass == 0.0) {
        row.bound = INFINITY;
    } else if (random.uniform() < 0.6) {
        row.impulse = {random.uniform() < 0.3 ? 0.0 : random.uniform(), 0.3 * random.uniform() * random.unit_vector()};
        row.direction = {random.uniform() - 0.5, 0.2 * random.unit_vector()};
    }
    if (rolls && random.uniform() < 0.3) {
        RollingConstraint rolling;
        rolling.row = static_cast<std::uint32_t>(all.rows.size());
        rolling.friction = 0.1 * random.uniform();
        rolling.per_radius_a = 1.0 + random.uniform();
        rolling.per_radius_b = 1.0 + random.uniform();
        rolling.wall_turning = 0.1 * random.unit_vector();
        rolling.inertia = 0.1 + random.uniform();
        rolling.moment = 0.05 * random.unit_vector();
        row.rolling = static_cast<std::uint32_t>(all.rolling.size());
        all.rolling.push_back(rolling);
    }
    all.rows.push_back(row);
}

Rows random_rows(std::uint64_t seed, std::size_t count) {
    RandomSequence random(seed, static_cast<std::uint32_t>(count), 0);
    const bool rolls = random.uniform() < 0.5;
    Rows all;
    all.states.push_back({some_vector(random), some_vector(random), 0.0, 0.0});
    while (all.rows.size() < count) add_row(all, random, rolls);
    for (const SolverState& state : all.states) {
        all.last.push_back(state);
        all.last.back().velocity += 0.1 * random.unit_vector();
        all.last.back().turning += 0.1 * random.unit_vector();
    }
    return all;
}

/// Solves the normal impulse, then friction, of a single constraint with scalar code.
void relax_plainly(ContactConstraint& row, double factor, SolverState& a, SolverState& b, SweepChange& change) {
    const Vec3 between = a.velocity - b.velocity;
    const double approach = dot(row.normal, between);
    const Vec3 slip = between - approach * row.normal - cross(a.turning + b.turning, row.normal);
    const double inverse_mass = a.inverse_mass + b.inverse_mass;
    const ConstraintImpulse step{factor * row.direction.normal, factor * row.direction.tangential};
    const ConstraintImpulse start{row.impulse.normal + step.normal, row.impulse.tangential + step.tangential};
    ConstraintImpulse by;
    by.normal = std::max(-start.normal, -kNetworkOverRelaxation * (1.0 / inverse_mass) * (approach + row.bound));
    change.squared += by.normal * (by.normal * inverse_mass);
    change.approach_squared = std::max(change.approach_squared, by.normal * inverse_mass * (by.normal * inverse_mass));
    row.impulse = {start.normal + by.normal, start.tangential};
    if (row.friction > 0.0) {
        const double slip_inverse_mass = inverse_mass + a.inverse_inertia + b.inverse_inertia;
        const Vec3 wish = start.tangential - (1.0 / slip_inverse_mass) * slip;
        const double most = row.friction * row.impulse.normal;
        const double squared = length_squared(wish);
        row.impulse.tangential = (squared > most * most ? most / std::sqrt(squared) : 1.0) * wish;
        by.tangential = row.impulse.tangential - start.tangential;
        const double tangential_work = length_squared(by.tangential) * slip_inverse_mass;
        change.squared += tangential_work;
        change.slip_squared = std::max(change.slip_squared, tangential_work * slip_inverse_mass);
    }
    row.direction = {step.normal + by.normal, step.tangential + by.tangential};
    const Vec3 impulse = by.normal * row.normal + by.tangential;
    const Vec3 turn = -cross(row.normal, by.tangential);
    if (a.inverse_mass > 0.0) {
        a.velocity += a.inverse_mass * impulse;
        a.turning += a.inverse_inertia * turn;
    }
    if (b.inverse_mass > 0.0) {
        b.velocity += b.inverse_mass * -impulse;
        b.turning += b.inverse_inertia * turn;
    }
}

SweepChange sweep_plainly(Rows& all, double factor) {
    for (std::size_t i = 0; i < all.states.size(); ++i) {
        const SolverState now = all.states[i];
        if (factor != 0.0) {
            all.states[i].velocity += factor * (now.velocity - all.last[i].velocity);
            all.states[i].turning += factor * (now.turning - all.last[i].turning);
        }
        all.last[i] = now;
    }
    SweepChange change;
    for (ContactConstraint& row : all.rows) {
        SolverState& a = all.states[row.a];
        SolverState& b = all.states[row.b];
        const bool rests = row.impulse.normal == 0.0 && row.direction == ConstraintImpulse{};
        if (rests && dot(row.normal, a.velocity - b.velocity) + row.bound >= 0.0) continue;
        relax_plainly(row, factor, a, b, change);
        if (row.rolling != ContactConstraint::kNone) relax(row, all.rolling[row.rolling], factor, a, b, change);
    }
    return change;
}

SweepChange sweep(Rows& all, double factor, VectorUnit unit) {
    go_on(all.states, all.last, factor, unit);
    return sweep_rows({all.rows, all.rolling, all.states}, factor, unit);
}

void expect_same_bits(double a, double b) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b));
}

void expect_same_bits(const Vec3& a, const Vec3& b) {
    for (int axis = 0; axis < 3; ++axis) expect_same_bits(a[axis], b[axis]);
}

void expect_same_bits(const ConstraintImpulse& a, const ConstraintImpulse& b) {
    expect_same_bits(a.normal, b.normal);
    expect_same_bits(a.tangential, b.tangential);
}

void expect_same_bits(const std::vector<SolverState>& a, const std::vector<SolverState>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        SCOPED_TRACE(i);
        expect_same_bits(a[i].velocity, b[i].velocity);
        expect_same_bits(a[i].turning, b[i].turning);
        expect_same_bits(a[i].inverse_mass, b[i].inverse_mass);
        expect_same_bits(a[i].inverse_inertia, b[i].inverse_inertia);
    }
}

void expect_same_bits(const Rows& a, const Rows& b) {
    expect_same_bits(a.states, b.states);
    expect_same_bits(a.last, b.last);
    for (std::size_t i = 0; i < a.rows.size(); ++i) {
        SCOPED_TRACE(i);
        expect_same_bits(a.rows[i].impulse, b.rows[i].impulse);
        expect_same_bits(a.rows[i].direction, b.rows[i].direction);
        EXPECT_EQ(a.rows[i].bound, b.rows[i].bound);
        EXPECT_EQ(a.rows[i].rolling, b.rows[i].rolling);
    }
    for (std::size_t i = 0; i < a.rolling.size(); ++i) {
        expect_same_bits(a.rolling[i].moment, b.rolling[i].moment);
        expect_same_bits(a.rolling[i].direction, b.rolling[i].direction);
    }
}

/// Numbers of constraints around multiples of four, and around the number that is scanned together.
constexpr std::array<std::size_t, 12> kCounts{0, 1, 2, 3, 4, 5, 8, 11, 63, 64, 67, 200};

TEST(NetworkSweep, EveryVariantGivesTheBitsOfAScalarSweep) {
    for (int seed = 0; seed < test::scaled(50); ++seed) {
        for (const std::size_t count : kCounts) {
            for (const VectorUnit unit : vector_units()) {
                SCOPED_TRACE(testing::Message() << seed << ' ' << count << ' ' << static_cast<int>(unit));
                Rows expected = random_rows(static_cast<std::uint64_t>(seed), count);
                Rows all = expected;
                for (const double factor : {0.4, 0.0, 0.25, 0.6}) {
                    const SweepChange wanted = sweep_plainly(expected, factor);
                    const SweepChange change = sweep(all, factor, unit);
                    expect_same_bits(change.squared, wanted.squared);
                    expect_same_bits(change.approach_squared, wanted.approach_squared);
                    expect_same_bits(change.slip_squared, wanted.slip_squared);
                }
                expect_same_bits(all, expected);
                if (HasFailure()) return;
            }
        }
    }
}

TEST(NetworkSweep, IdleConstraintsChangeNothing) {
    Rows all = random_rows(1, 100);
    for (ContactConstraint& row : all.rows) {
        row.impulse = row.direction = {};
        row.bound = INFINITY;
    }
    const Rows before = all;
    for (const VectorUnit unit : vector_units()) {
        const SweepChange change = sweep_rows({all.rows, all.rolling, all.states}, 0.5, unit);
        EXPECT_EQ(change.squared, 0.0);
        EXPECT_EQ(change.worst(), 0.0);
        expect_same_bits(all, before);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
