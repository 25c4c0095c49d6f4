/// \file
/// Private to the simulation: the colliders of a run, at rest and moving, with their materials.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/collision/collider_list.h"
#include "ricochet/collision/collision_world.h"
#include "ricochet/collision/contact_query.h"
#include "ricochet/collision/moving_colliders.h"
#include "ricochet/collision/overlap.h"
#include "ricochet/core/ranks.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/response/material.h"
#include "ricochet/simulation/query_schedule.h"

namespace ricochet {

/// The colliders of a run in all their frames. A collider without a frame is at rest in the world.
class CollisionScene {
public:
    /// frames: null without moving frames; copied, because the paths of bodies belong to one run. chord_margin: of the
    /// colliders at rest, see CollisionWorld. Throws InputError like CollisionWorld and MovingColliders.
    CollisionScene(std::vector<ColliderDescription> colliders, std::vector<Material> materials,
                   const std::shared_ptr<const FrameTree>& frames, double chord_margin);

    /// Returns the collision world of the colliders at rest. It also stores the names of all surfaces.
    [[nodiscard]] const CollisionWorld& world() const { return *world_; }
    [[nodiscard]] std::shared_ptr<const CollisionWorld> shared_world() const { return world_; }
    /// Returns the colliders in all frames, at rest and moving.
    [[nodiscard]] MovingColliders& moving() { return moving_; }
    [[nodiscard]] const MovingColliders& moving() const { return moving_; }
    [[nodiscard]] FrameTree* frames() { return frames_.get(); }
    [[nodiscard]] const ColliderList& list() const { return *list_; }
    [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }
    /// Returns true if impulses on colliders can do work, because colliders or their materials move.
    [[nodiscard]] bool has_loads() const;

    void set_culling(bool culls);
    void begin_step(const TimeSpan& step);
    void prepare_radius(double radius);

    // New particles.

    /// Returns the deepest overlap of a particle with a surface at its birth.
    [[nodiscard]] std::optional<Overlap> overlap_of(const Particle& particle) const;
    /// Returns true if, at its birth, a child overlaps no surface, and none lies between it and its parent.
    [[nodiscard]] bool has_room_beside(const Particle& parent, const Particle& child) const;

    // Single colliders and surfaces.

    /// Returns the collision world in which a collider is at rest; for a deforming mesh the world of those at rest.
    [[nodiscard]] const CollisionWorld& world_of(std::size_t collider) const;
    /// Returns the mesh of a collider, in the collider's frame, at a time, in s. A plane has no mesh.
    [[nodiscard]] std::optional<TriangleMesh> mesh_of(std::size_t collider, double time) const;
    [[nodiscard]] MovingPose pose_of(std::size_t collider, double time) const;
    /// Returns the point of a surface that is closest to a world position, in m, at a time, in s.
    [[nodiscard]] SurfacePosition closest_point(SurfaceId surface, const Vec3& position, double time) const;
    [[nodiscard]] std::size_t triangle_count() const;
    [[nodiscard]] std::size_t degenerate_triangles() const;

    /// Returns a hash of the colliders in their frames and of the motion of the frames.
    [[nodiscard]] std::uint64_t hash() const;
    /// Shares the memory of all rigid meshes between the ranks of a machine.
    void share_meshes(Ranks& ranks);
    /// Returns the size of the shared meshes, in bytes.
    [[nodiscard]] std::uint64_t shared_bytes() const { return shared_bytes_; }

private:
    [[nodiscard]] bool is_deforming(std::size_t collider) const { return moving_.deforming().is_mesh(collider); }
    /// Calls visit(world) for the collision world at rest and for the collision world of each moving frame.
    template <class Visit>
    void visit_worlds(const Visit& visit) const;
    [[nodiscard]] std::uint64_t computed_hash() const;

    std::vector<Material> materials_;
    std::shared_ptr<ColliderList> list_;
    std::shared_ptr<CollisionWorld> world_;
    std::shared_ptr<FrameTree> frames_;
    MovingColliders moving_;
    mutable std::optional<std::uint64_t> hash_;  // set by the first call of hash(), then constant
    std::uint64_t shared_bytes_ = 0;
};

/// Returns true if a stored position is within the range of the arithmetic.
[[nodiscard]] bool is_in_range(const Vec3& position);

/// Returns true if no surface intersects the closed segment. The test is exact.
[[nodiscard]] bool is_clear(const CollisionWorld& world, ContactScratch& scratch, const Vec3& from, const Vec3& to);

}  // namespace ricochet
