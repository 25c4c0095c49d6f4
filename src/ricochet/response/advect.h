/// \file
/// First-order motion: a flow carries the particles, x' = g(x, t), and walls stop them or let them slide.
///
/// The path of a step comes from flow_path(). Its first contact is found and resolved within the step, and every
/// segment is certified, as in the exact response. So no particle passes through a wall.
///
/// A sliding particle has the velocity closest to g that does not point into any touched surface. At most three
/// surfaces are considered. The integrator of free paths also follows this velocity, while g presses the particle onto
/// the surfaces. Beyond an edge the particle moves with the flow. A stopped particle stays while the flow presses it
/// onto the wall, or would bring it back within the fraction kShortestRelease of a step. In a pit of more than three
/// faces, a particle stays until the end of the step.
///
/// The stored velocity is the one with which the particle continues; it is zero for a stopped particle. Materials, mass
/// and spin have no effect. Impacts are counted and recorded without impulses, since particles have no momentum here.
///
/// Limits:
/// - A flow that turns away from a wall and back within one step may not be detected.
/// - If a particle exceeds its bounce budget (impacts and paths along surfaces), the rest of the step is unsimulated.
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
