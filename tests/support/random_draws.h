/// \file
/// Random vectors for tests, with their draws in a fixed order: compilers evaluate the operands of one expression in
/// different orders, and the same seed would be a different case.
#pragma once

#include "ricochet/core/random.h"
#include "ricochet/core/vec3.h"

namespace ricochet::testing {

/// A direction, and what it is multiplied by; in braces, they are drawn in this order.
struct ScaledDirection {
    Vec3 direction;
    double by = 1.0;
};

[[nodiscard]] inline Vec3 scaled(const ScaledDirection& drawn) { return drawn.by * drawn.direction; }

/// Any direction, any length up to the longest.
[[nodiscard]] inline Vec3 random_vector(RandomSequence& random, double longest) {
    return scaled({random.unit_vector(), longest * random.uniform()});
}

}  // namespace ricochet::testing
