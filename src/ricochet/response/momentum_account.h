/// \file
/// Private to the exact response: closes the books of contact in frames that move.
#pragma once

#include "ricochet/response/particle_step.h"

namespace ricochet {

/// What contact in a frame that moves, or with several of them, has recorded is exact to the method's order. Under
/// forces that are the same everywhere the momentum that surfaces have given is known, and what is missing is entered.
class MomentumAccount {
public:
    /// Of the particle from now on; its state is given in the world. The step must outlive it.
    explicit MomentumAccount(ParticleStep& step)
        : step_(step),
          velocity_(step.state().velocity),
          pushed_(step.impact().pushed()),
          remaining_(step.remaining()) {}

    /// Enters what is missing until now, with a surface; the state is given in the world again. Nothing where forces
    /// vary, or others pull at the particle.
    void settle(SurfaceId surface) const {
        const ForceField& forces = step_.rules().forces;
        const bool is_coupled = step_.particle().planned != nullptr || step_.state().coupling != nullptr;
        if (!forces.is_uniform() || is_coupled) return;
        const Vec3 by_forces = (remaining_ - step_.remaining()) * forces.acceleration(step_.state());
        const Vec3 given = step_.state().velocity - velocity_ - by_forces;
        const Vec3 missing = given - (step_.impact().pushed() - pushed_);
        if (missing != Vec3{}) step_.impact().push(surface, missing, false, Vec3{});
    }

private:
    ParticleStep& step_;
    Vec3 velocity_;     // m/s
    Vec3 pushed_;       // ImpactAnswer::pushed()
    double remaining_;  // s, of the step
};

}  // namespace ricochet
