/// \file
/// The verifier's own operations on boxes. Private to the verifier.
#pragma once

#include "ricochet/core/box3.h"

namespace ricochet::verify {

/// Returns the box around points and boxes.
template <class... Parts>
[[nodiscard]] Box3 enclosing(const Parts&... parts) {
    Box3 box;
    (box.include(parts), ...);
    return box;
}

/// Returns a box that is larger by a margin, in m, on every side.
[[nodiscard]] inline Box3 widened(const Box3& box, double margin) {
    const Vec3 by{margin, margin, margin};
    return {box.lower - by, box.upper + by};
}

/// Returns true if the boxes have a point in common. The code has no branches, because they would often be
/// mispredicted.
[[nodiscard]] inline bool meet(const Box3& a, const Box3& b) {
    const bool x = (a.lower.x <= b.upper.x) & (b.lower.x <= a.upper.x);
    const bool y = (a.lower.y <= b.upper.y) & (b.lower.y <= a.upper.y);
    const bool z = (a.lower.z <= b.upper.z) & (b.lower.z <= a.upper.z);
    return x & y & z;
}

}  // namespace ricochet::verify
