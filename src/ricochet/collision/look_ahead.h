/// \file
/// Looking ahead: for how long may a particle go on along its path before any surface comes near, and which triangles
/// are those?
///
/// What is found serves speed only. A particle whose path is certainly free needs no query, and its state after the
/// step is what a query would have left: the end of the same path.
#pragma once

#include <optional>

#include "ricochet/collision/broad_phase.h"
#include "ricochet/core/box3.h"
#include "ricochet/geometry/acceleration/distance_field.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/geometry/sweep/point_sweep.h"

namespace ricochet {

// How long a path certainly stays clear of a plane, a box, or the triangles of a distance field.

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
/// The Visual Computer 12, 1996).
[[nodiscard]] double time_clear_of_field(const Path& path, const DistanceField& field, double margin, double from);

/// A time after which the path certainly stays out of the box, s, at most its duration; 0 when it never comes near it.
/// For straight paths; others: their duration.
[[nodiscard]] double time_of_leaving(const Path& path, const Box3& box);

/// Where a particle goes beyond the path of a query as long as it is in free flight.
struct LookAhead {
    Path path;            ///< a line or parabola that begins with the query's path
    double margin = 0.0;  ///< m, > 0: nothing may come nearer than the radius plus this but what is left behind. It
                          ///< covers by how much the true trajectory, the query's path too, and its chords of a step
                          ///< may lie beside `path`
    double least = 0.0;   ///< s along the path, a step: less free time than this is not worth the work
    double beyond = 0.0;  ///< s: what comes near within this time after the free time is of interest too
};

/// Times are s along the look-ahead's path.
struct LookAheadResult {
    /// Until then no surface is nearer to the path than the radius plus the margin, but for those that a sphere leaves
    /// behind for good. At most the query's duration where looking ahead is not worth the work.
    double free_until = 0.0;
    /// The triangles, other than those left behind, that come near between the end of the query's path and
    /// candidates_until, which is at most `beyond` after free_until.
    ContactCandidates candidates = {};
    double candidates_until = 0.0;
};

/// What looking ahead has found, and what it has left to be done.
struct LookAheadOutcome {
    LookAheadResult result;
    /// The triangles that have been tested against the query's own path; nothing: they still have to be tested, and
    /// nothing is known of what comes after the path.
    std::optional<CandidateSet> tested;
};

/// Looks ahead, and on the way has the narrow phase test the triangles near the query's own path. narrow_phase has
/// tested planes and shapes, and none is hit.
[[nodiscard]] LookAheadOutcome look_ahead(const CollisionWorld& world, const QueryMargins& margins, const Path& path,
                                          const LookAhead& ahead, NarrowPhase& narrow_phase, ContactScratch& scratch);

}  // namespace ricochet
