/// \file
/// Sweep of a point against one surface. It finds whether the path crosses the surface, the first time of crossing, and
/// the side from which the path comes. Pure functions.
///
/// For straight paths, an exact test of the segment between the stored ends decides. For curved paths, the signs of
/// exact orientations at points of the path decide. Only the time is a rounded root. By rounding, the sweep of a curved
/// path can miss two adjacent triangles at their seam. The certificate of the path's chords detects this.
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
    int side = 0;       ///< side of the plane from which the path comes: +1, -1, or 0 for a path in the plane
};

/// Returns the side of a point: +1 on the side of the normal, -1 behind, 0 exactly in the plane. Exact.
[[nodiscard]] int side_of(const Plane& plane, const Vec3& p);

/// Returns true if the path, its chords and all points within `slack` metres of the path are strictly on one side of
/// the triangle's plane. Used for culling. Returns false if undecided.
[[nodiscard]] bool stays_on_one_side(const Path& path, const TrianglePlane& triangle, double slack);
[[nodiscard]] bool stays_on_one_side(const Path& path, const Plane& plane, double slack);

/// Returns true if a point is farther from a plane than `distance` metres. Used for culling. Returns false if
/// undecided.
[[nodiscard]] bool is_farther_than(const Plane& plane, const Vec3& p, double distance);

/// Returns the first crossing of the closed triangle (a, b, c), which must not be degenerate. For straight paths the
/// time is within 2 ulp of the exact value. For curved paths it is a root of the height above the triangle's plane.
[[nodiscard]] std::optional<Crossing> first_crossing(const Path& path, const Vec3& a, const Vec3& b, const Vec3& c);
/// Returns the first crossing of a triangle, or nullopt if the crossing is certainly later than `latest`, in s.
[[nodiscard]] std::optional<Crossing> first_crossing(const Path& path, const TrianglePlane& triangle,
                                                     double latest = std::numeric_limits<double>::infinity());
/// Returns the first crossing of a plane.
[[nodiscard]] std::optional<Crossing> first_crossing(const Path& path, const Plane& plane);

/// Returns the time in [0, duration] at which a path along the plane of (a, b, c) leaves the triangle. The path has
/// left if it is outside by more than `slack` metres and by more than the corners' rounding. The time is 0 if the path
/// starts outside. `normal` is the triangle's unit normal, of either sign.
[[nodiscard]] double triangle_exit_time(const Path& path, const Vec3& a, const Vec3& b, const Vec3& c,
                                        const Vec3& normal, double slack);

/// Returns the signed distance of p from the plane of (a, b, c), in m. Its relative error is a few ulp times the
/// longest edge divided by the height of the triangle. This is also true for points almost in the plane, down to about
/// 1e-30 of the sizes involved. The exact side is the result of orient3d.
[[nodiscard]] double signed_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);
[[nodiscard]] double signed_distance(const Vec3& p, const Plane& plane);

}  // namespace ricochet
