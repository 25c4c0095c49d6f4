/// \file
/// Deforming colliders of a scene: meshes whose vertices move on straight lines between keys.
///
/// Such a mesh has no frame in which it is at rest. Segments are therefore certified in space and time. Between two
/// stored positions, the particle and all vertices move on straight lines (MeshMoment::position()). No key of the mesh
/// lies between the two times.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/geometry/acceleration/box_tree.h"
#include "ricochet/geometry/mesh/mesh_motion.h"
#include "ricochet/geometry/sweep/moving_triangle.h"

namespace ricochet {

/// A position of a particle in the world, and its time.
struct StoredPosition {
    Vec3 position;      ///< in m
    double time = 0.0;  ///< in s
};

/// All deforming meshes of a scene. Queries are safe from any number of threads, but not during begin_step().
class DeformingColliders {
public:
    /// Applies the placements of the meshes to their motions. Throws InputError with the name of the collider if motion
    /// and mesh differ in their vertices, or if a coordinate exceeds 1e75 m.
    explicit DeformingColliders(const std::shared_ptr<ColliderList>& colliders);

    [[nodiscard]] bool empty() const { return meshes_.empty(); }
    [[nodiscard]] std::size_t size() const { return meshes_.size(); }
    /// Returns the collider of a mesh.
    [[nodiscard]] std::size_t collider_of(std::size_t mesh) const { return meshes_[mesh].collider; }
    [[nodiscard]] bool owns(SurfaceId surface) const { return mesh_of_[colliders_->collider_of(surface)] != kNone; }
    [[nodiscard]] bool is_mesh(std::size_t collider) const { return mesh_of_[collider] != kNone; }
    /// Returns the motion of a deforming collider.
    [[nodiscard]] const MeshMotion& motion_of(std::size_t collider) const { return *mesh(collider).motion; }
    [[nodiscard]] const std::vector<Triangle>& triangles_of(std::size_t collider) const {
        return mesh(collider).triangles;
    }
    [[nodiscard]] TriangleMesh mesh_at(std::size_t collider, double time) const;

    /// Begins a step over [begin, end], in s. "The step" below is this one.
    void begin_step(double begin, double end);
    /// Appends the triangles that come into the box during the step, in ascending order.
    void near(const Box3& box, std::vector<SurfaceId>& out) const;
    /// Returns true if all meshes stay out of the box during the step.
    [[nodiscard]] bool stay_out(const Box3& box) const;
    /// Returns the largest offset_of() of the meshes that may come into the box, in m, or 0 if all stay out.
    [[nodiscard]] double offset_in(const Box3& box) const;
    /// Returns the contact offset on a surface, in m. It follows from the largest coordinate of the mesh's vertices in
    /// the step.
    [[nodiscard]] double offset_of(SurfaceId surface) const { return mesh_with(surface).offset; }
    [[nodiscard]] double offset_of_mesh(std::size_t mesh) const { return meshes_[mesh].offset; }
    /// Returns the time of the first key of any mesh after a time, in s, or infinity without one.
    [[nodiscard]] double next_key(double time) const;

    /// Returns the corners of a triangle at a time, in s, which may be outside the step.
    [[nodiscard]] std::array<Vec3, 3> corners_at(SurfaceId surface, double time) const;
    /// Returns the straight motion of a triangle between two times, in s, for space-time segments.
    [[nodiscard]] MovingTriangle between(SurfaceId surface, double begin, double end) const;
    /// Returns the velocities of the corners at a time, in m/s.
    [[nodiscard]] std::array<Vec3, 3> corner_velocities(SurfaceId surface, double time) const;
    /// The functions of CollisionWorld with the same names, at a time in s.
    [[nodiscard]] CollisionWorld::Nearest nearest(SurfaceId surface, const Vec3& p, double time) const;
    [[nodiscard]] double signed_distance_from(SurfaceId surface, const Vec3& p, double time) const;
    [[nodiscard]] Vec3 unit_normal_of(SurfaceId surface, double time) const;
    [[nodiscard]] int side_of_surface(SurfaceId surface, const Vec3& p, double time) const;
    /// Motion of a triangle and of its point nearest to a position. At a key, to rounding, it is the motion after the
    /// key.
    struct Motion {
        Vec3 velocity;  ///< velocity of that point, in m/s
        Vec3 turning;   ///< angular velocity of the triangle, in rad/s: of its normal and about its normal
    };
    [[nodiscard]] Motion motion_at(SurfaceId surface, const Vec3& p, double time) const;

    /// Returns true if a space-time segment stays clear of a triangle. This is the exact certificate. Returns false if
    /// a key lies between the two times and the triangle is near.
    [[nodiscard]] bool is_free(SurfaceId surface, const StoredPosition& from, const StoredPosition& to,
                               double radius) const;
    /// Returns true if a space-time segment stays clear of all triangles. A sphere that starts nearer to a triangle
    /// than its radius must not come nearer.
    [[nodiscard]] bool is_segment_free(const StoredPosition& from, const StoredPosition& to, double radius) const;

    /// Does the same for a particle whose time has stalled since an earlier step. The segment may then contain keys:
    /// each corner moves straight from its position at the first time to that at the second, wherever it was in
    /// between. Only the centre of a sphere is certified. At the end the sphere must not overlap any surface more than
    /// at the start.
    [[nodiscard]] bool is_late_segment_free(const StoredPosition& from, const StoredPosition& to, double radius) const;
    /// Appends the triangles nearest to a position at a time, in s, which may be outside the step. It appends at most
    /// `most`, the nearest first.
    void nearest_to(const Vec3& p, double time, std::size_t most, std::vector<SurfaceId>& out) const;

    /// Returns the memory of the object with the motions, in bytes.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

    struct Mesh {
        std::size_t collider = 0;
        SurfaceId first_surface = 0;
        std::vector<Triangle> triangles;
        /// Triangles with three different vertices. Others never have an area, and collisions ignore them.
        std::vector<std::uint32_t> solid;
        std::shared_ptr<const MeshMotion> motion;
        MeshMoment at_begin;  ///< at the start of the step
        MeshMoment at_end;
        BoxTree tree;         ///< boxes that contain each solid triangle during the step
        double offset = 0.0;  ///< in m, see offset_of()
        /// Vertex positions if the mesh is at rest in the step of `tree`: before its first key or after its last one.
        const Vec3* stands_at = nullptr;
    };

    void add(std::size_t number);
    [[nodiscard]] MeshMoment moment_of(const Mesh& mesh, double time) const;
    [[nodiscard]] const Mesh& mesh(std::size_t collider) const { return meshes_[mesh_of_[collider]]; }
    [[nodiscard]] const Mesh& mesh_with(SurfaceId surface) const { return mesh(colliders_->collider_of(surface)); }
    void sweep(Mesh& mesh);
    [[nodiscard]] bool is_late_segment_free(const Mesh& mesh, const StoredPosition& from, const StoredPosition& to,
                                            double radius) const;

    std::shared_ptr<ColliderList> colliders_;
    std::vector<Mesh> meshes_;
    std::vector<std::uint32_t> mesh_of_;  ///< index of each collider's mesh; kNone for other colliders
    std::vector<Box3> swept_;             ///< scratch memory of sweep(): box of each vertex during the step
    double begin_ = 0.0;
    double end_ = 0.0;
};

}  // namespace ricochet
