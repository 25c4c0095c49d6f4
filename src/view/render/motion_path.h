/// \file
/// Path of a particle between two frames of a run, from the recorded states and the impacts in between.
#pragma once

#include <span>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A time of known position and velocity. The two velocities differ only at an impact.
struct PathNode {
    double time = 0.0;  ///< s
    Vec3 position;      ///< m
    Vec3 velocity_before;
    Vec3 velocity_after;
};

/// Returns the position of the particle at a time, in s.
/// Between two nodes, the path is the cubic through their positions and velocities. It is the true path under a
/// constant acceleration. The path is straight before the first node and after the last. `nodes` must hold at least
/// one node and be in order of time.
[[nodiscard]] Vec3 position_on_path(std::span<const PathNode> nodes, double time);

/// A point of a path with its time.
struct PathPoint {
    double time = 0.0;  ///< s
    Vec3 position;      ///< m
};

/// Returns the path from `from` to the later time `to` as points. The points contain both ends and every node in
/// between. More points keep the path within `sagitta` (m) of the lines between the points, but at most 64 per piece.
[[nodiscard]] std::vector<PathPoint> path_points(std::span<const PathNode> nodes, double from, double to,
                                                 double sagitta);

}  // namespace ricochet
