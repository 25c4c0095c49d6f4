/// \file
/// Space-time test: does a point that moves along a line at constant speed touch a triangle whose corners move
/// likewise? It uses the verifier's own arithmetic.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/verify/triangle_tests.h"

namespace ricochet::verify {

/// A straight path at constant speed.
struct StepPath {
    Vec3 from;
    Vec3 to;
};

/// A triangle at the start and at the end of the same time interval. It may have no area.
struct MovingCorners {
    Corners from;
    Corners to;
};

/// Returns true only if point and triangle have no common point at any time. The proof uses doubles if their error
/// bound leaves no doubt, otherwise a hundred digits. The result is false if they touch, or are too close to decide.
[[nodiscard]] bool are_apart(const StepPath& point, const MovingCorners& triangle);

}  // namespace ricochet::verify
