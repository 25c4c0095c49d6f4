/// \file
/// What a case is measured by: Embree alone on the same segments, and rays in spatial order.
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

/// Indices of the points along the Z-curve through the cube of their box, 2^21 cells an axis; equal cells in the order
/// of the list. Points must be finite. Source: G. M. Morton, "A Computer Oriented Geodetic Data Base", IBM, 1966.
[[nodiscard]] std::vector<std::uint32_t> morton_order(std::span<const Vec3> points);

// The work that Embree does by itself on a case's segments, ready to be timed.

/// Rays and flights, in arbitrary and in spatial order. What can be prepared is prepared: rays are single precision
/// already, and sorting takes no part in what is timed.
class Reference {
public:
    /// The flights of some states of the simulation, as it has them: in arbitrary order.
    Reference(const TriangleMesh& mesh, const std::vector<std::vector<Flight>>& states,
              const NativeRays::BounceRules& rules);

    /// One ray a flight, one at a time, in arbitrary order.
    void trace() { rays_.trace(segments_, hits_); }
    /// The same rays, each state's in spatial order, in packets of sixteen.
    void trace_sorted() { rays_.trace_packets(sorted_segments_, hits_); }
    /// The usual bounce loop, in arbitrary order.
    void bounce() { bounces_ = rays_.bounce(flights_, rules_, ends_); }

    /// Lets every flight bounce and counts those that end outside a closed mesh, seen from its heart.
    void count_leaks(const TriangleMesh& mesh, const Vec3& heart);

    [[nodiscard]] std::size_t rays() const { return flights_.size(); }
    /// Of the last bounce().
    [[nodiscard]] std::uint64_t bounces() const { return bounces_; }
    /// Nothing before count_leaks().
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
