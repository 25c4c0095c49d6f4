/// \file
/// Look-ahead: how long a particle may continue along its path before any surface comes near, and the triangles that
/// then come near.
///
/// The results affect speed only. A particle whose path is certainly free needs no query. Its state after the step is
/// the end of the path, with or without a query.
#pragma once

#include <optional>

#include "ricochet/collision/broad_phase.h"
#include "ricochet/core/box3.h"
#include "ricochet/geometry/acceleration/distance_field.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/geometry/sweep/point_sweep.h"

namespace ricochet {

// Times for which a path certainly stays clear of a plane, a box, or the triangles of a distance field.

/// Returns the beginning of a path, up to `duration`, in s.
[[nodiscard]] Path shortened(const Path& path, double duration);

/// Returns the time, in s, until which every point of the path is certainly farther than `margin` from the plane. It is
/// at most the path's duration. The result may be too short, never too long.
[[nodiscard]] double time_free_of_plane(const Path& path, const Plane& plane, double margin);

/// Returns the time, in s, for which the path certainly stays beyond one of the box's faces. It is at most the path's
/// duration, and 0 if the path begins inside. The result may be too short, never too long.
[[nodiscard]] double time_outside(const Path& path, const Box3& box);

/// Returns the time, in s, until which the path, from time `from` on, is certainly farther than `margin`, in m, from
/// the triangles of the distance field. It is at most the path's duration, and `from` if the field gives no bound.
/// Method: sphere tracing (J. C. Hart, The Visual Computer 12, 1996).
[[nodiscard]] double time_clear_of_field(const Path& path, const DistanceField& field, double margin, double from);

/// Returns a time, in s, after which a straight path certainly stays out of the box. It is at most the path's duration,
/// and 0 if the path never comes near the box. Returns the duration for curved paths.
[[nodiscard]] double time_of_leaving(const Path& path, const Box3& box);

/// Path of a particle beyond the path of a query, as long as it is in free flight.
struct LookAhead {
    Path path;  ///< a line or parabola that begins with the query's path
    /// Clearance, in m, > 0. Surfaces must stay farther away than the radius plus this margin, except surfaces left
    /// behind. It covers the distance from `path` of three curves: the true trajectory, the query's path and the chords
    /// of the steps.
    double margin = 0.0;
    double least = 0.0;   ///< in s along the path, one step; a shorter free time is not worth the cost
    double beyond = 0.0;  ///< in s; triangles that come near within this time after the free time are also found
    /// Part of the margin, in m, by which the true trajectory may deviate from `path`, because forces vary. 0: the path
    /// is known.
    double deviation = 0.0;
};

/// Result of a look-ahead. Times are in s along the look-ahead's path.
struct LookAheadResult {
    /// Time until which no surface is nearer to the path than the radius plus the margin. Surfaces that a sphere has
    /// left behind are ignored. The time is at most the query's duration if looking ahead is not worth the cost.
    double free_until = 0.0;
    /// Triangles, other than those left behind, that come near between the end of the query's path and
    /// candidates_until. The time candidates_until is at most `beyond` later than free_until.
    ContactCandidates candidates = {};
    double candidates_until = 0.0;
};

/// Result of a look-ahead, and the tests that remain.
struct LookAheadOutcome {
    LookAheadResult result;
    /// The set of triangles tested against the query's own path. If empty, the triangles still have to be tested, and
    /// nothing is known beyond the path.
    std::optional<CandidateSet> tested;
};

/// Looks ahead, and passes the triangles near the query's own path to the narrow phase. `narrow_phase` must have tested
/// planes and shapes without a hit.
[[nodiscard]] LookAheadOutcome test_triangles_and_look_ahead(const CollisionWorld& world, const QueryMargins& margins,
                                                             const Path& path, const LookAhead& ahead,
                                                             NarrowPhase& narrow_phase, ContactScratch& scratch);

}  // namespace ricochet
