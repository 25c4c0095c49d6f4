/// \file
/// Embree alone, as the reference of the benchmark's ratios: native float triangles, robust traversal, no certificate.
/// It runs no code of the sweep.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::bench {

/// Triangle number of a ray without a hit.
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFU;

/// A ray in Embree's format.
struct RaySegment {
    std::array<float, 3> from;   ///< in m
    std::array<float, 3> along;  ///< offset to the other end, in m
};

/// A particle that moves in a straight line.
struct Flight {
    Vec3 position;  ///< in m
    Vec3 velocity;  ///< in m/s
};

/// A mesh in Embree's own form. Safe from any number of threads; every loop uses all of them.
class NativeRays {
public:
    /// The mesh may be destroyed afterwards. Throws RunError if memory is insufficient.
    explicit NativeRays(const TriangleMesh& mesh);
    ~NativeRays();
    NativeRays(NativeRays&&) noexcept;
    NativeRays& operator=(NativeRays&&) noexcept;

    /// Writes the first triangle that each segment hits, or kNoTriangle. It traces one ray at a time, in the given
    /// order.
    void trace(std::span<const RaySegment> segments, std::span<std::uint32_t> triangles) const;
    /// Writes the first triangle that each segment hits, or kNoTriangle. It traces packets of sixteen consecutive rays.
    void trace_packets(std::span<const RaySegment> segments, std::span<std::uint32_t> triangles) const;

    /// Rules for bounces of flights.
    struct BounceRules {
        double duration = 0.0;     ///< in s
        double restitution = 1.0;  ///< of every surface
    };
    /// Moves every particle in straight lines from bounce to bounce. Hits are refined in double precision on the plane
    /// of the hit triangle. The next ray starts at a small offset along the normal. Writes the end positions and
    /// returns the number of bounces. Particles may pass through walls.
    [[nodiscard]] std::uint64_t bounce(std::span<const Flight> flights, const BounceRules& rules,
                                       std::span<Vec3> ends) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet::bench
