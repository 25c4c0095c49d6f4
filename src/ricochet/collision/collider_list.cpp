#include "ricochet/collision/collider_list.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

std::size_t surfaces_of(const ColliderDescription& collider) {
    constexpr std::size_t kOfBox = 12;
    constexpr std::size_t kOfCylinder = 3;
    if (std::holds_alternative<CylinderShape>(collider.shape)) return kOfCylinder;
    if (std::holds_alternative<CuboidShape>(collider.shape)) return kOfBox;
    const auto* mesh = std::get_if<MeshShape>(&collider.shape);
    if (mesh == nullptr) return 1;
    const auto require = [&](bool holds, const char* what) {
        if (!holds) throw InputError("collider \"" + collider.name + "\": " + what);
    };
    require(mesh->mesh && !mesh->mesh->triangles.empty(), "its mesh has no triangles, expected at least one");
    const std::size_t count = mesh->mesh->triangles.size();
    require(mesh->triangle_materials.empty() || mesh->triangle_materials.size() == count,
            "its material list does not have one entry per triangle");
    require(count <= std::numeric_limits<SurfaceId>::max() / 2,
            "the scene's meshes have more than 2^31 triangles or vertices together");
    return count;
}

}  // namespace

ColliderList::ColliderList(std::vector<ColliderDescription> colliders) : colliders_(std::move(colliders)) {
    std::size_t count = 0;
    for (const ColliderDescription& collider : colliders_) {
        first_surfaces_.push_back(static_cast<SurfaceId>(count));
        count += surfaces_of(collider);
        if (count > std::numeric_limits<SurfaceId>::max() / 2) {
            throw InputError("collider \"" + collider.name +
                             "\": the scene's meshes have more than 2^31 triangles or vertices together");
        }
    }
    first_surfaces_.push_back(static_cast<SurfaceId>(count));
}

std::uint32_t ColliderList::collider_among_many(SurfaceId surface) const {
    const auto after = std::upper_bound(first_surfaces_.begin(), first_surfaces_.end(), surface);
    return static_cast<std::uint32_t>(after - first_surfaces_.begin() - 1);
}

SurfaceName ColliderList::name_of(SurfaceId surface) const {
    const std::uint32_t collider = collider_of(surface);
    const ColliderShape& shape = colliders_[collider].shape;
    const bool is_mesh = std::holds_alternative<MeshShape>(shape) || std::holds_alternative<CuboidShape>(shape);
    return {collider, is_mesh ? surface - first_surfaces_[collider] : 0};
}

std::uint32_t ColliderList::material_of(SurfaceId surface) const {
    const std::uint32_t collider = collider_of(surface);
    const auto* mesh = std::get_if<MeshShape>(&colliders_[collider].shape);
    if (mesh == nullptr || mesh->triangle_materials.empty()) return colliders_[collider].material;
    return mesh->triangle_materials[surface - first_surfaces_[collider]];
}

void ColliderList::drop_mesh(std::size_t collider) { std::get<MeshShape>(colliders_[collider].shape).mesh.reset(); }

void ColliderList::replace_motion(std::size_t collider, std::shared_ptr<const MeshMotion> motion) {
    std::get<MeshShape>(colliders_[collider].shape).motion = std::move(motion);
    drop_mesh(collider);
}

std::size_t ColliderList::memory_bytes() const {
    std::size_t bytes = first_surfaces_.capacity() * sizeof(SurfaceId);
    for (const ColliderDescription& collider : colliders_) {
        const auto* mesh = std::get_if<MeshShape>(&collider.shape);
        if (mesh != nullptr) bytes += mesh->triangle_materials.capacity() * sizeof(std::uint32_t);
    }
    return bytes;
}

}  // namespace ricochet
