#include "ricochet/response/contact_solver/constraint_sweep.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "ricochet/response/contact_solver/constraint_quads.h"

namespace ricochet {
namespace {

[[nodiscard]] RICOCHET_INLINE bool is_idle(const SweptRows& swept, const ContactConstraint& row) {
    return is_idle(row, swept.states[row.a], swept.states[row.b]);
}

RICOCHET_INLINE void relax_rolling(const SweptRows& swept, double factor, const ContactConstraint& row,
                                   SweepChange& change) {
    if (row.rolling == ContactConstraint::kNone) return;
    relax(row, swept.rolling[row.rolling], factor, swept.states[row.a], swept.states[row.b], change);
}

RICOCHET_INLINE void relax_one(const SweptRows& swept, double factor, ContactConstraint& row, SweepChange& change) {
    change.add(relax(row, factor, swept.states[row.a], swept.states[row.b]));
    relax_rolling(swept, factor, row, change);
}

#if defined(__x86_64__)

/// Number of rows per search for rows that are not idle. Reason: these rows and their bodies stay in the L1 cache.
constexpr std::size_t kLookAhead = 64;

struct QuadBodies {
    FourOf<ContactConstraint> rows;
    FourOf<SolverState> a, b;
};

/// Sweep over four rows at once. It first finds the rows that are not idle, which differ from sweep to sweep, and then
/// solves four of them at once. Reason: some of four neighbouring rows are nearly always idle.
class QuadSweep {
public:
    RICOCHET_INLINE QuadSweep(const SweptRows& swept, double factor) : swept_(swept), factor_(factor) {}

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
    [[nodiscard]] RICOCHET_INLINE QuadBodies gather_bodies(const FourOf<ContactConstraint>& rows) const {
        QuadBodies bodies;
        for (std::size_t k = 0; k < kQuad; ++k) {
            bodies.rows[k] = rows[k];
            bodies.a[k] = &swept_.states[rows[k]->a];
            bodies.b[k] = &swept_.states[rows[k]->b];
        }
        return bodies;
    }

    /// Appends the rows that are not idle, without branches, because branches would be mispredicted.
    RICOCHET_INLINE void find_work(std::size_t begin, std::size_t end) {
        for (; begin + kQuad <= end; begin += kQuad) {
            ContactConstraint* row = &swept_.rows[begin];
            const QuadBodies at = gather_bodies({row, row + 1, row + 2, row + 3});
            const QuadMask idle = ricochet::is_idle(load_rows(at.rows), load_states(at.a), load_states(at.b));
            for (std::size_t k = 0; k < kQuad; ++k) {
                work_[count_] = at.rows[k];
                count_ += idle.lanes[k] == 0 ? 1 : 0;
            }
        }
        for (ContactConstraint& row : swept_.rows.subspan(begin, end - begin)) {
            work_[count_] = &row;
            count_ += is_idle(swept_, row) ? 0 : 1;
        }
    }

    RICOCHET_INLINE void relax_four(ContactConstraint* const* work) {
        const QuadBodies at = gather_bodies({work[0], work[1], work[2], work[3]});
        QuadConstraint row = load_rows(at.rows);
        QuadState a = load_states(at.a);
        QuadState b = load_states(at.b);
        const RowChange<Quad> change = relax(row, factor_, a, b);
        store_impulses(row, at.rows);
        store_changes(a, at.a);
        store_changes(b, at.b);
        most_.approach_squared = larger(most_.approach_squared, change.approach_squared);
        most_.slip_squared = larger(most_.slip_squared, change.slip_squared);
        add_up(change.normal_work, change.tangential_work, at.rows);
    }

    /// Adds the changes in the order of the rows, as in a sweep over single rows.
    RICOCHET_INLINE void add_up(const Quad& normal_work, const Quad& tangential_work,
                                const FourOf<ContactConstraint>& rows) {
        if ((rows[0]->rolling & rows[1]->rolling & rows[2]->rolling & rows[3]->rolling) == ContactConstraint::kNone) {
            change_.squared = change_.squared + normal_work.lanes[0] + tangential_work.lanes[0] + normal_work.lanes[1] +
                              tangential_work.lanes[1] + normal_work.lanes[2] + tangential_work.lanes[2] +
                              normal_work.lanes[3] + tangential_work.lanes[3];
            return;
        }
        for (std::size_t k = 0; k < kQuad; ++k) {
            change_.squared = change_.squared + normal_work.lanes[k] + tangential_work.lanes[k];
            relax_rolling(swept_, factor_, *rows[k], change_);
        }
    }

    const SweptRows swept_;
    double factor_ = 0.0;
    SweepChange change_;
    RowChange<Quad> most_;
    std::array<ContactConstraint*, kLookAhead + kQuad> work_;  // rows that are not idle, and not solved yet
    std::size_t count_ = 0;
};

[[gnu::target("avx2")]] SweepChange sweep_avx2(const SweptRows& swept, double factor) {
    return QuadSweep(swept, factor).run();
}

/// Uses twice as many registers of the same size, which makes it a tenth faster.
[[gnu::target("avx512vl")]] SweepChange sweep_avx512(const SweptRows& swept, double factor) {
    return QuadSweep(swept, factor).run();
}

[[gnu::target("avx2")]] void go_on_avx2(std::span<SolverState> states, std::span<SolverState> last, double factor) {
    for (std::size_t i = 0; i < states.size(); ++i) {
        for (std::size_t part = 0; part < 2; ++part) {  // inverse masses are constant, so this step keeps them
            const Quad now = load_quad(part_of(&states[i], part));
            const Quad before = load_quad(part_of(&last[i], part));
            store(now + factor * (now - before), part_of(&states[i], part));
            store(now, part_of(&last[i], part));
        }
    }
}

#endif

}  // namespace

SweepChange sweep_rows(const SweptRows& swept, double factor, VectorUnit unit) {
#if defined(__x86_64__)
    if (unit == VectorUnit::avx512) return sweep_avx512(swept, factor);
    if (unit == VectorUnit::avx2) return sweep_avx2(swept, factor);
#endif
    static_cast<void>(unit);
    SweepChange change;
    for (ContactConstraint& row : swept.rows) {
        if (!is_idle(swept, row)) relax_one(swept, factor, row, change);
    }
    return change;
}

void go_on(std::span<SolverState> states, std::span<SolverState> last, double factor, VectorUnit unit) {
    if (factor == 0.0) {
        std::copy(states.begin(), states.end(), last.begin());
        return;
    }
#if defined(__x86_64__)
    if (unit != VectorUnit::baseline) {
        go_on_avx2(states, last, factor);
        return;
    }
#endif
    static_cast<void>(unit);
    for (std::size_t i = 0; i < states.size(); ++i) {
        const SolverState now = states[i];
        states[i].velocity += factor * (now.velocity - last[i].velocity);
        states[i].turning += factor * (now.turning - last[i].turning);
        last[i] = now;
    }
}

}  // namespace ricochet
