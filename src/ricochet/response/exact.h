/// \file
/// The exact response: computes the time of impact on the particle's own path, and reflects within the step.
///
/// Source: continuous collision detection against static surfaces with exact predicates, see ARCHITECTURE.md.
///
/// Guarantees: the chain of a particle's positions crosses no surface, which is decided in exact arithmetic. Spheres
/// overlap no surface by more than sphere_tolerance(). The time of impact on the path is accurate to rounding.
///
/// Limits:
/// - A bounce cascade below the resting speed is not resolved impact by impact, but summed in closed form.
/// - Slow circling in a pit is not followed to its end: it becomes rest (kMaxSlowContacts).
/// - A particle that exceeds its bounce budget does not use the whole step. The rest is counted as unsimulated time.
///
/// Lasting contact is exact on flat surfaces under constant forces while the slip keeps its direction. Otherwise its
/// integration is of second order or better (docs/responses.md).
#pragma once

#include <vector>

#include "ricochet/response/reference_frame.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// See the top of this file.
class ExactResponse final : public Response {
public:
    explicit ExactResponse(const ResponseRules& rules);

    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const override;
    void add_weight(const MovingParticle& particle, double duration, std::vector<SurfaceHit>& hits) const override;
    [[nodiscard]] SupportedAcceleration supported_acceleration(const MovingParticle& particle,
                                                               const Vec3& pull) const override;

private:
    FrameRules frame_rules_;
};

}  // namespace ricochet
