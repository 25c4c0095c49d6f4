/// \file
/// What Embree does by itself, as the reference that the benchmark divides by: native float triangles, robust
/// traversal, no certificate. None of the sweep's code runs here.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::bench {

/// Instead of a triangle's number: none.
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFU;

/// A ray as Embree takes it.
struct RaySegment {
    std::array<float, 3> from;   ///< m
    std::array<float, 3> along;  ///< m, to the other end
};

/// A particle that flies straight on.
struct Flight {
    Vec3 position;  ///< m
    Vec3 velocity;  ///< m/s
};

/// A mesh in Embree's own form. Safe from any number of threads; every loop uses all of them.
class NativeRays {
public:
    /// The mesh need not outlive it. Throws RunError when memory is short.
    explicit NativeRays(const TriangleMesh& mesh);
    ~NativeRays();
    NativeRays(NativeRays&&) noexcept;
    NativeRays& operator=(NativeRays&&) noexcept;

    /// The first triangle that each segment hits, kNoTriangle where none; one ray at a time, in the order given.
    void trace(std::span<const RaySegment> segments, std::span<std::uint32_t> triangles) const;
    /// The same in packets of sixteen neighbours of the list.
    void trace_packets(std::span<const RaySegment> segments, std::span<std::uint32_t> triangles) const;

    /// How flights bounce.
    struct BounceRules {
        double duration = 0.0;     ///< s
        double restitution = 1.0;  ///< of every surface
    };
    /// Flies every particle straight on from bounce to bounce: the hit is sharpened in double precision on the plane of
    /// the triangle hit, and the next ray starts a little off it along the normal. Writes where each ends and
    /// returns the number of bounces. It may pass through walls.
    [[nodiscard]] std::uint64_t bounce(std::span<const Flight> flights, const BounceRules& rules,
                                       std::span<Vec3> ends) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet::bench
