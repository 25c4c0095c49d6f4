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

/// Predicts the surfaces that will stop members, by searching along the paths of a planned step. The plan of an
/// implicit method uses the predictions, because the method must know which neighbours a surface stops. Otherwise
/// springs between stopped and flying members would be stretched by the error at a long step. Each member still meets
/// its surfaces alone and exactly. The prediction decides only where other members expect it.
class PlannedContacts {
public:
    /// All must outlive it. resting_speed is in m/s. Moving surfaces are not predicted.
    PlannedContacts(const CollisionWorld& world, std::span<const Material> materials, double resting_speed)
        : world_(world), materials_(materials), resting_speed_(resting_speed) {}

    /// Returns the support constraints of each member on a straight line. velocities: along the lines, in m/s.
    /// duration: in s. least_compliance: lower bound of SupportConstraints::yield, as a part of the largest
    /// velocity. Newton's method needs a slope, so friction may leave so much slip to a member that it stops.
    [[nodiscard]] std::vector<SupportConstraints> find(const ParticleSystem& system, std::span<const Vec3> velocities,
                                                       std::span<const Vec3> spins, double duration,
                                                       double least_compliance) const;

    /// Returns the deviation of each constrained member, in m, from its straight motion in a step, because surfaces are
    /// curved. It has two parts: the distance to the surface at the end, and the motion along the surface by a contact
    /// force whose direction turns with it.
    [[nodiscard]] std::vector<Vec3> bends(const ParticleSystem& system, const SystemStep& step,
                                          std::span<const SupportConstraints> held) const;

private:
    struct Flown;
    [[nodiscard]] SupportConstraints held(const Flown& flown, const struct Contact& contact) const;

    const CollisionWorld& world_;
    std::span<const Material> materials_;
    double resting_speed_;
};

}  // namespace ricochet
