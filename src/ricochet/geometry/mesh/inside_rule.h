/// \file
/// How nested and overlapping shells of a closed mesh count.
#pragma once

#include <cstdint>

namespace ricochet {

/// The rules under which a point is inside. They agree for one shell, and for shells apart from each other.
enum class InsideRule : std::uint8_t {
    /// An odd number of shells encloses the point. A shell within another is a hole, whatever its winding, and the
    /// overlap of two shells is outside.
    parity,
    /// The winding number of the point is not 0. Shells that are wound alike are joined, overlaps included. A shell
    /// within
    /// another is a hole if it is wound against it. The mesh must be wound consistently.
    winding,
};

}  // namespace ricochet
