/// \file
/// Private to the iterative contact solver: one sweep over rows, with the fastest instructions of the processor.
#pragma once

#include <span>

#include "ricochet/response/network/network_rows.h"

namespace ricochet {

/// Rows, and the data that they refer to.
struct SweptRows {
    std::span<NetworkRow> rows;
    std::span<RollingRow> rolling;
    std::span<NetworkState> states;
};

/// Instruction set of a sweep. All give the same bits.
enum class SweepWay {
    one_by_one,
    avx2,   ///< four rows at once; no two rows may share a body that is not fixed
    avx512  ///< the same with twice as many registers
};

/// Returns the instruction sets that this processor has, the fastest last.
[[nodiscard]] std::span<const SweepWay> sweep_ways();

/// Solves each row that is not idle, after a momentum step of `factor` times its last change.
[[nodiscard]] SweepChange sweep_rows(const SweptRows& swept, double factor, SweepWay way);

/// Applies the momentum step to bodies: `factor` times their change since `last`. Then `last` holds their states before
/// this step.
void go_on(std::span<NetworkState> states, std::span<NetworkState> last, double factor, SweepWay way);

}  // namespace ricochet
