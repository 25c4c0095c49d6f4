/// \file
/// First-order motion: a flow carries the particles, x' = g(x, t), and walls stop them or let them slide.
///
/// The path of a step comes from flow_path(). Its first contact is found and resolved within the step, as in the exact
/// response. Every segment of the trajectory is certified to intersect no surface: nothing leaks, exactly.
///
/// A sliding particle follows g without its component into the touched surfaces: the closest velocity that enters none
/// of them. At most three surfaces count. The same integrator follows that velocity while the surfaces are below the
/// particle and g presses it onto them. Beyond an edge the particle moves with the flow until the flow presses it onto
/// a surface again. Along the side of a ball or a cylinder it moves on arcs of at most kMaxArcAngle, round edges on
/// straight segments of kMaxChordAngle. A stopped particle keeps its position while the flow presses it onto the wall,
/// or would bring it back within kShortestRelease of a step. In a pit of more than three faces it stays until the end
/// of the step.
///
/// The stored velocity is the one with which the particle continues; it is zero for a stopped particle. Materials, mass
/// and spin have no effect. Impacts are counted and recorded without impulses, since particles have no momentum here.
///
/// Limits:
/// - A flow that turns away from a wall and back within one step may go unnoticed.
/// - A particle that has spent its budget of impacts and paths along surfaces does not use the whole step. The rest is
///   counted.
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
