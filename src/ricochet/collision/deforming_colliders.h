/// \file
/// The colliders of a scene that deform: meshes whose vertices move, each on straight lines between stored times.
///
/// Such a mesh has no frame in which it stands still. What is proved is proved in space and time: from one stored
/// position of a particle to the next, all moves in straight lines, the particle and the vertices from where they are
/// at the one time to where they are at the other (MeshMoment::position()), and no key of the mesh lies between.
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
    Vec3 position;      ///< m
    double time = 0.0;  ///< s
};

/// All of them. Queries are safe from any number of threads, but not beside begin_step().
class DeformingColliders {
public:
    /// Bakes their placements. Throws InputError that names the collider for a motion that has other vertices than the
    /// mesh, and what is beyond 1e75 m.
    explicit DeformingColliders(const std::shared_ptr<ColliderList>& colliders);

    [[nodiscard]] bool empty() const { return meshes_.empty(); }
    [[nodiscard]] std::size_t size() const { return meshes_.size(); }
    /// Number of the collider that a mesh is.
    [[nodiscard]] std::size_t collider_of(std::size_t mesh) const { return meshes_[mesh].collider; }
    [[nodiscard]] bool owns(SurfaceId surface) const { return mesh_of_[colliders_->collider_of(surface)] != kNone; }
    [[nodiscard]] bool is_mesh(std::size_t collider) const { return mesh_of_[collider] != kNone; }
    /// Of a collider that is one of them.
    [[nodiscard]] const MeshMotion& motion_of(std::size_t collider) const { return *mesh(collider).motion; }
    [[nodiscard]] const std::vector<Triangle>& triangles_of(std::size_t collider) const {
        return mesh(collider).triangles;
    }
    [[nodiscard]] TriangleMesh mesh_at(std::size_t collider, double time) const;

    /// What follows is asked within [begin, end], s.
    void begin_step(double begin, double end);
    /// Appends the triangles that come into the box during the step, in ascending order.
    void near(const Box3& box, std::vector<SurfaceId>& out) const;
    /// True where all of them stay out of the box during the step.
    [[nodiscard]] bool stay_out(const Box3& box) const;
    /// m, the largest offset_of() of those that may come into the box; 0 where all stay out.
    [[nodiscard]] double offset_in(const Box3& box) const;
    /// m, the contact offset where one of these is touched: by the largest of its vertices' coordinates in the step.
    [[nodiscard]] double offset_of(SurfaceId surface) const { return mesh_with(surface).offset; }
    [[nodiscard]] double offset_of_mesh(std::size_t mesh) const { return meshes_[mesh].offset; }
    /// The first key of any of them after a time, s; infinite when there is none.
    [[nodiscard]] double next_key(double time) const;

    /// Where the corners of a triangle are at a time, s, of the step or not.
    [[nodiscard]] std::array<Vec3, 3> corners_at(SurfaceId surface, double time) const;
    /// From one time to another, as links see it.
    [[nodiscard]] MovingTriangle between(SurfaceId surface, double begin, double end) const;
    /// m/s, of the corners at a time.
    [[nodiscard]] std::array<Vec3, 3> corner_velocities(SurfaceId surface, double time) const;
    /// CollisionWorld's functions of the same names at a time.
    [[nodiscard]] CollisionWorld::Nearest nearest(SurfaceId surface, const Vec3& p, double time) const;
    [[nodiscard]] double signed_distance_from(SurfaceId surface, const Vec3& p, double time) const;
    [[nodiscard]] Vec3 unit_normal_of(SurfaceId surface, double time) const;
    [[nodiscard]] int side_of_surface(SurfaceId surface, const Vec3& p, double time) const;
    /// How the nearest point of a triangle moves, and the triangle with it. At a key, to rounding, as after it.
    struct Motion {
        Vec3 velocity;  ///< m/s, of that point
        Vec3 turning;   ///< rad/s, of the triangle: of its normal, and about it
    };
    [[nodiscard]] Motion motion_at(SurfaceId surface, const Vec3& p, double time) const;

    /// The certificate of one link and one triangle: exact. Where a key lies between both times, and they are near each
    /// other, it is not given.
    [[nodiscard]] bool is_free(SurfaceId surface, const StoredPosition& from, const StoredPosition& to,
                               double radius) const;
    /// That of a link and all triangles. A sphere may be nearer than the radius where it is so at the start; it may not
    /// come nearer still.
    [[nodiscard]] bool is_segment_free(const StoredPosition& from, const StoredPosition& to, double radius) const;

    /// The same of a particle whose clock has stood still since a step before: each corner goes straight from its place
    /// at the one time to that at the other, wherever it has been between, so that the link may lead over keys. Only
    /// the centre of a sphere is followed; at the end the sphere overlaps nothing that it has not overlapped as much
    /// at the start.
    [[nodiscard]] bool is_late_segment_free(const StoredPosition& from, const StoredPosition& to, double radius) const;
    /// Appends the triangles nearest to a position at a time, s, of the step or not: at most `most`, the nearest first.
    void nearest_to(const Vec3& p, double time, std::size_t most, std::vector<SurfaceId>& out) const;

    /// Bytes, with the motions.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

    struct Mesh {
        std::size_t collider = 0;
        SurfaceId first_surface = 0;
        std::vector<Triangle> triangles;
        /// Those with three corners. What names a vertex twice never has an area, and takes no part in collisions.
        std::vector<std::uint32_t> solid;
        std::shared_ptr<const MeshMotion> motion;
        MeshMoment at_begin;  ///< of the step
        MeshMoment at_end;
        BoxTree tree;         ///< of where each solid triangle comes in the step
        double offset = 0.0;  ///< m, see offset_of()
        /// The positions at which it stands in the step that `tree` is of: before its first key or after its last one.
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
    std::vector<std::uint32_t> mesh_of_;  ///< of each collider; kNone for others
    std::vector<Box3> swept_;             ///< scratch memory of sweep(): where each vertex comes in the step
    double begin_ = 0.0;
    double end_ = 0.0;
};

}  // namespace ricochet
