/// \file
/// Random vectors for tests, drawn in a fixed order. The order needs care, because compilers evaluate the operands of
/// an expression in different orders. The same seed would then give different cases.
#pragma once

#include "ricochet/core/random.h"
#include "ricochet/core/vec3.h"

namespace ricochet::testing {

/// A direction and its factor. Braced initialisation draws the direction first.
struct ScaledDirection {
    Vec3 direction;
    double by = 1.0;
};

[[nodiscard]] inline Vec3 scaled(const ScaledDirection& drawn) { return drawn.by * drawn.direction; }

/// Returns a vector of random direction and of random length from 0 to `longest`.
[[nodiscard]] inline Vec3 random_vector(RandomSequence& random, double longest) {
    return scaled({random.unit_vector(), longest * random.uniform()});
}

}  // namespace ricochet::testing
