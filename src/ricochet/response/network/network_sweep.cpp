#include "ricochet/response/network/network_sweep.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "ricochet/response/network/network_quads.h"

namespace ricochet {
namespace {

[[nodiscard]] RICOCHET_INLINE bool is_idle(const SweptRows& swept, const NetworkRow& row) {
    return is_idle(row, swept.states[row.a], swept.states[row.b]);
}

RICOCHET_INLINE void relax_rolling(const SweptRows& swept, double factor, const NetworkRow& row, SweepChange& change) {
    if (row.rolling == NetworkRow::kNone) return;
    relax(row, swept.rolling[row.rolling], factor, swept.states[row.a], swept.states[row.b], change);
}

RICOCHET_INLINE void relax_one(const SweptRows& swept, double factor, NetworkRow& row, SweepChange& change) {
    change.add(relax(row, factor, swept.states[row.a], swept.states[row.b]));
    relax_rolling(swept, factor, row, change);
}

#if defined(__x86_64__)

/// Rows whose work is looked for together: they and their bodies stay in the first level of memory meanwhile.
constexpr std::size_t kLookAhead = 64;

/// Four rows and the bodies of each.
struct Places {
    FourOf<NetworkRow> rows;
    FourOf<NetworkState> a, b;
};

class QuadSweep {
public:
    RICOCHET_INLINE QuadSweep(const SweptRows& swept, double factor) : swept_(swept), factor_(factor) {}

    /// All rows.
    RICOCHET_INLINE SweepChange run() {
        for (std::size_t begin = 0; begin < swept_.rows.size(); begin += kLookAhead) {
            find_work(begin, std::min(begin + kLookAhead, swept_.rows.size()));
            std::size_t done = 0;
            for (; done + kQuad <= count_; done += kQuad) relax_four(&work_[done]);
            std::copy(&work_[done], &work_[count_], work_.data());
            count_ -= done;
        }
        for (std::size_t k = 0; k < count_; ++k) relax_one(swept_, factor_, *work_[k], change_);
        for (std::size_t k = 0; k < kQuad; ++k) {
            change_.approach_squared = std::max(change_.approach_squared, most_.approach_squared.lanes[k]);
            change_.slip_squared = std::max(change_.slip_squared, most_.slip_squared.lanes[k]);
        }
        return change_;
    }

private:
    /// rows: pointers to them, or they themselves, side by side.
    [[nodiscard]] RICOCHET_INLINE Places places_of(const FourOf<NetworkRow>& rows) const {
        Places places;
        for (std::size_t k = 0; k < kQuad; ++k) {
            places.rows[k] = rows[k];
            places.a[k] = &swept_.states[rows[k]->a];
            places.b[k] = &swept_.states[rows[k]->b];
        }
        return places;
    }

    RICOCHET_INLINE void find_work(std::size_t begin, std::size_t end) {
        for (; begin + kQuad <= end; begin += kQuad) {
            NetworkRow* row = &swept_.rows[begin];
            const Places at = places_of({row, row + 1, row + 2, row + 3});
            const QuadMask idle = ricochet::is_idle(load_rows(at.rows), load_states(at.a), load_states(at.b));
            for (std::size_t k = 0; k < kQuad; ++k) {
                work_[count_] = at.rows[k];
                count_ += idle.lanes[k] == 0 ? 1 : 0;
            }
        }
        for (NetworkRow& row : swept_.rows.subspan(begin, end - begin)) {
            work_[count_] = &row;
            count_ += is_idle(swept_, row) ? 0 : 1;
        }
    }

    RICOCHET_INLINE void relax_four(NetworkRow* const* work) {
        const Places at = places_of({work[0], work[1], work[2], work[3]});
        QuadRow row = load_rows(at.rows);
        QuadState a = load_states(at.a);
        QuadState b = load_states(at.b);
        const RowChange<Quad> change = relax(row, factor_, a, b);
        store_pushes(row, at.rows);
        store_changes(a, at.a);
        store_changes(b, at.b);
        most_.approach_squared = larger(most_.approach_squared, change.approach_squared);
        most_.slip_squared = larger(most_.slip_squared, change.slip_squared);
        for (std::size_t k = 0; k < kQuad; ++k) {
            change_.squared += change.pushing.lanes[k];
            change_.squared += change.rubbing.lanes[k];
            relax_rolling(swept_, factor_, *at.rows[k], change_);
        }
    }

    const SweptRows swept_;
    double factor_ = 0.0;
    SweepChange change_;
    RowChange<Quad> most_;
    std::array<NetworkRow*, kLookAhead + kQuad> work_;  // rows that are not idle, and not relaxed yet
    std::size_t count_ = 0;
};

[[gnu::target("avx2")]] SweepChange sweep_by_four(const SweptRows& swept, double factor) {
    return QuadSweep(swept, factor).run();
}

#endif

}  // namespace

SweepChange sweep_in_order(const SweptRows& swept, double factor) {
    SweepChange change;
    for (NetworkRow& row : swept.rows) {
        if (!is_idle(swept, row)) relax_one(swept, factor, row, change);
    }
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
