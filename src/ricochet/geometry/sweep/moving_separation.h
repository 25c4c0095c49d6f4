/// \file
/// Tests whether a point or a sphere stays clear of a moving triangle, and finds the first contact. The corners move
/// along straight lines at constant speed. The tests also cover rotating triangles at gaps near rounding size. At such
/// gaps no single direction separates the bodies for long (moving_triangle.h).
///
/// Method: over an interval of time, three quantities are polynomials:
/// - The height above the triangle's plane.
/// - The distance from the line of an edge, with the side of that edge.
/// - The distance from a corner, with the sides of both its edges.
///
/// A polynomial with Bernstein coefficients of one sign has no root in the interval (G. Farin, "Curves and Surfaces for
/// CAGD", 5th ed., chapter 5). The signs are certain: they are computed in doubles with an error bound and, if
/// undecided, in double-double. An interval that no test proves free is halved.
#pragma once

#include <functional>
#include <optional>

#include "ricochet/geometry/sweep/moving_triangle.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Returns true only if the closed ball of the given radius (0: the point) never touches the triangle. False is
/// inconclusive: kMostSeparationPieces intervals did not suffice for a proof. Coordinates must be finite and at most
/// 1e75.
[[nodiscard]] bool stay_apart(const MovingPoint& point, double radius, const MovingTriangle& triangle);

/// Returns true only if the ball on the path never touches the moving triangle. The test uses a single direction in
/// plain doubles: from the triangle to the path at mid-time. False is inconclusive. The test proves the separation of
/// most paths beside a triangle, at a tenth of the cost of the other tests.
[[nodiscard]] bool pass_along_direction(const Path& path, double radius, const MovingTriangle& triangle);

/// A possible contact, up to rounding, of a point or sphere on a path with a triangle.
struct PossibleContact {
    double part = 0.0;  ///< time, as a fraction of the path's duration
    int side = 0;       ///< side of the triangle's plane from which a point comes: +1 is the normal's side
};

/// Finds the first contact of a point (radius 0) or a sphere on the path with the moving triangle. Ignores contacts
/// before the fraction `from` of the duration, and contacts for which counts(contact) is false. Returns nullopt if
/// there is no other contact. A sphere must not touch the triangle at the start.
[[nodiscard]] std::optional<PossibleContact> first_possible_contact(
    const Path& path, double radius, const MovingTriangle& triangle, double from,
    const std::function<bool(const PossibleContact&)>& counts);

}  // namespace ricochet
