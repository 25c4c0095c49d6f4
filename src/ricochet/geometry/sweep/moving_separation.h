/// \file
/// Does a point or a sphere stay clear of a triangle whose corners move along straight lines at constant speed, and
/// when does it meet it first? Also beside triangles that turn, at gaps of rounding's size, where no one direction
/// separates them for long (moving_triangle.h).
///
/// Method: over a piece of the time, the height above the triangle's plane, the distance from the line of an edge with
/// the side of that edge, and the distance from a corner with the sides of both its edges are polynomials. One whose
/// coefficients in Bernstein's form are all of one sign has no root in the piece (G. Farin, "Curves and Surfaces for
/// CAGD", 5th ed., chapter 5). Their signs are certain: doubles with an error bound, then double-double. Pieces that
/// nothing proves free are halved.
#pragma once

#include <functional>
#include <optional>

#include "ricochet/geometry/sweep/moving_triangle.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// True only when the closed ball of that radius (0: the point) touches no point of the triangle at any time; false
/// where that could not be proved in kMostSeparationPieces pieces, which says nothing. Coordinates: finite, at most
/// 1e75.
[[nodiscard]] bool stay_apart(const MovingPoint& point, double radius, const MovingTriangle& triangle);

/// True only when something on the path stays so clear of the triangle, which moves meanwhile: by one direction, that
/// from the triangle to the path in the middle, in doubles alone. False says nothing; most that pass beside a triangle
/// are proved to, at a tenth of what the others here cost.
[[nodiscard]] bool pass_along_direction(const Path& path, double radius, const MovingTriangle& triangle);

/// Where something on a path may touch a triangle: to rounding where it does.
struct Meeting {
    double part = 0.0;  ///< time, as a part of the path's duration
    int side = 0;       ///< of the triangle's plane that a point is on before: +1 where the normal points to
};

/// Finds the first meeting of a point (radius 0) or a sphere on the path with the triangle, which moves meanwhile, of
/// those from a part of the time on for which counts(meeting) is true. Nothing where there is none. A sphere does not
/// touch it at the beginning.
[[nodiscard]] std::optional<Meeting> first_meeting(const Path& path, double radius, const MovingTriangle& triangle,
                                                   double from, const std::function<bool(const Meeting&)>& counts);

}  // namespace ricochet
