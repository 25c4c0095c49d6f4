/// \file
/// Private to the responses: what moves leave behind, besides the particle.
#pragma once

#include <vector>

#include "ricochet/response/response.h"

namespace ricochet {

/// What moves have left behind, besides the particle: the lists of MoveScratch.
struct MoveLists {
    std::vector<SurfaceHit> hits;
    std::vector<ContactRecord> records;
    std::vector<Segment> segments;
    std::vector<MotionPart> motions;
    std::vector<RecordedImpact> impacts;
    std::vector<ColliderLoad> loads;

    void clear();
    /// Takes what a move has left in the scratch memory.
    void take(MoveScratch& scratch);
    void append(const MoveLists& more);
};

/// Adds what a further move of the same particle has come to.
void add(MoveOutcome& sum, const MoveOutcome& next);

}  // namespace ricochet
