/// \file
/// Private to the solver of contact networks: the rows of a network, each once.
#pragma once

#include <span>

#include "ricochet/response/network/network_rows.h"

namespace ricochet {

/// Rows, and all that they refer to.
struct SweptRows {
    std::span<NetworkRow> rows;
    std::span<RollingRow> rolling;
    std::span<NetworkState> states;
};

/// Relaxes the rows one after the other, after they have gone on by a factor of what the last sweep and the momentum
/// before it have changed.
[[nodiscard]] SweepChange sweep_in_order(const SweptRows& swept, double factor);

/// The same, with the same bits, of rows no two of which have a body that moves in common: four at a time where the
/// processor can (AVX2).
[[nodiscard]] SweepChange sweep_apart(const SweptRows& swept, double factor);

}  // namespace ricochet
