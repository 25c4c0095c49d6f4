#include "ricochet/response/network/network_sweep.h"

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
    std::vector<NetworkRow> rows;
    std::vector<RollingRow> rolling;
    std::vector<NetworkState> states;  // the first one is a wall
    std::vector<NetworkState> last;
};

Vec3 some_vector(RandomSequence& random) { return 3.0 * random.uniform() * random.unit_vector(); }

NetworkState some_body(RandomSequence& random) {
    NetworkState state{some_vector(random), some_vector(random), 0.1 + random.uniform(), 2.5 * random.uniform()};
    if (random.uniform() < 0.15) state.mobility = state.turnability = 0.0;  // fixed
    return state;
}

std::uint32_t add_body(Rows& all, RandomSequence& random) {
    all.states.push_back(some_body(random));
    return static_cast<std::uint32_t>(all.states.size() - 1);
}

/// Adds a constraint with or without friction. Some are idle, and some join two fixed bodies, which the solver skips.
void add_row(Rows& all, RandomSequence& random, bool rolls) {
    NetworkRow row;
    row.a = add_body(all, random);
    row.b = random.uniform() < 0.3 ? 0 : add_body(all, random);
    row.normal = random.unit_vector();
    row.bound = random.uniform() - 0.5;
    row.friction = random.uniform() < 0.3 ? 0.0 : random.uniform();
    row.rolling = NetworkRow::kNone;
    if (all.states[row.a].mobility + all.states[row.b].mobility == 0.0) {
        row.bound = INFINITY;
    } else if (random.uniform() < 0.6) {
        row.push = {random.uniform() < 0.3 ? 0.0 : random.uniform(), 0.3 * random.uniform() * random.unit_vector()};
        row.direction = {random.uniform() - 0.5, 0.2 * random.unit_vector()};
    }
    if (rolls && random.uniform() < 0.3) {
        RollingRow rolling;
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
    for (const NetworkState& state : all.states) {
        all.last.push_back(state);
        all.last.back().velocity += 0.1 * random.unit_vector();
        all.last.back().turning += 0.1 * random.unit_vector();
    }
    return all;
}

/// Solves the normal impulse, then friction, of a single constraint with scalar code.
void relax_plainly(NetworkRow& row, double factor, NetworkState& a, NetworkState& b, SweepChange& change) {
    const Vec3 between = a.velocity - b.velocity;
    const double approach = dot(row.normal, between);
    const Vec3 slip = between - approach * row.normal - cross(a.turning + b.turning, row.normal);
    const double mobility = a.mobility + b.mobility;
    const NetworkPush step{factor * row.direction.normal, factor * row.direction.tangential};
    const NetworkPush start{row.push.normal + step.normal, row.push.tangential + step.tangential};
    NetworkPush by;
    by.normal = std::max(-start.normal, -kNetworkOverRelaxation * (1.0 / mobility) * (approach + row.bound));
    change.squared += by.normal * (by.normal * mobility);
    change.approach_squared = std::max(change.approach_squared, by.normal * mobility * (by.normal * mobility));
    row.push = {start.normal + by.normal, start.tangential};
    if (row.friction > 0.0) {
        const double slip_mobility = mobility + a.turnability + b.turnability;
        const Vec3 wish = start.tangential - (1.0 / slip_mobility) * slip;
        const double most = row.friction * row.push.normal;
        const double squared = length_squared(wish);
        row.push.tangential = (squared > most * most ? most / std::sqrt(squared) : 1.0) * wish;
        by.tangential = row.push.tangential - start.tangential;
        const double rubbing = length_squared(by.tangential) * slip_mobility;
        change.squared += rubbing;
        change.slip_squared = std::max(change.slip_squared, rubbing * slip_mobility);
    }
    row.direction = {step.normal + by.normal, step.tangential + by.tangential};
    const Vec3 impulse = by.normal * row.normal + by.tangential;
    const Vec3 turn = -cross(row.normal, by.tangential);
    if (a.mobility > 0.0) {
        a.velocity += a.mobility * impulse;
        a.turning += a.turnability * turn;
    }
    if (b.mobility > 0.0) {
        b.velocity += b.mobility * -impulse;
        b.turning += b.turnability * turn;
    }
}

SweepChange sweep_plainly(Rows& all, double factor) {
    for (std::size_t i = 0; i < all.states.size(); ++i) {
        const NetworkState now = all.states[i];
        if (factor != 0.0) {
            all.states[i].velocity += factor * (now.velocity - all.last[i].velocity);
            all.states[i].turning += factor * (now.turning - all.last[i].turning);
        }
        all.last[i] = now;
    }
    SweepChange change;
    for (NetworkRow& row : all.rows) {
        NetworkState& a = all.states[row.a];
        NetworkState& b = all.states[row.b];
        const bool rests = row.push.normal == 0.0 && row.direction == NetworkPush{};
        if (rests && dot(row.normal, a.velocity - b.velocity) + row.bound >= 0.0) continue;
        relax_plainly(row, factor, a, b, change);
        if (row.rolling != NetworkRow::kNone) relax(row, all.rolling[row.rolling], factor, a, b, change);
    }
    return change;
}

SweepChange sweep(Rows& all, double factor, SweepWay way) {
    go_on(all.states, all.last, factor, way);
    return sweep_rows({all.rows, all.rolling, all.states}, factor, way);
}

void expect_same_bits(double a, double b) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b));
}

void expect_same_bits(const Vec3& a, const Vec3& b) {
    for (int axis = 0; axis < 3; ++axis) expect_same_bits(a[axis], b[axis]);
}

void expect_same_bits(const NetworkPush& a, const NetworkPush& b) {
    expect_same_bits(a.normal, b.normal);
    expect_same_bits(a.tangential, b.tangential);
}

void expect_same_bits(const std::vector<NetworkState>& a, const std::vector<NetworkState>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        SCOPED_TRACE(i);
        expect_same_bits(a[i].velocity, b[i].velocity);
        expect_same_bits(a[i].turning, b[i].turning);
        expect_same_bits(a[i].mobility, b[i].mobility);
        expect_same_bits(a[i].turnability, b[i].turnability);
    }
}

void expect_same_bits(const Rows& a, const Rows& b) {
    expect_same_bits(a.states, b.states);
    expect_same_bits(a.last, b.last);
    for (std::size_t i = 0; i < a.rows.size(); ++i) {
        SCOPED_TRACE(i);
        expect_same_bits(a.rows[i].push, b.rows[i].push);
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
            for (const SweepWay way : sweep_ways()) {
                SCOPED_TRACE(testing::Message() << seed << ' ' << count << ' ' << static_cast<int>(way));
                Rows expected = random_rows(static_cast<std::uint64_t>(seed), count);
                Rows all = expected;
                for (const double factor : {0.4, 0.0, 0.25, 0.6}) {
                    const SweepChange wanted = sweep_plainly(expected, factor);
                    const SweepChange change = sweep(all, factor, way);
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
    for (NetworkRow& row : all.rows) {
        row.push = row.direction = {};
        row.bound = INFINITY;
    }
    const Rows before = all;
    for (const SweepWay way : sweep_ways()) {
        const SweepChange change = sweep_rows({all.rows, all.rolling, all.states}, 0.5, way);
        EXPECT_EQ(change.squared, 0.0);
        EXPECT_EQ(change.worst(), 0.0);
        expect_same_bits(all, before);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
