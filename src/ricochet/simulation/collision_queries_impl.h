/// \file
/// Private to the simulation: what collision queries share.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/collision/signed_distance.h"
#include "ricochet/collision_queries.h"
#include "ricochet/geometry/mesh/mesh_interior.h"

namespace ricochet {

/// A collision world, with what only some of the questions need: that is made when the first of them is asked.
struct CollisionQueries::Impl {
    explicit Impl(std::shared_ptr<const CollisionWorld> collision_world) : world(std::move(collision_world)) {}

    [[nodiscard]] const SignedDistance& signed_distance() const;
    /// Of the closed meshes.
    [[nodiscard]] const std::vector<MeshInterior>& interiors() const;

    std::shared_ptr<const CollisionWorld> world;

private:
    mutable std::once_flag distance_made_;
    mutable std::once_flag interiors_made_;
    mutable std::optional<SignedDistance> distance_;
    mutable std::vector<MeshInterior> interiors_;
};

}  // namespace ricochet
