/// \file
/// Rules for nested and overlapping shells of a closed mesh.
#pragma once

#include <cstdint>

namespace ricochet {

/// Rules that define the points inside a mesh. Both rules give the same result for one shell and for disjoint shells.
enum class InsideRule : std::uint8_t {
    /// A point is inside if an odd number of shells encloses it. A shell within another is a hole for any winding, and
    /// the overlap of two shells is outside.
    parity,
    /// A point is inside if its winding number is not 0. Shells with the same winding are joined, including their
    /// overlaps. A shell within another is a hole if it has the opposite winding. The mesh must be wound consistently.
    winding,
};

}  // namespace ricochet
