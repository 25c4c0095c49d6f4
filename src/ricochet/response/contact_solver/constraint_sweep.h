/// \file
/// One sweep over rows, with the fastest instructions of the processor.
#pragma once

#include <span>

#include "ricochet/response/contact_solver/contact_constraints.h"

namespace ricochet {

/// Rows, and the data that they refer to.
struct SweptRows {
    std::span<ContactConstraint> rows;
    std::span<RollingConstraint> rolling;
    std::span<SolverState> states;
};

/// Instruction set of a sweep. All give bit-identical results.
enum class SweepVariant {
    one_by_one,
    avx2,   ///< four rows at once; no two rows may share a body that is not fixed
    avx512  ///< four rows at once, with twice as many registers
};

/// Returns the instruction sets that this processor has, the fastest last.
[[nodiscard]] std::span<const SweepVariant> sweep_variants();

/// Solves each row that is not idle, after a momentum step of `factor` times its last change.
[[nodiscard]] SweepChange sweep_rows(const SweptRows& swept, double factor, SweepVariant variant);

/// Applies the momentum step to bodies: `factor` times their change since `last`, which then gets their states before.
void go_on(std::span<SolverState> states, std::span<SolverState> last, double factor, SweepVariant variant);

}  // namespace ricochet
