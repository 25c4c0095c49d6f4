/// \file
/// The broad phase: which triangles may a path come near? Embree proposes them, the narrow phase tests them.
#pragma once

#include "ricochet/collision/narrow_phase.h"

namespace ricochet {

/// m, how near to the path candidates may be: what its chords that covers_chord() accepts may intersect is among them.
[[nodiscard]] double broad_phase_margin(const Path& path, const QueryMargins& margins);

/// True when the triangles near the path include all that its chord from time `from` to `to` may intersect. Longer
/// chords of a curved path may run where the broad phase has not been queried.
[[nodiscard]] bool covers_chord(const CollisionWorld& world, const QueryMargins& margins, const Path& path, double from,
                                double to);

/// Which triangles were candidates of a path.
enum class CandidateSet {
    near,  ///< those that the broad phase proposed
    all,   ///< every one: the path is too curved or too long for the boxes, or culling is off
};

/// Has the narrow phase test every triangle that the path may come near, in the order of time, up to the first contact.
/// How the path is cut serves the boxes only: every triangle is tested against the whole path.
[[nodiscard]] CandidateSet test_triangles_near(const CollisionWorld& world, const QueryMargins& margins,
                                               const Path& path, NarrowPhase& narrow_phase);

/// The time for which no surface of the world comes near the path, s, at most its duration: a query of what the path
/// does until then finds no surface, and no chord that covers_chord() accepts intersects one. Errs on the side of less;
/// 0 where it is less than `least`, s.
[[nodiscard]] double time_clear_of(const CollisionWorld& world, const QueryMargins& margins, const Path& path,
                                   double least);

}  // namespace ricochet
