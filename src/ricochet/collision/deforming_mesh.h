/// \file
/// A collider whose vertices move on straight lines between keys, and its triangles at single times.
///
/// Such a mesh is at rest in no frame, so segments are certified in space and time. Between two stored positions, the
/// particle and all vertices move on straight lines (MeshMoment::position()), and no key of the mesh lies in between.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
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

/// Returns the box of a triangle's motion.
[[nodiscard]] Box3 box_of(const MovingTriangle& triangle);
/// Returns the box of a segment, grown by the radius of the sphere that moves along it.
[[nodiscard]] Box3 box_of(const StoredPosition& from, const StoredPosition& to, double radius);

/// A triangle of a deforming mesh at one time, in the world. Functions with the names of CollisionWorld's functions do
/// the same. A triangle without area consists of edges only, and has the z axis as its normal.
struct DeformedTriangle {
    Vec3 a;
    Vec3 b;
    Vec3 c;

    [[nodiscard]] CollisionWorld::Nearest nearest(const Vec3& p) const;
    [[nodiscard]] double signed_distance_from(const Vec3& p) const;
    [[nodiscard]] Vec3 unit_normal() const;
    [[nodiscard]] int side_of(const Vec3& p) const;
    /// Returns the displacement, in m, of the triangle's point nearest to p, from this shape to the shape `later`.
    [[nodiscard]] Vec3 displacement_of(const Vec3& p, const DeformedTriangle& later) const;
};

/// One deforming mesh. Queries are safe from any number of threads, but not during begin_step().
class DeformingMesh {
public:
    /// Applies the placement to the motion. Throws InputError if motion and mesh differ, or beyond 1e75 m.
    DeformingMesh(const ColliderDescription& description, std::size_t collider, SurfaceId first_surface);

    [[nodiscard]] std::size_t collider() const { return collider_; }
    [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
    [[nodiscard]] const std::shared_ptr<const MeshMotion>& motion() const { return motion_; }
    [[nodiscard]] TriangleMesh mesh_at(double time) const;

    /// Begins a step over [begin, end], in s. "The step" below is this one. `boxes` is scratch memory.
    void begin_step(double begin, double end, std::vector<Box3>& boxes);
    /// Returns the contact offset on the mesh, in m, for the largest coordinate of the vertices in the step.
    [[nodiscard]] double offset() const { return offset_; }
    /// Returns a tree of boxes, one per solid triangle, that contain the triangles during the step.
    [[nodiscard]] const BoxTree& tree() const { return tree_; }
    /// Returns the number of triangles with three different vertices. Collisions ignore others, which have no area.
    [[nodiscard]] std::size_t solid_count() const { return solid_.size(); }
    [[nodiscard]] SurfaceId solid_surface(std::size_t k) const { return first_surface_ + solid_[k]; }

    // Triangles at times, in s, which may be outside the step.

    [[nodiscard]] DeformedTriangle triangle_at(SurfaceId surface, double time) const;
    /// Returns the straight motion of a triangle between two times, for space-time segments.
    [[nodiscard]] MovingTriangle between(SurfaceId surface, double begin, double end) const;
    /// Returns the velocities of the corners, in m/s.
    [[nodiscard]] std::array<Vec3, 3> corner_velocities(SurfaceId surface, double time) const;
    /// Motion of a triangle and of its point nearest to a position; at a key time, up to rounding, after the key.
    struct Motion {
        Vec3 velocity;  ///< velocity of that point, in m/s
        Vec3 turning;   ///< angular velocity of the triangle, in rad/s, including rotation about its normal
    };
    [[nodiscard]] Motion motion_at(SurfaceId surface, const Vec3& p, double time) const;

    /// Returns true if a space-time segment stays clear of a triangle. This is the exact certificate. Returns false if
    /// a key lies between the two times and the triangle is near.
    [[nodiscard]] bool is_free(SurfaceId surface, const StoredPosition& from, const StoredPosition& to,
                               double radius) const;
    /// See DeformingColliders::is_late_segment_free().
    [[nodiscard]] bool is_late_segment_free(const StoredPosition& from, const StoredPosition& to, double radius) const;

private:
    [[nodiscard]] MeshMoment moment_at(double time) const;
    [[nodiscard]] const Triangle& triangle(SurfaceId surface) const { return triangles_[surface - first_surface_]; }

    std::size_t collider_;
    SurfaceId first_surface_;
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> solid_;  ///< triangles with three different vertices
    std::shared_ptr<const MeshMotion> motion_;
    double begin_ = 0.0;  ///< s, start of the step
    double end_ = 0.0;
    MeshMoment at_begin_;
    MeshMoment at_end_;
    BoxTree tree_;
    double offset_ = 0.0;
    /// Vertex positions if the mesh is at rest in the step of `tree_`: before its first key or after its last one.
    const Vec3* resting_vertices_ = nullptr;
};

}  // namespace ricochet
