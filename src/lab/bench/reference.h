/// \file
/// References of a case: Embree alone on the same segments, in arbitrary and in spatial order.
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

/// Returns the indices of the points along the Z-curve through the cube of their box, with 2^21 cells per axis. Points
/// in equal cells keep the order of the list. Points must be finite. Source: G. M. Morton, "A Computer Oriented
/// Geodetic Data Base", IBM, 1966.
[[nodiscard]] std::vector<std::uint32_t> morton_order(std::span<const Vec3> points);

// The work of Embree alone on a case's segments, ready to be timed.

/// Rays and flights, in arbitrary and in spatial order. Preparation is not part of the timed work: rays are already in
/// single precision and sorted.
class Reference {
public:
    /// `states` are the flights of some states of the simulation, in the arbitrary order of its particles.
    Reference(const TriangleMesh& mesh, const std::vector<std::vector<Flight>>& states,
              const NativeRays::BounceRules& rules);

    /// Traces one ray per flight, one at a time, in arbitrary order.
    void trace() { rays_.trace(segments_, hits_); }
    /// Traces the same rays in packets of sixteen. The rays of each state are in spatial order.
    void trace_sorted() { rays_.trace_packets(sorted_segments_, hits_); }
    /// Runs the usual bounce loop, in arbitrary order.
    void bounce() { bounces_ = rays_.bounce(flights_, rules_, ends_); }

    /// Runs the bounce loop and counts the flights that end outside a closed mesh with the given heart.
    void count_leaks(const TriangleMesh& mesh, const Vec3& heart);

    [[nodiscard]] std::size_t rays() const { return flights_.size(); }
    /// Returns the count of the last bounce().
    [[nodiscard]] std::uint64_t bounces() const { return bounces_; }
    /// Returns the count of count_leaks(); nothing before its first call.
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
