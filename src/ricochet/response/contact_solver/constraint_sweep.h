/// \file
/// One sweep over rows, with the fastest instructions of the processor.
#pragma once

#include <span>

#include "ricochet/core/vector_unit.h"
#include "ricochet/response/contact_solver/contact_constraints.h"

namespace ricochet {

/// Rows, and the data that they refer to.
struct SweptRows {
    std::span<ContactConstraint> rows;
    std::span<RollingConstraint> rolling;
    std::span<SolverState> states;
};

/// Solves each row that is not idle, after a momentum step of `factor` times its last change. With the baseline unit
/// rows are solved one by one, else four at once: then no two rows may share a body that is not fixed.
[[nodiscard]] SweepChange sweep_rows(const SweptRows& swept, double factor, VectorUnit unit);

/// Applies the momentum step to bodies: `factor` times their change since `last`, which then gets their states before.
void go_on(std::span<SolverState> states, std::span<SolverState> last, double factor, VectorUnit unit);

}  // namespace ricochet
