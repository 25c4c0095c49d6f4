/// \file
/// Private to the simulation: which body takes a load, how much of many loads lies on one, and when that leaves it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/mobility.h"
#include "ricochet/dynamics/driven_body.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/load_relaxation.h"

namespace ricochet {

/// A view: what it is made of must outlive it. Loads are those of a part of a step, each particle's one after the other
/// in the order of time.
class LoadsOnBodies {
public:
    /// collider_of: of each body, kWorldBody where it has none. slow: m/s, of impacts that begin contact.
    LoadsOnBodies(std::span<const DrivenBody> bodies, std::span<const BodyId> collider_of,
                  const MovingColliders* colliders, double slow)
        : bodies_(bodies), collider_of_(collider_of), colliders_(colliders), slow_(slow) {}

    /// Nothing where the load is on no body.
    [[nodiscard]] std::optional<std::size_t> body_of(const ColliderLoad& load) const;
    /// Of each body, about its moment_center(): N s and N m s.
    [[nodiscard]] std::vector<Wrench> sums(std::span<const ColliderLoad> loads) const;
    /// What lies on a body until a time, s.
    [[nodiscard]] RestingLoad resting_load_on(std::size_t body, std::span<const ColliderLoad> loads,
                                              double until) const;
    /// s, after which nothing of what lies on a body pushes it any more; infinite where nothing does at all.
    [[nodiscard]] double left_at(std::size_t body, std::span<const ColliderLoad> loads) const;
    /// The mass of a particle over that with which a body yields to its impulse; 0 where there is none.
    [[nodiscard]] double heaviness_on(std::size_t body, const ColliderLoad& load) const;

private:
    [[nodiscard]] bool lies_on(std::size_t body, const ColliderLoad& load) const;

    std::span<const DrivenBody> bodies_;
    std::span<const BodyId> collider_of_;
    const MovingColliders* colliders_;
    double slow_;
};

}  // namespace ricochet
