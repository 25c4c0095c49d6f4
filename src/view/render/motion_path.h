/// \file
/// Path of a particle between two frames of a run, interpolated from the states in both frames and the impacts between
/// them.
#pragma once

#include <span>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Position and velocity of the particle at one time. The velocities before and after this time differ only at an
/// impact.
struct PathNode {
    double time = 0.0;  ///< s
    Vec3 position;      ///< m
    Vec3 velocity_before;
    Vec3 velocity_after;
};

/// Returns the position of the particle at a time, in s. Between two nodes, the path is the cubic Hermite polynomial of
/// their positions and velocities, which is exact for constant acceleration. Before the first node and after the last
/// node, the path is straight. `nodes` must contain at least one node and be in order of time.
[[nodiscard]] Vec3 position_on_path(std::span<const PathNode> nodes, double time);

/// Point of a path, and its time.
struct MotionPathPoint {
    double time = 0.0;  ///< s
    Vec3 position;      ///< m
};

/// Returns the path from `from` to the later time `to` as points. The points contain both ends and every node between
/// them. More points between two nodes limit the distance of the path from the lines between the points to `sagitta`,
/// in m. There are at most 64 lines between two nodes, even if the limit needs more.
[[nodiscard]] std::vector<MotionPathPoint> path_points(std::span<const PathNode> nodes, double from, double to,
                                                       double sagitta);

}  // namespace ricochet
