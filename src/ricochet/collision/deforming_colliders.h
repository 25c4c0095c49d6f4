/// \file
/// All deforming meshes of a scene.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ricochet/collision/deforming_mesh.h"

namespace ricochet {

/// All deforming meshes of a scene. Queries are safe from any number of threads, but not during begin_step().
class DeformingColliders {
public:
    /// Creates the deforming meshes of a list. Throws as DeformingMesh does.
    explicit DeformingColliders(const std::shared_ptr<ColliderList>& colliders);

    [[nodiscard]] bool empty() const { return meshes_.empty(); }
    [[nodiscard]] const std::vector<DeformingMesh>& all() const { return meshes_; }
    [[nodiscard]] bool is_mesh(std::size_t collider) const { return mesh_of_[collider] != kNone; }
    /// Returns the mesh of a collider or of a surface. Requires is_mesh().
    [[nodiscard]] const DeformingMesh& mesh(std::size_t collider) const { return meshes_[mesh_of_[collider]]; }
    [[nodiscard]] const DeformingMesh& mesh_with(SurfaceId surface) const {
        return mesh(colliders_->collider_of(surface));
    }
    /// Returns a triangle at a time, in s, which may be outside the step.
    [[nodiscard]] DeformedTriangle triangle_at(SurfaceId surface, double time) const {
        return mesh_with(surface).triangle_at(surface, time);
    }
    /// Returns the time of the first key of any mesh after a time, in s, or infinity if there is none.
    [[nodiscard]] double next_key(double time) const;

    /// Begins a step over [begin, end], in s. "The step" below is this one.
    void begin_step(double begin, double end);
    /// Appends the triangles that come into the box during the step, in ascending order.
    void near(const Box3& box, std::vector<SurfaceId>& out) const;
    /// Returns true if all meshes stay out of the box during the step.
    [[nodiscard]] bool stay_out(const Box3& box) const;
    /// Returns the largest contact offset of the meshes that may come into the box, in m, or 0 if all stay out.
    [[nodiscard]] double offset_in(const Box3& box) const;

    /// Returns true if a space-time segment stays clear of all triangles. A sphere in overlap must not come nearer.
    [[nodiscard]] bool is_segment_free(const StoredPosition& from, const StoredPosition& to, double radius) const;
    /// Does the same for a particle whose time has stalled since an earlier step. The segment may then contain key
    /// times. Each corner is assumed to move straight from its position at the first time to that at the second. Only
    /// the centre of a sphere is certified. At the end the sphere must not overlap any surface more than at the start.
    [[nodiscard]] bool is_late_segment_free(const StoredPosition& from, const StoredPosition& to, double radius) const;
    /// Appends the triangles nearest to a position at a time, in s, inside or outside the step; at most `most`.
    void nearest_to(const Vec3& p, double time, std::size_t most, std::vector<SurfaceId>& out) const;

private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

    std::shared_ptr<ColliderList> colliders_;
    std::vector<DeformingMesh> meshes_;
    std::vector<std::uint32_t> mesh_of_;  ///< index of each collider's mesh; kNone for other colliders
    std::vector<Box3> boxes_;             ///< scratch memory of begin_step()
    double begin_ = 0.0;
    double end_ = 0.0;
};

}  // namespace ricochet
