/// \file
/// Theoretical error bounds of the balances. No bound is fitted to results of runs.
#pragma once

#include "simulation/books.h"

namespace ricochet::test {

/// Bounds of one run.
struct BookBounds {
    double momentum = 0.0;  ///< N s
    double energy = 0.0;    ///< J, in both directions
    double launched = 0.0;  ///< J, extra launch energy of fragments
    double lost = 0.0;      ///< J, removed together with springs
};

[[nodiscard]] BookBounds bounds_of(const BookCase& c, const BookedRun& run);

}  // namespace ricochet::test
