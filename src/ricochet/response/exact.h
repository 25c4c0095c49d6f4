/// \file
/// The exact response: predict the time of impact on the particle's own path and reflect inside the step, as often as
/// needed.
///
/// Source: continuous collision detection against static surfaces with exact predicates, see ARCHITECTURE.md.
/// What it guarantees: the chain of positions a particle is moved through crosses no surface, exactly; spheres overlap
/// nothing by more than sphere_tolerance(); the time of impact is accurate to rounding on the path.
/// What it does not guarantee: that a bounce cascade below the resting speed is resolved impact by impact (it is summed
/// in closed form), that slow circling in a pit is followed to its end (it becomes rest, kMaxSlowContacts), nor that a
/// particle whose bounce budget is spent uses the whole step (the rest is counted). Contact that lasts is exact on flat
/// surfaces under constant forces while slip keeps its direction, else of second order or better (docs/responses.md).
#pragma once

#include <memory>
#include <vector>

#include "ricochet/response/response.h"

namespace ricochet {

class FrameRules;

/// See the top of this file.
class ExactResponse final : public Response {
public:
    explicit ExactResponse(const ResponseRules& rules);
    ExactResponse(const CollisionWorld& world, const ForceField& forces, std::span<const Material> materials,
                  const ResponseSettings& settings)
        : ExactResponse(ResponseRules{world, forces, materials, settings}) {}
    ~ExactResponse() override;

    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const override;
    void add_weight(const MovingParticle& particle, double duration, std::vector<SurfaceHit>& hits) const override;
    [[nodiscard]] SupportedAcceleration supported_acceleration(const MovingParticle& particle,
                                                               const Vec3& pull) const override;

private:
    std::unique_ptr<FrameRules> frame_rules_;  ///< null where nothing moves
};

}  // namespace ricochet
