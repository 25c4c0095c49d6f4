/// \file
/// Surfaces of all colliders at the times of a path: at rest, in moving frames, and of deforming meshes. Also the
/// positions on that path: as stored in world coordinates, and in the coordinates of its frame.
#pragma once

#include <algorithm>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// A position on a path.
struct PathPoint {
    Vec3 position;      ///< in m, in the frame of the path
    double time = 0.0;  ///< in s along the path
    Vec3 world{};       ///< in m, as stored in the world; `position` is its local position in the frame
};

/// Conversion from the times of a path to simulation times. Times are in s.
struct PathClock {
    double begin = 0.0;     ///< simulation time at the start of the path
    double end = 0.0;       ///< simulation time at the end of the path
    double base = 0.0;      ///< simulation time to which path times are added
    double offset = 0.0;    ///< start of the path within a longer path of which it is a piece
    double duration = 0.0;  ///< duration of the path

    [[nodiscard]] double at(double s) const {
        if (s <= 0.0) return begin;
        if (s >= duration) return end;
        return std::clamp(base + (offset + s), begin, end);
    }
    /// Returns the clock of a piece of the path.
    [[nodiscard]] PathClock piece(double from, double to) const {
        return {at(from), at(to), base, offset + from, to - from};
    }
};

/// Queries of surfaces at the times of a path. Depending on its body, a surface is at rest, moves with the frame of the
/// body, or belongs to a deforming mesh. Results are in the frame of the path, which is that of a body with a frame, or
/// the world (kWorldBody). Times `s` are in s along the path.
class SurfacesInTime {
public:
    SurfacesInTime(const MovingColliders& bodies, BodyId reference, const PathClock& clock)
        : bodies_(&bodies), reference_(reference), clock_(clock) {}
    /// Creates the surfaces at a single simulation time, in s. All times along the path are converted to it.
    SurfacesInTime(const MovingColliders& bodies, BodyId reference, double time)
        : SurfacesInTime(bodies, reference, {time, time, time, 0.0, 0.0}) {}

    [[nodiscard]] const MovingColliders& bodies() const { return *bodies_; }
    [[nodiscard]] BodyId reference() const { return reference_; }
    [[nodiscard]] const PathClock& clock() const { return clock_; }

    // Positions and directions.

    /// Returns the stored position nearest to a point in the frame of the path.
    [[nodiscard]] PathPoint point_at(const Vec3& p, double s) const;
    /// Returns the path point of a stored position.
    [[nodiscard]] PathPoint stored(const Vec3& world, double s = 0.0) const {
        return {local_position(reference_, world, s), s, world};
    }
    /// Returns the position of a path point in the world, with its simulation time.
    [[nodiscard]] StoredPosition stored_position(const PathPoint& p) const { return {p.world, clock_.at(p.time)}; }
    /// Returns the local position of a stored position in a body's coordinates.
    [[nodiscard]] Vec3 local_position(BodyId body, const Vec3& world, double s) const {
        return bodies_->local_position(body, world, clock_.at(s));
    }
    /// Converts a direction from a body's axes to the axes of this frame.
    [[nodiscard]] Vec3 direction_from(BodyId body, const Vec3& d, double s) const;
    /// Selects the velocity before or after a jump. Velocities may jump at a key of a frame.
    enum class Limit { before, after };
    /// Returns the velocity, in a body's coordinates, of a point with the given velocity in this frame.
    [[nodiscard]] Vec3 velocity_in(BodyId body, const PathPoint& at, const Vec3& velocity,
                                   Limit limit = Limit::after) const;

    // One surface. Functions with the names of CollisionWorld's functions do the same.

    [[nodiscard]] CollisionWorld::Nearest nearest(SurfaceId surface, const PathPoint& p) const;
    [[nodiscard]] double signed_distance_from(SurfaceId surface, const PathPoint& p) const;
    [[nodiscard]] Vec3 unit_normal_of(SurfaceId surface, const PathPoint& p) const;
    [[nodiscard]] int side_of_surface(SurfaceId surface, const PathPoint& p) const;
    [[nodiscard]] bool is_flat(SurfaceId surface) const;
    [[nodiscard]] bool is_shape(SurfaceId surface) const;
    /// Returns the contact offset, in m, for a position next to a surface.
    [[nodiscard]] double offset_at(SurfaceId surface, const PathPoint& p) const;
    /// Returns the velocity, in m/s, of the surface's material point at a point of the world.
    [[nodiscard]] Vec3 velocity_of(SurfaceId surface, const PathPoint& at) const;
    /// Returns the angular velocity of the surface at that point, in rad/s.
    [[nodiscard]] Vec3 angular_velocity_of(SurfaceId surface, const PathPoint& at) const;

private:
    [[nodiscard]] BodyId body_of(SurfaceId surface) const { return bodies_->body_of(surface); }
    [[nodiscard]] bool deforms(SurfaceId surface) const { return bodies_->is_deforming(body_of(surface)); }
    [[nodiscard]] const CollisionWorld& world_of(SurfaceId surface) const { return bodies_->world(body_of(surface)); }
    [[nodiscard]] Vec3 seen_by(SurfaceId surface, const PathPoint& p) const {
        return local_position(body_of(surface), p.world, p.time);
    }
    [[nodiscard]] DeformedTriangle triangle_at(SurfaceId surface, double s) const {
        return bodies_->deforming().triangle_at(surface, clock_.at(s));
    }
    [[nodiscard]] DeformingMesh::Motion deformation_of(SurfaceId surface, const PathPoint& at) const {
        return bodies_->deforming().mesh_with(surface).motion_at(surface, at.world, clock_.at(at.time));
    }

    const MovingColliders* bodies_;
    BodyId reference_;
    PathClock clock_;
};

}  // namespace ricochet
