/// \file
/// The parity oracle, which the library's own verifier also uses.
#pragma once

#include "ricochet/verify/parity.h"

namespace ricochet::testing {

using ricochet::count_open_edges;
using ricochet::ParityOracle;
using ricochet::Side;

}  // namespace ricochet::testing
