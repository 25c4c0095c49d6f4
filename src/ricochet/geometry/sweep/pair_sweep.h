/// \file
/// When two spheres that move along polynomial paths first meet.
#pragma once

#include <optional>

#include "ricochet/core/box3.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// A part of a path that a centre follows: from `begin`, at which it is at the path's start, until `end`, s.
struct TimedPath {
    const Path* path = nullptr;
    double begin = 0.0;
    double end = 0.0;  ///< at most the path's own duration later
};

/// The first time, s, in the interval that both have in common, at which the distance of the centres is `distance` (m,
/// > 0) and shrinks. Spheres that overlap at its begin meet at once where they approach faster than `slow`, m/s; else
/// when they have been apart and meet again. Nothing where that does not happen before the interval ends.
///
/// Under a common acceleration they move on a straight line relative to each other: the smaller root of a quadratic, as
/// c / (-b + sqrt(b^2 - a c)), with c to 100 bits. Other paths: the first root of a polynomial of degree 6, bracketed
/// (polynomial.h).
[[nodiscard]] std::optional<double> first_meeting(const TimedPath& a, const TimedPath& b, double distance, double slow);

/// A box that holds the path from its start to s, s.
[[nodiscard]] Box3 box_of(const Path& path, double s);

}  // namespace ricochet
