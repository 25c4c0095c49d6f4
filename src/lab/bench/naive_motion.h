/// \file
/// What is usually done about colliders that move: all triangles where they are at the end of a step, and one ray a
/// particle. None of the sweep's code runs here.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lab/bench/native_rays.h"
#include "ricochet/collision/collider.h"
#include "ricochet/core/frame_tree.h"

namespace ricochet::bench {

/// Colliders that move, in the usual way: at every step their triangles are put where they are at its end, Embree
/// refits its hierarchy, and each particle has one ray to where it would be. What it hits there it bounces off,
/// relative to the surface, and the rest of its step is lost. What moves over a particle between two steps is not seen.
class NaiveMotion {
public:
    /// Colliders have to be meshes. Throws RunError when memory is short.
    NaiveMotion(const std::vector<ColliderDescription>& colliders, std::shared_ptr<const FrameTree> frames);
    ~NaiveMotion();
    NaiveMotion(NaiveMotion&&) noexcept;
    NaiveMotion& operator=(NaiveMotion&&) noexcept;

    struct Steps {
        double begin = 0.0;  ///< s
        double time_step = 0.0;
        std::uint64_t count = 0;
        double restitution = 1.0;
    };
    /// Moves all flights; returns how many bounces there were.
    [[nodiscard]] std::uint64_t run(std::span<Flight> flights, const Steps& steps);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet::bench
