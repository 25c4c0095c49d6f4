/// \file
/// First-order motion: a flow carries the particles, x' = g(x, t), and walls stop them or let them slide.
///
/// The path of a step comes from flow_path(). Its first contact is found and resolved within the step, as in the exact
/// response. Every segment of the trajectory is certified to intersect no surface, so no particle passes through a
/// wall.
///
/// A sliding particle has the velocity closest to g that does not point into any touched surface. At most three
/// surfaces are considered. The integrator of free paths also follows this velocity. It does so while the particle is
/// over the surfaces and g presses it onto them. Beyond an edge the particle moves with the flow until the flow presses
/// it onto a surface again. Along the side of a ball or a cylinder it moves on arcs of at most kMaxArcAngle. Around
/// edges it moves on straight segments of at most kMaxChordAngle. A stopped particle keeps its position while the flow
/// presses it onto the wall. It also keeps it if the flow would bring it back within the fraction kShortestRelease of a
/// step. In a pit of more than three faces, a particle stays until the end of the step.
///
/// The stored velocity is the one with which the particle continues; it is zero for a stopped particle. Materials, mass
/// and spin have no effect. Impacts are counted and recorded without impulses, since particles have no momentum here.
///
/// Limits:
/// - A flow that turns away from a wall and back within one step may not be detected.
/// - A particle that exceeds its bounce budget (impacts and paths along surfaces) does not use the whole step. The rest
///   is counted as unsimulated time.
#pragma once

#include "ricochet/response/response.h"

namespace ricochet {

/// See the top of this file. Requires settings.flow.
class AdvectResponse final : public Response {
public:
    explicit AdvectResponse(const ResponseRules& rules) : Response(rules) {}

    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const override;
};

}  // namespace ricochet
