/// \file
/// How far books may be open, from theory: nothing here is fitted to what runs give.
#pragma once

#include "simulation/books.h"

namespace ricochet::test {

/// Of one run.
struct BookBounds {
    double momentum = 0.0;  ///< N s
    double energy = 0.0;    ///< J, to either side
    double launched = 0.0;  ///< J, that fragments may have got besides
    double lost = 0.0;      ///< J, that springs may have taken with them
};

[[nodiscard]] BookBounds bounds_of(const BookCase& c, const BookedRun& run);

}  // namespace ricochet::test
