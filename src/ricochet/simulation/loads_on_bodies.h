/// \file
/// Private to the simulation: the loads on bodies, the resting ones among them, and the times at which these end.
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

/// View of the loads in a substep; its arguments must outlive it. The loads of each particle follow each other in the
/// order of time.
class LoadsOnBodies {
public:
    /// collider_of: colliders of each body, kWorldBody if it has none. slow: speed of impacts that begin contact, in
    /// m/s.
    LoadsOnBodies(std::span<const DrivenBody> bodies, std::span<const BodyId> collider_of,
                  const MovingColliders* colliders, double slow)
        : bodies_(bodies), collider_of_(collider_of), colliders_(colliders), slow_(slow) {}

    /// Returns the body that takes a load, or nothing if the load is on no body.
    [[nodiscard]] std::optional<std::size_t> body_of(const ColliderLoad& load) const;
    /// Returns the sum of the loads on each body, about its moment_center(), in N s and N m s.
    [[nodiscard]] std::vector<Wrench> sums(std::span<const ColliderLoad> loads) const;
    /// Returns the load that rests on a body until a time, in s.
    [[nodiscard]] RestingLoad resting_load_on(std::size_t body, std::span<const ColliderLoad> loads,
                                              double until) const;
    /// Returns the time, in s, after which no resting load pushes a body any more, or infinity if none does at all.
    [[nodiscard]] double left_at(std::size_t body, std::span<const ColliderLoad> loads) const;
    /// Returns the mass of a particle over the body's effective mass for the impulse of a load; 0 without impulse.
    [[nodiscard]] double heaviness_on(std::size_t body, const ColliderLoad& load) const;

private:
    [[nodiscard]] bool lies_on(std::size_t body, const ColliderLoad& load) const;

    std::span<const DrivenBody> bodies_;
    std::span<const BodyId> collider_of_;
    const MovingColliders* colliders_;
    double slow_;
};

}  // namespace ricochet
