/// \file
/// Private to the library: estimate of the memory of a simulation from its setup, before it is made.
///
/// Numbers are about the peak memory of a run with frames, measured (the peak_memory_bytes of summaries) and rounded
/// up. They count only certain needs: particles that surfaces, bounds or shattering may remove count for one step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// A need for memory by a part of a setup.
struct MemoryNeed {
    enum class Part { particles, springs, emitter, collider, contacts } part = Part::particles;
    std::size_t number = 0;   ///< index of the emitter or collider
    std::uint64_t count = 0;  ///< particles, springs, triangles or contact records
    double bytes = 0.0;
};

/// Memory that a simulation needs.
struct MemoryEstimate {
    std::vector<MemoryNeed> needs;
    double taken = 0.0;  ///< bytes of them that the setup itself holds, or that its construction needed

    /// Returns the bytes of all needs and of the program itself.
    [[nodiscard]] double bytes() const;
    /// Returns the bytes without those taken already.
    [[nodiscard]] double bytes_to_come() const { return bytes() - taken; }
    /// Returns the largest need; needs must not be empty.
    [[nodiscard]] const MemoryNeed& largest() const;
};

/// Returns the memory that a setup needs. Throws InputError if an emitter has no area on the screen (screen_area()).
[[nodiscard]] MemoryEstimate estimate_memory(const SimulationSetup& setup);

/// Throws InputError with the name of the largest need if a setup needs more than memory_limit().
void require_memory(const SimulationSetup& setup);

/// Returns the bytes of an additional particle in a simulation of this setup.
[[nodiscard]] double bytes_per_particle(const SimulationSetup& setup);

/// Throws RunError, because births would make more particles, of so many bytes each, than the memory holds. living:
/// number of particles that live already.
[[noreturn]] void refuse_to_grow(std::uint64_t living, double bytes_each);

/// Returns the bytes of particles joined by springs, and of these springs, from their construction on.
[[nodiscard]] double bytes_of_springs(double particles, double springs, IntegratorKind integrator);

}  // namespace ricochet
