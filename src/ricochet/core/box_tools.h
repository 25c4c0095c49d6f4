/// \file
/// Private to the library: common operations on boxes.
#pragma once

#include "ricochet/core/box3.h"

namespace ricochet {

/// Returns the axis of the largest component; of equal components, the first one.
[[nodiscard]] inline int longest_axis(const Vec3& size) {
    if (size.x >= size.y && size.x >= size.z) return 0;
    return size.y >= size.z ? 1 : 2;
}

/// Returns the box around points and boxes.
template <class... Parts>
[[nodiscard]] Box3 box_around(const Parts&... parts) {
    Box3 box;
    (box.include(parts), ...);
    return box;
}

/// Returns a box that is larger by a margin, in m, on every side.
[[nodiscard]] inline Box3 grown(const Box3& box, double margin) {
    const Vec3 by{margin, margin, margin};
    return {box.lower - by, box.upper + by};
}

/// Returns the box around a ball.
[[nodiscard]] inline Box3 ball_box(const Vec3& center, double radius) { return grown({center, center}, radius); }

/// Returns true if the boxes have a point in common. Uses no branches, because the processor cannot predict which
/// comparison fails first.
[[nodiscard]] inline bool overlap(const Box3& a, const Box3& b) {
    return static_cast<bool>(
        static_cast<unsigned>(a.lower.x <= b.upper.x) & static_cast<unsigned>(b.lower.x <= a.upper.x) &
        static_cast<unsigned>(a.lower.y <= b.upper.y) & static_cast<unsigned>(b.lower.y <= a.upper.y) &
        static_cast<unsigned>(a.lower.z <= b.upper.z) & static_cast<unsigned>(b.lower.z <= a.upper.z));
}

}  // namespace ricochet
