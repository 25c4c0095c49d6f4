/// \file
/// Private to the exact response: closes the books of contact in frames that move.
#pragma once

#include "ricochet/response/particle_step.h"

namespace ricochet {

/// What contact in a frame that moves, or with several of them, has recorded is exact to the method's order, and is
/// entered where each interval ends. Under forces that are the same everywhere the momentum and the angular momentum
/// that surfaces have given are known, and what is missing is entered.
class MomentumAccount {
public:
    /// Of the particle from now on; its state is given in the world. The step must outlive it.
    explicit MomentumAccount(ParticleStep& step)
        : step_(step),
          velocity_(step.state().velocity),
          arm_(step.state().position - step.impact().moment_center()),
          pushed_(step.impact().pushed()),
          pushed_moment_(step.impact().pushed_moment()),
          remaining_(step.remaining()) {}

    /// Enters what is missing until now, with a surface; the state is given in the world again. Nothing where forces
    /// vary, or others pull at the particle. The moment of the forces is that at the mean of both ends.
    void settle(SurfaceId surface) const {
        const ForceField& forces = step_.rules().forces;
        const bool is_coupled = step_.particle().planned != nullptr || step_.state().coupling != nullptr;
        if (!forces.is_uniform() || is_coupled) return;
        ImpactAnswer& impact = step_.impact();
        const Vec3 by_forces = (remaining_ - step_.remaining()) * forces.acceleration(step_.state());
        const Vec3 given = step_.state().velocity - velocity_ - by_forces;
        const Vec3 missing = given - (impact.pushed() - pushed_);
        if (missing != Vec3{}) impact.push(surface, missing, false, Vec3{});
        const Vec3 arm = step_.state().position - impact.moment_center();
        const Vec3 turned =
            cross(arm, step_.state().velocity) - cross(arm_, velocity_) - cross(0.5 * (arm_ + arm), by_forces);
        const Vec3 missing_moment = turned - (impact.pushed_moment() - pushed_moment_);
        if (missing_moment != Vec3{}) impact.turn(surface, missing_moment);
    }

private:
    ParticleStep& step_;
    Vec3 velocity_;       // m/s
    Vec3 arm_;            // m, from ImpactAnswer::moment_center()
    Vec3 pushed_;         // ImpactAnswer::pushed()
    Vec3 pushed_moment_;  // ImpactAnswer::pushed_moment()
    double remaining_;    // s, of the step
};

}  // namespace ricochet
