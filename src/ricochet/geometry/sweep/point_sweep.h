/// \file
/// Sweep of a point against one surface: does its path cross, when first, and from which side? Pure functions.
///
/// Straight paths are decided exactly, by the segment between their stored ends. Curved paths are decided by the signs
/// of exact orientations at points of the path; only the time is a rounded root. An arc that slips between two
/// triangles by rounding is caught by the certificate of its chords.
#pragma once

#include <limits>
#include <optional>

#include "ricochet/geometry/predicates/triangle_plane.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// A plane through a point. The stored double values are the plane: the predicates use them without rounding.
struct Plane {
    Vec3 point;
    Vec3 normal;  ///< of unit length up to rounding
};

/// First crossing of a path through a surface.
struct Crossing {
    double time = 0.0;  ///< s, in [0, duration]
    int side = 0;  ///< side of the surface's plane that the path comes from: +1, -1, or 0 when it runs in the plane
};

/// Side of a point: +1 where the normal points to, -1 behind, 0 exactly in the plane. Exact.
[[nodiscard]] int side_of(const Plane& plane, const Vec3& p);

/// Culls: true when the path, everything within `slack` metres of it and its chords stay strictly on one side of the
/// triangle's plane. Errs on the side of false.
[[nodiscard]] bool stays_on_one_side(const Path& path, const TrianglePlane& triangle, double slack);
[[nodiscard]] bool stays_on_one_side(const Path& path, const Plane& plane, double slack);

/// Culls: true where a point is farther from a plane than `distance` metres. Errs on the side of false.
[[nodiscard]] bool is_farther_than(const Plane& plane, const Vec3& p, double distance);

/// First crossing of the closed triangle (a, b, c), which must not be degenerate. For straight paths the time is within
/// 2 ulp of the exact rational; for curved ones it is a root of the height over the triangle's plane.
[[nodiscard]] std::optional<Crossing> first_crossing(const Path& path, const Vec3& a, const Vec3& b, const Vec3& c);
/// The same; nothing also when the crossing is certainly later than `latest`, s.
[[nodiscard]] std::optional<Crossing> first_crossing(const Path& path, const TrianglePlane& triangle,
                                                     double latest = std::numeric_limits<double>::infinity());
/// First crossing of a plane.
[[nodiscard]] std::optional<Crossing> first_crossing(const Path& path, const Plane& plane);

/// Time at which a path that runs along the plane of (a, b, c) leaves the triangle by more than `slack` metres, and by
/// more than the corners' rounding, in [0, duration]; 0 when it starts outside. `normal` is the triangle's unit normal,
/// of either sign.
[[nodiscard]] double triangle_exit_time(const Path& path, const Vec3& a, const Vec3& b, const Vec3& c,
                                        const Vec3& normal, double slack);

/// Signed distance of p from the plane of (a, b, c), m. Its relative error is a few ulp times the longest edge over the
/// height of the triangle, also where p almost lies in the plane (down to some 1e-30 of the sizes involved; orient3d
/// decides the exact side).
[[nodiscard]] double signed_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);
[[nodiscard]] double signed_distance(const Vec3& p, const Plane& plane);

}  // namespace ricochet
