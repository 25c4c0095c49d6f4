/// \file
/// How much memory the process holds right now, and what a simulation takes of it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bench/cases.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/triangle_mesh.h"

namespace ricochet::bench {

/// Resident set of this process, bytes, after the allocator has given back what it can; 0 where the system does not
/// tell.
[[nodiscard]] std::uint64_t resident_memory_bytes();

/// What a case's simulation holds.
struct MemoryUse {
    double bytes_per_particle = 0.0;  ///< after a step
    double bytes_per_triangle = 0.0;  ///< with the mesh and its search structures, without totals per triangle
};

/// Builds the case's simulation with and without its particles and looks at what the process holds. Good to some
/// kilobytes in all.
[[nodiscard]] MemoryUse measure_memory(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh,
                                       const std::vector<Particle>& particles);

}  // namespace ricochet::bench
