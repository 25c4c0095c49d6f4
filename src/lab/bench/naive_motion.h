/// \file
/// The usual method for moving colliders: all triangles at their positions at the end of a step, and one ray per
/// particle. It runs no code of the sweep.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lab/bench/native_rays.h"
#include "ricochet/collision/collider.h"
#include "ricochet/core/frame_tree.h"

namespace ricochet::bench {

/// Moving colliders with the usual method. At every step, their triangles are moved to their positions at its end, and
/// Embree refits its hierarchy. Each particle traces one ray to the end of its path. If the ray hits a surface, the
/// particle bounces relative to that surface and loses the rest of its step. A surface that moves over a particle
/// between two steps is missed.
class NaiveMotion {
public:
    /// All colliders must be meshes. Throws RunError if memory is insufficient.
    NaiveMotion(const std::vector<ColliderDescription>& colliders, std::shared_ptr<const FrameTree> frames);
    ~NaiveMotion();
    NaiveMotion(NaiveMotion&&) noexcept;
    NaiveMotion& operator=(NaiveMotion&&) noexcept;

    struct Steps {
        double begin = 0.0;  ///< in s
        double time_step = 0.0;
        std::uint64_t count = 0;
        double restitution = 1.0;
    };
    /// Moves all flights. Returns the number of bounces.
    [[nodiscard]] std::uint64_t run(std::span<Flight> flights, const Steps& steps);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet::bench
