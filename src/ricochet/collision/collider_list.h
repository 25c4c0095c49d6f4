/// \file
/// All colliders of a scene, in all frames, with one order of their surfaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/collision/collider.h"
#include "ricochet/collision/surface.h"

namespace ricochet {

/// All colliders of a scene, in all frames, and the numbers of their surfaces.
class ColliderList {
public:
    /// Throws InputError with the collider's name for a mesh without triangles, or with too few or many materials.
    explicit ColliderList(std::vector<ColliderDescription> colliders);

    [[nodiscard]] const std::vector<ColliderDescription>& all() const { return colliders_; }
    [[nodiscard]] std::size_t surface_count() const { return first_surfaces_.back(); }
    /// Returns the first surface of a collider, or surface_count() for the index after the last collider.
    [[nodiscard]] SurfaceId first_surface_of(std::size_t collider) const { return first_surfaces_[collider]; }
    [[nodiscard]] std::uint32_t collider_of(SurfaceId surface) const {
        return colliders_.size() == 1 ? 0 : collider_among_many(surface);
    }
    [[nodiscard]] SurfaceName name_of(SurfaceId surface) const;
    /// Returns the material of a surface: the material of its triangle if it has one, otherwise of its collider.
    [[nodiscard]] std::uint32_t material_of(SurfaceId surface) const;
    /// Releases the mesh of a collider after a collision world has made its own copy.
    void drop_mesh(std::size_t collider);
    /// Replaces the motion of a deforming mesh by the motion after its placement. Releases the collider's mesh.
    void replace_motion(std::size_t collider, std::shared_ptr<const MeshMotion> motion);
    /// Returns the memory of the list, in bytes, without the meshes.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    [[nodiscard]] std::uint32_t collider_among_many(SurfaceId surface) const;

    std::vector<ColliderDescription> colliders_;
    std::vector<SurfaceId> first_surfaces_;  ///< one per collider, then surface_count()
};

}  // namespace ricochet
