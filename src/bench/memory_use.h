/// \file
/// What a case's simulation holds of the process's memory.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bench/cases.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::bench {

/// Bytes that the process has allocated and not freed; 0 where the allocator does not tell.
[[nodiscard]] std::uint64_t allocated_bytes();

/// Hands back to the system what has been freed, so that one case's memory is not there twice in the next.
void return_freed_memory();

/// What a case's simulation holds after a step.
struct MemoryUse {
    /// With what the step itself keeps for the next one; of the search structures for spheres only what the ray
    /// library does not map past the allocator.
    double bytes_per_particle = 0.0;
    double bytes_per_triangle = 0.0;  ///< with the mesh and its search structures, without totals per triangle
};

/// Builds the case's simulation with and without its particles and looks at what it has allocated.
[[nodiscard]] MemoryUse measure_memory(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh,
                                       const std::vector<Particle>& particles);

}  // namespace ricochet::bench
