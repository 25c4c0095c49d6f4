/// \file
/// Sweep of a point against one surface: whether its path crosses, at which time first, and from which side. Pure
/// functions.
///
/// Straight paths are decided exactly, by the segment between their stored ends. Curved paths are decided by the signs
/// of exact orientations at points of the path. Only the time is a rounded root. Rounding can let a curved path slip
/// between two triangles. The certificate of its chords catches this.
#pragma once

#include <limits>
#include <optional>

#include "ricochet/geometry/predicates/triangle_plane.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// A plane through a point. The stored doubles define the plane, and the predicates use them without rounding.
struct Plane {
    Vec3 point;
    Vec3 normal;  ///< of unit length up to rounding
};

/// First crossing of a path through a surface.
struct Crossing {
    double time = 0.0;  ///< in s, in [0, duration]
    int side = 0;       ///< side of the surface's plane that the path comes from: +1, -1, or 0 if it runs in the plane
};

/// Returns the side of a point: +1 on the side of the normal, -1 behind, 0 exactly in the plane. Exact.
[[nodiscard]] int side_of(const Plane& plane, const Vec3& p);

/// Returns true if the path, its chords and everything within `slack` metres of the path stay strictly on one side of
/// the triangle's plane. Used for culling. Errs on the side of false.
[[nodiscard]] bool stays_on_one_side(const Path& path, const TrianglePlane& triangle, double slack);
[[nodiscard]] bool stays_on_one_side(const Path& path, const Plane& plane, double slack);

/// Returns true if a point is farther from a plane than `distance` metres. Used for culling. Errs on the side of false.
[[nodiscard]] bool is_farther_than(const Plane& plane, const Vec3& p, double distance);

/// Returns the first crossing of the closed triangle (a, b, c), which must not be degenerate. For straight paths the
/// time is within 2 ulp of the exact rational. For curved ones it is a root of the height above the triangle's plane.
[[nodiscard]] std::optional<Crossing> first_crossing(const Path& path, const Vec3& a, const Vec3& b, const Vec3& c);
/// Returns the same crossing, but nullopt if it is certainly later than `latest`, in s.
[[nodiscard]] std::optional<Crossing> first_crossing(const Path& path, const TrianglePlane& triangle,
                                                     double latest = std::numeric_limits<double>::infinity());
/// Returns the first crossing of a plane.
[[nodiscard]] std::optional<Crossing> first_crossing(const Path& path, const Plane& plane);

/// Returns the time in [0, duration] at which a path along the plane of (a, b, c) leaves the triangle. It leaves if it
/// is outside by more than `slack` metres and by more than the corners' rounding. The time is 0 if the path starts
/// outside. `normal` is the triangle's unit normal, of either sign.
[[nodiscard]] double triangle_exit_time(const Path& path, const Vec3& a, const Vec3& b, const Vec3& c,
                                        const Vec3& normal, double slack);

/// Returns the signed distance of p from the plane of (a, b, c), in m. Its relative error is a few ulp times the
/// longest edge over the height of the triangle. This includes points almost in the plane, down to about 1e-30 of the
/// sizes involved. orient3d decides the exact side.
[[nodiscard]] double signed_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);
[[nodiscard]] double signed_distance(const Vec3& p, const Plane& plane);

}  // namespace ricochet
