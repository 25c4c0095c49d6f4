/// \file
/// Positions on the way of a particle as they are stored, in the world, and as a frame sees them.
#pragma once

#include <algorithm>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// A position on a path.
struct WayPoint {
    Vec3 position;      ///< m, in the frame that the path is given in
    double time = 0.0;  ///< s along the path
    Vec3 world{};       ///< m, as it is stored; `position` is its image
};

/// The simulation times of a path.
struct PathClock {
    double begin = 0.0;     ///< s, at its start
    double end = 0.0;       ///< s, at its end
    double base = 0.0;      ///< s, to which path times are added
    double offset = 0.0;    ///< s, path time of the start of a longer path that it is a piece of
    double duration = 0.0;  ///< s, of the path

    [[nodiscard]] double at(double s) const {
        if (s <= 0.0) return begin;
        if (s >= duration) return end;
        return std::clamp(base + (offset + s), begin, end);
    }
    /// That of a piece of the path.
    [[nodiscard]] PathClock piece(double from, double to) const {
        return {at(from), at(to), base, offset + from, to - from};
    }
};

/// What is seen from the frame of a body, or from the world (kAtRest), along a path that is given there.
class MovingView {
public:
    MovingView(const MovingColliders& bodies, BodyId home, const PathClock& clock)
        : bodies_(&bodies), home_(home), clock_(clock) {}

    [[nodiscard]] const MovingColliders& bodies() const { return *bodies_; }
    [[nodiscard]] BodyId home() const { return home_; }
    [[nodiscard]] const PathClock& clock() const { return clock_; }

    /// The stored position nearest to a point of the frame.
    [[nodiscard]] WayPoint point_at(const Vec3& p, double s) const {
        if (home_ == kAtRest) return {p, s, p};
        const MovingPose pose = bodies_->pose(home_, clock_.at(s));
        const Vec3 world = flush_tiny(pose.point(p));
        return {pose.image(world), s, world};
    }
    /// A stored position.
    [[nodiscard]] WayPoint stored(const Vec3& world, double s) const { return {image(home_, world, s), s, world}; }
    /// Where a stored position is in a body's coordinates.
    [[nodiscard]] Vec3 image(BodyId body, const Vec3& world, double s) const {
        return body == kAtRest ? world : bodies_->image(body, world, clock_.at(s));
    }
    /// A direction of a body in the axes of this frame.
    [[nodiscard]] Vec3 direction_from(BodyId body, const Vec3& d, double s) const;
    /// Velocity, in a body's coordinates, of what is at a point of the world and moves with a velocity in this frame.
    /// At a key of either frame, where that may jump: `before` it or after.
    enum class Limit { before, after };
    [[nodiscard]] Vec3 velocity_in(BodyId body, const WayPoint& at, const Vec3& velocity,
                                   Limit limit = Limit::after) const;
    /// Velocity, as this frame sees it, of the material point of a body that is at a point of the world.
    [[nodiscard]] Vec3 velocity_of(BodyId body, const WayPoint& at) const;

private:
    const MovingColliders* bodies_;
    BodyId home_;
    PathClock clock_;
};

}  // namespace ricochet
