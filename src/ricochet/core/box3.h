/// \file
/// Axis-aligned box.
#pragma once

#include <limits>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Closed axis-aligned box; empty (lower > upper) when default-constructed.
struct Box3 {
    Vec3 lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
               std::numeric_limits<double>::infinity()};
    Vec3 upper{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
               -std::numeric_limits<double>::infinity()};

    void include(const Vec3& p) {
        lower = min(lower, p);
        upper = max(upper, p);
    }
    void include(const Box3& b) {
        lower = min(lower, b.lower);
        upper = max(upper, b.upper);
    }
    [[nodiscard]] bool empty() const { return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z; }
    [[nodiscard]] bool contains(const Vec3& p) const {
        return p.x >= lower.x && p.x <= upper.x && p.y >= lower.y && p.y <= upper.y && p.z >= lower.z && p.z <= upper.z;
    }
    [[nodiscard]] Vec3 center() const { return 0.5 * lower + 0.5 * upper; }
    [[nodiscard]] Vec3 size() const { return upper - lower; }
    /// Length of the space diagonal; 0 when empty.
    [[nodiscard]] double diagonal() const { return empty() ? 0.0 : length(size()); }
};

}  // namespace ricochet
