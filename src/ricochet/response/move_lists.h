/// \file
/// Private to the responses: lists of the records that moves produce.
#pragma once

#include <vector>

#include "ricochet/response/response.h"

namespace ricochet {

/// Records that moves produce: the lists of MoveScratch.
struct MoveLists {
    std::vector<SurfaceHit> hits;
    std::vector<ContactRecord> records;
    std::vector<Segment> segments;
    std::vector<MotionPart> motions;
    std::vector<RecordedImpact> impacts;
    std::vector<ColliderLoad> loads;

    void clear();
    /// Moves the records of a move out of the scratch memory.
    void take(MoveScratch& scratch);
    void append(const MoveLists& more);
};

/// Adds the outcome of a further move of the same particle.
void add(MoveOutcome& sum, const MoveOutcome& next);

}  // namespace ricochet
