/// \file
/// Does a point that moves along a line, at constant speed, touch a triangle whose corners do so? With the verifier's
/// own arithmetic.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/verify/triangle_tests.h"

namespace ricochet::verify {

/// A straight way in a time.
struct Way {
    Vec3 from;
    Vec3 to;
};

/// A triangle, which may have no area, at the begin and at the end of that time.
struct MovingCorners {
    Corners from;
    Corners to;
};

/// True only when they have no point in common at any time; proved with doubles where their error bound leaves no
/// doubt, with a hundred digits otherwise. What touches, or comes nearer than that can tell, is not apart.
[[nodiscard]] bool are_apart(const Way& point, const MovingCorners& triangle);

}  // namespace ricochet::verify
