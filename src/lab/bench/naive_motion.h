/// \file
/// Usual method for moving colliders, as a reference for the benchmark. It uses Embree without any code of the
/// library's sweep.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lab/bench/native_rays.h"
#include "ricochet/collision/collider.h"
#include "ricochet/core/frame_tree.h"

namespace ricochet::bench {

/// Simulation of moving colliders with the usual method. In each step, the triangles move to their positions at the end
/// of the step, and Embree refits its hierarchy. Each particle traces one ray along its path. If the ray hits a
/// surface, the particle is reflected relative to the surface's velocity and loses the rest of its step. Collisions are
/// missed if a surface moves over a particle between two steps.
class NaiveMotion {
public:
    /// All colliders must be meshes. Throws RunError if memory is insufficient.
    NaiveMotion(const std::vector<ColliderDescription>& colliders, std::shared_ptr<const FrameTree> frames);
    ~NaiveMotion();
    NaiveMotion(NaiveMotion&&) noexcept;
    NaiveMotion& operator=(NaiveMotion&&) noexcept;

    struct Steps {
        double begin = 0.0;  ///< time of the start of the first step, in s
        double time_step = 0.0;
        std::uint64_t count = 0;
        double restitution = 1.0;
    };
    /// Moves all flights by the given steps. Returns the number of bounces.
    [[nodiscard]] std::uint64_t run(std::span<Flight> flights, const Steps& steps);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet::bench
