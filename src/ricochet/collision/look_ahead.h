/// \file
/// Looking ahead: how long may a particle go on as foreseen before any surface comes near its way?
///
/// What is found serves speed only. A particle whose way is certainly free needs no search, and its state after the
/// step is what the search would have left: the end of the same path.
#pragma once

#include "ricochet/core/box3.h"
#include "ricochet/geometry/acceleration/distance_field.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/geometry/sweep/point_sweep.h"

namespace ricochet {

/// Where a particle is going beyond the path that is searched, if nothing stands in its way.
struct LookAhead {
    Path path;            ///< a line or parabola that begins with the searched path
    double margin = 0.0;  ///< m, > 0: nearer than the radius plus this nothing may come that is not left behind. It
                          ///< covers by how much the true way, the searched path too, and its chords of a step may lie
                          ///< beside `path`
    double least = 0.0;   ///< s along the path, a step: looking no further than this is not worth the while
    double beyond = 0.0;  ///< s: what comes near within this time after the free one is of interest too
};

/// The beginning of a path.
[[nodiscard]] Path shortened(const Path& path, double duration);

/// The time until which every point of the path is certainly further than `margin` from the plane, s, at most its
/// duration. Errs on the side of less.
[[nodiscard]] double time_free_of_plane(const Path& path, const Plane& plane, double margin);

/// The time for which the path certainly stays beyond one of the box's faces, s, at most its duration; 0 when it begins
/// inside. Errs on the side of less.
[[nodiscard]] double time_outside(const Path& path, const Box3& box);

/// The time until which every point of the path from `from` on is certainly further than `margin` from the triangles of
/// the grid, s, at most its duration; `from` where the grid cannot tell. For paths of degree 1 or 2.
[[nodiscard]] double time_clear_of_field(const Path& path, const DistanceField& grid, double margin, double from);

/// A time after which the path certainly stays out of the box, s, at most its duration; 0 when it never comes near it.
/// For straight paths; others: their duration.
[[nodiscard]] double time_of_leaving(const Path& path, const Box3& box);

}  // namespace ricochet
