/// \file
/// Embree alone, as the reference of the benchmark's ratios. It uses Embree's own triangles in single precision with
/// robust traversal. It has no certificates and runs no code of the library's sweep.
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

/// Ray in Embree's format.
struct RaySegment {
    std::array<float, 3> from;   ///< in m
    std::array<float, 3> along;  ///< offset from `from` to the other end, in m
};

/// Particle that moves in a straight line.
struct Flight {
    Vec3 position;  ///< in m
    Vec3 velocity;  ///< in m/s
};

/// Mesh as an Embree geometry. Safe from any number of threads. Each function processes rays with all threads.
class NativeRays {
public:
    /// Copies the mesh. Throws RunError if memory is insufficient.
    explicit NativeRays(const TriangleMesh& mesh);
    ~NativeRays();
    NativeRays(NativeRays&&) noexcept;
    NativeRays& operator=(NativeRays&&) noexcept;

    /// Writes the first triangle that each segment hits, or kNoTriangle. Each thread traces one ray at a time.
    void trace(std::span<const RaySegment> segments, std::span<std::uint32_t> triangles) const;
    /// Writes the first triangle that each segment hits, or kNoTriangle. Each thread traces packets of sixteen
    /// consecutive rays.
    void trace_packets(std::span<const RaySegment> segments, std::span<std::uint32_t> triangles) const;

    /// Rules for bounces of flights.
    struct BounceRules {
        double duration = 0.0;     ///< in s
        double restitution = 1.0;  ///< restitution of every surface
    };
    /// Moves every particle in straight lines from bounce to bounce. Embree finds the hit triangle, and the hit point
    /// is computed in double precision on the triangle's plane. The next ray starts at a small offset along the normal.
    /// Writes the end positions and returns the number of bounces. Particles can pass through walls because of rounding
    /// errors and the offset.
    [[nodiscard]] std::uint64_t bounce(std::span<const Flight> flights, const BounceRules& rules,
                                       std::span<Vec3> ends) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet::bench
