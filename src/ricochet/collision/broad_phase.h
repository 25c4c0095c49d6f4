/// \file
/// The broad phase finds the triangles that a path may come near. Embree proposes them; the narrow phase tests them.
#pragma once

#include "ricochet/collision/narrow_phase.h"

namespace ricochet {

/// Returns the distance from the path, in m, within which triangles are candidates. The candidates include every
/// triangle that a chord accepted by covers_chord() may intersect. The distance does not apply if the boxes do not
/// hold (QueryMargins::boxes_hold): every triangle is a candidate then.
[[nodiscard]] double broad_phase_margin(const Path& path, const QueryMargins& margins);

/// Returns true if the candidates of the path include all triangles that its chord from time `from` to `to` may
/// intersect. Longer chords of a curved path may cross space that the broad phase has not queried.
[[nodiscard]] bool covers_chord(const CollisionWorld& world, const QueryMargins& margins, const Path& path, double from,
                                double to);

/// Triangles that were candidates of a path.
enum class CandidateSet {
    near,  ///< triangles that the broad phase proposed
    all,   ///< all triangles: the path is too curved or too long for the boxes
};

/// Passes to the narrow phase every triangle that the path may come near, in the order of time, up to the first
/// contact. The path is divided for the boxes only: the narrow phase tests every triangle against the whole path.
[[nodiscard]] CandidateSet test_triangles_near(const CollisionWorld& world, const QueryMargins& margins,
                                               const Path& path, NarrowPhase& narrow_phase);

/// Returns the time, in s, for which no surface of the world comes near the path; at most the path's duration. A query
/// of the path up to then finds no surface, and no chord accepted by covers_chord() intersects one. The result may be
/// too short, never too long. Returns 0 if it is less than `least`, in s.
[[nodiscard]] double time_clear_of(const CollisionWorld& world, const QueryMargins& margins, const Path& path,
                                   double least);

}  // namespace ricochet
