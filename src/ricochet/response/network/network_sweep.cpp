#include "ricochet/response/network/network_sweep.h"

#include <algorithm>
#include <cstddef>

#include "ricochet/response/network/network_quads.h"

namespace ricochet {
namespace {

RICOCHET_INLINE void sweep_one(const SweptRows& swept, double factor, NetworkRow& row, SweepChange& change) {
    NetworkState& a = swept.states[row.a];
    NetworkState& b = swept.states[row.b];
    if (is_idle(row, a, b)) return;
    change.add(relax(row, factor, a, b));
    if (row.rolling != NetworkRow::kNone) relax(row, swept.rolling[row.rolling], factor, a, b, change);
}

RICOCHET_INLINE void sweep_rest(const SweptRows& swept, double factor, std::size_t begin, SweepChange& change) {
    for (NetworkRow& row : swept.rows.subspan(begin)) sweep_one(swept, factor, row, change);
}

#if defined(__x86_64__)

/// Rows ahead whose bodies are fetched.
constexpr std::size_t kAhead = 16;

/// What four rows and their bodies that do nothing are stored to.
struct Spare {
    NetworkRow row;
    NetworkState state;
};

/// Where each of four is stored to.
template <class T>
RICOCHET_INLINE FourOf<T> where(const QuadMask& mask, const FourOf<T>& there, T& spare) {
    FourOf<T> to;
    for (std::size_t k = 0; k < kQuad; ++k) to[k] = mask.lanes[k] != 0 ? there[k] : &spare;
    return to;
}

RICOCHET_INLINE void fetch_bodies(const SweptRows& swept, std::size_t i) {
    if (i + kQuad > swept.rows.size()) return;
    for (std::size_t k = i; k < i + kQuad; ++k) {
        __builtin_prefetch(&swept.states[swept.rows[k].a], 1);
        __builtin_prefetch(&swept.states[swept.rows[k].b], 1);
    }
}

/// Sums in the order of the rows, each of which may resist rolling.
RICOCHET_INLINE void add_up(const SweptRows& swept, double factor, std::size_t begin, const QuadMask& works,
                            const RowChange<Quad>& quad, SweepChange& change) {
    for (std::size_t k = 0; k < kQuad; ++k) {
        change.squared += quad.pushing.lanes[k];
        change.squared += quad.rubbing.lanes[k];
        NetworkRow& row = swept.rows[begin + k];
        if (row.rolling == NetworkRow::kNone || works.lanes[k] == 0) continue;
        relax(row, swept.rolling[row.rolling], factor, swept.states[row.a], swept.states[row.b], change);
    }
}

RICOCHET_INLINE void sweep_four(const SweptRows& swept, double factor, std::size_t begin, Spare& spare,
                                RowChange<Quad>& most, SweepChange& change) {
    FourOf<NetworkRow> rows;
    FourOf<NetworkState> at_a;
    FourOf<NetworkState> at_b;
    for (std::size_t k = 0; k < kQuad; ++k) {
        rows[k] = &swept.rows[begin + k];
        at_a[k] = &swept.states[rows[k]->a];
        at_b[k] = &swept.states[rows[k]->b];
    }
    QuadRow row = load_rows(rows);
    QuadState a = load_states(at_a);
    QuadState b = load_states(at_b);
    const QuadMask works = ~is_idle(row, a, b);
    if (!any(works)) return;
    RowChange<Quad> quad = relax(row, factor, a, b);
    store_rows(row, where(works, rows, spare.row));
    store_states(a, where(works & (a.mobility != 0.0), at_a, spare.state));
    store_states(b, where(works & (b.mobility != 0.0), at_b, spare.state));
    const Quad none{};
    most.approach_squared = larger(most.approach_squared, select(works, quad.approach_squared, none));
    most.slip_squared = larger(most.slip_squared, select(works, quad.slip_squared, none));
    quad.pushing = select(works, quad.pushing, none);
    quad.rubbing = select(works, quad.rubbing, none);
    add_up(swept, factor, begin, works, quad, change);
}

[[gnu::target("avx2")]] SweepChange sweep_by_four(const SweptRows& swept, double factor) {
    SweepChange change;
    RowChange<Quad> most;
    Spare spare;
    std::size_t i = 0;
    for (; i + kQuad <= swept.rows.size(); i += kQuad) {
        fetch_bodies(swept, i + kAhead);
        sweep_four(swept, factor, i, spare, most, change);
    }
    sweep_rest(swept, factor, i, change);
    for (std::size_t k = 0; k < kQuad; ++k) {
        change.approach_squared = std::max(change.approach_squared, most.approach_squared.lanes[k]);
        change.slip_squared = std::max(change.slip_squared, most.slip_squared.lanes[k]);
    }
    return change;
}

#endif

}  // namespace

SweepChange sweep_in_order(const SweptRows& swept, double factor) {
    SweepChange change;
    sweep_rest(swept, factor, 0, change);
    return change;
}

SweepChange sweep_apart(const SweptRows& swept, double factor) {
#if defined(__x86_64__)
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
    if (has_avx2) return sweep_by_four(swept, factor);
#endif
    return sweep_in_order(swept, factor);
}

}  // namespace ricochet
