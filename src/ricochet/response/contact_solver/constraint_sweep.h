/// \file
/// Private to the solver of contact networks: all rows once, as fast as the processor can.
#pragma once

#include <span>

#include "ricochet/response/contact_solver/contact_constraints.h"

namespace ricochet {

/// Rows, and all that they refer to.
struct SweptRows {
    std::span<ContactConstraint> rows;
    std::span<RollingConstraint> rolling;
    std::span<SolverState> states;
};

/// How it is done. All ways lead to the same bits.
enum class SweepVariant {
    one_by_one,
    avx2,   ///< four at once: no two of the rows may have a body that moves in common
    avx512  ///< the same, with twice as many registers
};

/// Those that this processor can; the fastest is the last.
[[nodiscard]] std::span<const SweepVariant> sweep_variants();

/// Relaxes each row that is not idle, after it has gone on by a factor of what the last sweep and the momentum before
/// it have changed.
[[nodiscard]] SweepChange sweep_rows(const SweptRows& swept, double factor, SweepVariant variant);

/// Bodies go on by a factor of how they have changed since they were `last`, which is what they were before from now
/// on.
void go_on(std::span<SolverState> states, std::span<SolverState> last, double factor, SweepVariant variant);

}  // namespace ricochet
