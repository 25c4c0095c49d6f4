/// \file
/// Private to the simulation: prediction of the surfaces that stop coupled particles.
#pragma once

#include <span>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/dynamics/particle_system.h"
#include "ricochet/dynamics/system_integrator.h"
#include "ricochet/response/material.h"

namespace ricochet {

/// Predicts the surfaces that will stop members, by a search along the paths of a planned step. Plans of an implicit
/// method use the predictions, because the method must know which members a surface stops. Without predictions, a long
/// step would stretch springs between stopped and flying members by a large error. Each member still collides with its
/// surfaces alone and exactly. The prediction decides only where the other members expect a member to be.
class PlannedContacts {
public:
    /// The arguments must outlive the object. resting_speed: m/s. Moving surfaces are not predicted.
    PlannedContacts(const CollisionWorld& world, std::span<const Material> materials, double resting_speed)
        : world_(world), materials_(materials), resting_speed_(resting_speed) {}

    /// Returns the support constraints of each member for straight motion with `velocities`, in m/s, for `duration`, in
    /// s. least_compliance: lower bound of SupportConstraints::yield, divided by the largest velocity. Newton's method
    /// needs a finite slope, so a member that friction stops may keep slip up to this bound.
    [[nodiscard]] std::vector<SupportConstraints> find(const ParticleSystem& system, std::span<const Vec3> velocities,
                                                       std::span<const Vec3> spins, double duration,
                                                       double least_compliance) const;

    /// Returns the deviation, in m, of each constrained member from its straight motion in a step, by the curvature of
    /// surfaces. It is the distance to the surface at the end of the step, plus the motion along the surface by a
    /// contact force whose direction turns with it.
    [[nodiscard]] std::vector<Vec3> find_curvature_deviations(const ParticleSystem& system, const SystemStep& step,
                                                              std::span<const SupportConstraints> supports) const;

private:
    struct Flown;
    [[nodiscard]] SupportConstraints find_supports(const Flown& flown, const struct Contact& contact) const;

    const CollisionWorld& world_;
    std::span<const Material> materials_;
    double resting_speed_;
};

}  // namespace ricochet
