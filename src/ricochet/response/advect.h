/// \file
/// First-order motion: a flow carries the particles, x' = g(x, t), and walls stop them or let them slide.
///
/// The path of a step is that of flow_path(). The first contact on it is found and answered inside the step, as in the
/// exact response, and every segment that is travelled is certified to intersect no surface: nothing leaks, exactly.
///
/// A particle that slides follows g without its part into the surfaces that it touches (the closest velocity that
/// enters none of them; at most three count), by the same integrator, for as long as they are under it and g presses it
/// onto them. Over an edge it goes on with the flow until that presses it onto something again. On a curved surface it
/// goes in straight segments of kMaxChordAngle. A particle that stops stays where it has hit a wall while the flow
/// presses it on or would bring it back within kShortestRelease of a step. In a pit of more than three faces it stays
/// to the end of the step.
///
/// The velocity stored is the one that it goes on with: zero where it is stopped. Materials, mass and spin play no
/// role; impacts are counted and recorded, without impulses. Particles have no momentum here.
///
/// What it does not guarantee: that a flow which turns away from a wall and back within one step is noticed; that a
/// particle whose budget of impacts and paths along surfaces is spent uses the whole step (the rest is counted).
#pragma once

#include "ricochet/response/response.h"

namespace ricochet {

/// See the top of this file. settings.flow must be there.
class AdvectResponse final : public Response {
public:
    explicit AdvectResponse(const ResponseRules& rules) : Response(rules) {}

    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const override;
};

}  // namespace ricochet
