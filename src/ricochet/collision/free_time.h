/// \file
/// How long a path certainly stays clear of a plane, a box, or the triangles of a distance field.
#pragma once

#include "ricochet/core/box3.h"
#include "ricochet/geometry/acceleration/distance_field.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/geometry/sweep/point_sweep.h"

namespace ricochet {

/// The beginning of a path.
[[nodiscard]] Path shortened(const Path& path, double duration);

/// The time until which every point of the path is certainly further than `margin` from the plane, s, at most its
/// duration. Errs on the side of less.
[[nodiscard]] double time_free_of_plane(const Path& path, const Plane& plane, double margin);

/// The time for which the path certainly stays beyond one of the box's faces, s, at most its duration; 0 when it begins
/// inside. Errs on the side of less.
[[nodiscard]] double time_outside(const Path& path, const Box3& box);

/// The time until which every point of the path from `from` on is certainly further than `margin` from the triangles of
/// the distance field, s, at most its duration; `from` where the field cannot tell. Method: sphere tracing (J. C. Hart,
/// The Visual Computer 12, 1996). For paths of degree 1 or 2.
[[nodiscard]] double time_clear_of_field(const Path& path, const DistanceField& field, double margin, double from);

/// A time after which the path certainly stays out of the box, s, at most its duration; 0 when it never comes near it.
/// For straight paths; others: their duration.
[[nodiscard]] double time_of_leaving(const Path& path, const Box3& box);

}  // namespace ricochet
