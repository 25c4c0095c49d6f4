/// \file
/// The way of a particle between two frames of a run, from what the run knows of it: states, and impacts in between.
#pragma once

#include <span>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A moment of which place and velocity are known. At an impact the two velocities differ; elsewhere they are the same.
struct PathNode {
    double time = 0.0;  ///< s
    Vec3 position;      ///< m
    Vec3 velocity_before;
    Vec3 velocity_after;
};

/// Where the particle is at a time, s: between two nodes on the cubic that has their places and velocities, which is
/// the true path under a constant acceleration; beyond the first and the last on straight lines. nodes: at least one,
/// in the order of time.
[[nodiscard]] Vec3 position_on_path(std::span<const PathNode> nodes, double time);

/// Where the particle is at a moment.
struct PathPoint {
    double time = 0.0;  ///< s
    Vec3 position;      ///< m
};

/// The path from one time to a later one as points: both ends, every node in between, and between them as many that the
/// path bends less than `sagitta`, m, away from the lines that join them (at most 64 a piece).
[[nodiscard]] std::vector<PathPoint> path_points(std::span<const PathNode> nodes, double from, double to,
                                                 double sagitta);

}  // namespace ricochet
