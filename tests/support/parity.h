/// \file
/// Declares the parity oracle for tests. The library's verifier uses the same oracle.
#pragma once

#include "ricochet/verify/parity.h"

namespace ricochet::testing {

using ricochet::count_open_edges;
using ricochet::ParityOracle;
using ricochet::Side;

}  // namespace ricochet::testing
