/// \file
/// Looking ahead: for how long may a particle go on along its path before any surface comes near, and which triangles
/// are those?
///
/// What is found serves speed only. A particle whose path is certainly free needs no query, and its state after the
/// step is what a query would have left: the end of the same path.
#pragma once

#include <optional>

#include "ricochet/collision/broad_phase.h"

namespace ricochet {

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
