/// \file
/// Space-time test: does a point that moves along a line at constant speed touch a triangle whose corners also move
/// along lines? The test uses the verifier's own arithmetic.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/verify/triangle_tests.h"

namespace ricochet::verify {

/// A straight path at constant speed.
struct StepPath {
    Vec3 from;
    Vec3 to;
};

/// Corners of a triangle at the start and at the end of the time interval. The triangle may have no area.
struct MovingCorners {
    Corners from;
    Corners to;
};

/// Returns true only if the moving point is proven not to touch the triangle at any time. The proof uses doubles if
/// their error bound leaves no doubt, otherwise numbers with up to a hundred digits. The result is false if point and
/// triangle touch, or are too close to decide.
[[nodiscard]] bool are_apart(const StepPath& point, const MovingCorners& triangle);

}  // namespace ricochet::verify
