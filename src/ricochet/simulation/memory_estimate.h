/// \file
/// Private to the library: how much memory a simulation needs, told from its setup before it is made.
///
/// Numbers are about what a run with frames has at its peak, measured (the peak_memory_bytes of summaries) and rounded
/// up; they count what is sure to be there: particles that surfaces, bounds or shattering may retire count for one
/// step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// Something that a setup asks memory for.
struct MemoryNeed {
    enum class Part { particles, springs, emitter, collider, contacts } part = Part::particles;
    std::size_t number = 0;   ///< of the emitter or collider
    std::uint64_t count = 0;  ///< particles, springs, triangles or contact records
    double bytes = 0.0;
};

/// What a simulation needs.
struct MemoryEstimate {
    std::vector<MemoryNeed> needs;
    double taken = 0.0;  ///< bytes of them that the setup itself holds, or that its making needed

    /// All together, with what the program takes by itself.
    [[nodiscard]] double bytes() const;
    /// Without what is taken already.
    [[nodiscard]] double bytes_to_come() const { return bytes() - taken; }
    /// The one that asks for most; needs must not be empty.
    [[nodiscard]] const MemoryNeed& largest() const;
};

/// What a setup needs. Throws InputError where an emitter's area on the screen has none (screen_area()).
[[nodiscard]] MemoryEstimate estimate_memory(const SimulationSetup& setup);

/// Throws InputError that names the largest part where a setup needs more than memory_limit().
void require_memory(const SimulationSetup& setup);

/// Bytes for one particle more in a simulation of this setup.
[[nodiscard]] double bytes_per_particle(const SimulationSetup& setup);

/// Throws RunError: births would make more particles of so many bytes each than the memory holds. living: those that
/// are there.
[[noreturn]] void refuse_to_grow(std::uint64_t living, double bytes_each);

/// Bytes for particles that springs join, and for these springs, from their making on.
[[nodiscard]] double bytes_of_springs(double particles, double springs, IntegratorKind integrator);

}  // namespace ricochet
