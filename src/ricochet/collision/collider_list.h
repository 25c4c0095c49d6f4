/// \file
/// All colliders of a scene and the one order of their surfaces, whatever frame they are in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/collision/collider.h"
#include "ricochet/collision/surface.h"

namespace ricochet {

/// All colliders of a scene, whatever frame they stand in, and how their surfaces are numbered.
class ColliderList {
public:
    /// Throws InputError that names the collider when a mesh has no triangles, or one material a triangle is not given
    /// for each.
    explicit ColliderList(std::vector<ColliderDescription> colliders);

    [[nodiscard]] const std::vector<ColliderDescription>& all() const { return colliders_; }
    [[nodiscard]] std::size_t surface_count() const { return first_surfaces_.back(); }
    /// First surface of a collider; of the number after the last: surface_count().
    [[nodiscard]] SurfaceId first_surface_of(std::size_t collider) const { return first_surfaces_[collider]; }
    [[nodiscard]] std::uint32_t collider_of(SurfaceId surface) const {
        return colliders_.size() == 1 ? 0 : collider_among_many(surface);
    }
    [[nodiscard]] SurfaceName name_of(SurfaceId surface) const;
    /// Material of a surface: that of its triangle, or of its collider.
    [[nodiscard]] std::uint32_t material_of(SurfaceId surface) const;
    /// Lets go of a mesh of which a world holds its own copy.
    void drop_mesh(std::size_t collider);
    /// The same of one that deforms, whose motion, placed, takes the place of the one that was given.
    void replace_motion(std::size_t collider, std::shared_ptr<const MeshMotion> motion);
    /// Bytes, without the meshes.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    [[nodiscard]] std::uint32_t collider_among_many(SurfaceId surface) const;

    std::vector<ColliderDescription> colliders_;
    std::vector<SurfaceId> first_surfaces_;  ///< of each collider, and what would be that of the next
};

}  // namespace ricochet
