/// \file
/// First contact of two spheres that move along polynomial paths.
#pragma once

#include <optional>

#include "ricochet/core/box3.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// A piece of a path that a centre follows from `begin` to `end`, in s. At `begin` the centre is at the path's start.
struct TimedPath {
    const Path* path = nullptr;
    double begin = 0.0;
    double end = 0.0;  ///< at most `begin` plus the path's duration
};

/// Returns the first time, in s, at which the distance of the centres equals `distance` (m, > 0) and decreases. The
/// search covers the interval that both paths have in common. Spheres that overlap at the start of the interval are in
/// contact at once if they approach faster than `slow`, in m/s. Slower spheres must separate first and touch again.
/// Returns nullopt if there is no contact in the interval.
///
/// Under a common acceleration, the relative motion is a straight line. The time is then the smaller root of a
/// quadratic, computed as c / (-b + sqrt(b^2 - a c)) with c to 100 bits. For other paths the time is the first root of
/// a polynomial of degree 6. The root is bracketed (polynomial.h).
[[nodiscard]] std::optional<double> first_meeting(const TimedPath& a, const TimedPath& b, double distance, double slow);

/// Returns a box that contains the path from its start to time s, in s.
[[nodiscard]] Box3 box_of(const Path& path, double s);

}  // namespace ricochet
