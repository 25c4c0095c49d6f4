/// \file
/// Private to the simulation: what surfaces leave of the motion of particles that are planned together.
#pragma once

#include <span>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/dynamics/particle_system.h"
#include "ricochet/dynamics/system_integrator.h"
#include "ricochet/response/material.h"

namespace ricochet {

/// Looks along the paths of a planned step for the surfaces that will stop them. What it says is taken into the plan of
/// an implicit method, for which a neighbour that a surface stops and one that flies on are not the same thing: at a
/// long step the springs between them would be stretched by all that the plan did not know. Each member still meets its
/// surfaces for itself and exactly; what is foreseen here decides only where the others expect it.
class PlannedContacts {
public:
    /// All must outlive it; resting_speed in m/s. Surfaces that move are not foreseen.
    PlannedContacts(const CollisionWorld& world, std::span<const Material> materials, double resting_speed)
        : world_(world), materials_(materials), resting_speed_(resting_speed) {}

    /// By member. velocities: those with which they would fly, m/s, in lines for a duration, s. smallest_inverse_mass:
    /// parts of the largest of them up to which friction may leave a slip to what it stops, since Newton's method needs
    /// a slope.
    [[nodiscard]] std::vector<SupportConstraints> find(const ParticleSystem& system, std::span<const Vec3> velocities,
                                                       std::span<const Vec3> spins, double duration,
                                                       double smallest_inverse_mass) const;

    /// By member, m: by how much what surfaces hold ends elsewhere than its straight motion in a step, since they bend:
    /// by where they are at its end, and by the way that what presses on them leads along them as they turn.
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
