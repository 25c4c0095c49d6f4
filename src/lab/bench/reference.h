/// \file
/// References of a case: work of Embree alone on the segments of the simulation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lab/bench/native_rays.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::bench {

/// Returns the indices of the points in the order of a Z-curve. The curve fills a cube around the points, with 2^21
/// cells per axis. Points in the same cell keep their order. Points must be finite. Source: G. M. Morton, "A Computer
/// Oriented Geodetic Data Base", IBM, 1966.
[[nodiscard]] std::vector<std::uint32_t> morton_order(std::span<const Vec3> points);

// Work of Embree alone on a case's segments, prepared for timing.

/// Rays and flights, in arbitrary and in spatial order. The constructor converts the rays to single precision and sorts
/// them, so this work is not timed.
class Reference {
public:
    /// `states` has the flights of some states of the simulation. The flights of a state are in the arbitrary order of
    /// its particles.
    Reference(const TriangleMesh& mesh, const std::vector<std::vector<Flight>>& states,
              const NativeRays::BounceRules& rules);

    /// Traces one ray per flight, one ray at a time, in arbitrary order.
    void trace() { rays_.trace(segments_, hits_); }
    /// Traces the same rays in packets of sixteen, with the rays of each state in spatial order.
    void trace_sorted() { rays_.trace_packets(sorted_segments_, hits_); }
    /// Runs the usual bounce loop, in arbitrary order.
    void bounce() { bounces_ = rays_.bounce(flights_, rules_, ends_); }

    /// Runs the bounce loop and counts the flights that end outside a closed mesh. `kernel_point` is the kernel point
    /// of the mesh, see kernel_point_of().
    void count_leaks(const TriangleMesh& mesh, const Vec3& kernel_point);

    [[nodiscard]] std::size_t rays() const { return flights_.size(); }
    /// Returns the number of bounces of the last call of bounce().
    [[nodiscard]] std::uint64_t bounces() const { return bounces_; }
    /// Returns the number of flights that count_leaks() counted, or std::nullopt before its first call.
    [[nodiscard]] std::optional<std::uint64_t> leaks() const { return leaks_; }

private:
    NativeRays rays_;
    NativeRays::BounceRules rules_;
    std::vector<Flight> flights_;
    std::vector<RaySegment> segments_;
    std::vector<RaySegment> sorted_segments_;
    std::vector<std::uint32_t> hits_;
    std::vector<Vec3> ends_;
    std::uint64_t bounces_ = 0;
    std::optional<std::uint64_t> leaks_;
};

}  // namespace ricochet::bench
