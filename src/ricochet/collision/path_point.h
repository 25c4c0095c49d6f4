/// \file
/// Positions on the path of a particle: as stored, in world coordinates, and in the coordinates of a frame.
#pragma once

#include <algorithm>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// A position on a path.
struct PathPoint {
    Vec3 position;      ///< in m, in the frame of the path
    double time = 0.0;  ///< in s along the path
    Vec3 world{};       ///< in m, as stored; `position` is its local position in the frame
};

/// Conversion from the times of a path to simulation times. Times are in s.
struct PathClock {
    double begin = 0.0;     ///< simulation time at the start of the path
    double end = 0.0;       ///< simulation time at the end of the path
    double base = 0.0;      ///< simulation time that path times are added to
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

/// Conversions between the frame of a path and the frames of bodies. The path's frame is that of a body, or the world
/// (kWorldBody).
class MovingView {
public:
    MovingView(const MovingColliders& bodies, BodyId reference, const PathClock& clock)
        : bodies_(&bodies), reference_(reference), clock_(clock) {}

    [[nodiscard]] const MovingColliders& bodies() const { return *bodies_; }
    [[nodiscard]] BodyId reference() const { return reference_; }
    [[nodiscard]] const PathClock& clock() const { return clock_; }

    /// Returns the stored position nearest to a point of the frame.
    [[nodiscard]] PathPoint point_at(const Vec3& p, double s) const {
        if (reference_ == kWorldBody) return {p, s, p};
        const MovingPose pose = bodies_->pose(reference_, clock_.at(s));
        const Vec3 world = flush_tiny(pose.point(p));
        return {pose.local_position(world), s, world};
    }
    /// Returns the way point of a stored position.
    [[nodiscard]] PathPoint stored(const Vec3& world, double s) const {
        return {local_position(reference_, world, s), s, world};
    }
    /// Returns the local position of a stored position in a body's coordinates.
    [[nodiscard]] Vec3 local_position(BodyId body, const Vec3& world, double s) const {
        return body == kWorldBody ? world : bodies_->local_position(body, world, clock_.at(s));
    }
    /// Converts a direction from a body's axes to the axes of this frame.
    [[nodiscard]] Vec3 direction_from(BodyId body, const Vec3& d, double s) const;
    /// Selects the velocity before or after a jump. Velocities may jump at a key of a frame.
    enum class Limit { before, after };
    /// Returns the velocity, in a body's coordinates, of a point of the world that has the given velocity in this
    /// frame.
    [[nodiscard]] Vec3 velocity_in(BodyId body, const PathPoint& at, const Vec3& velocity,
                                   Limit limit = Limit::after) const;
    /// Returns the velocity, in this frame, of the material point of a body at a point of the world.
    [[nodiscard]] Vec3 velocity_of(BodyId body, const PathPoint& at) const;

private:
    const MovingColliders* bodies_;
    BodyId reference_;
    PathClock clock_;
};

}  // namespace ricochet
