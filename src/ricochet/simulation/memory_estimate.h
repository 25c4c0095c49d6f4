/// \file
/// Private to the library: estimate of the memory of a simulation from its setup, before the simulation is made.
///
/// The numbers approximate the peak memory of a run with frames, measured as peak_memory_bytes and rounded up. Only
/// certain needs count: the births of one step, if surfaces, bounds or shattering can remove particles.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// Memory that one part of a setup needs.
struct MemoryNeed {
    enum class Part { particles, springs, emitter, collider, contacts } part = Part::particles;
    std::size_t number = 0;   ///< index of the emitter or collider
    std::uint64_t count = 0;  ///< particles, springs, triangles or contact records
    double bytes = 0.0;
};

/// Memory that a simulation needs.
struct MemoryEstimate {
    std::vector<MemoryNeed> needs;
    double taken = 0.0;  ///< bytes of the needs that the setup already contains, or that its construction has needed

    /// Returns the bytes of all needs and of the program itself.
    [[nodiscard]] double bytes() const;
    /// Returns the bytes that are still to be allocated.
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

/// Returns true if particles of a setup can spawn particles.
[[nodiscard]] inline bool has_children(const SimulationSetup& setup) {
    return std::ranges::any_of(setup.emitters, [](const EmitterDescription& e) { return e.parent.has_value(); });
}

/// Returns the number of particles that can be added up to a limit.
[[nodiscard]] inline std::uint64_t room_below(std::uint64_t most, std::uint64_t living) {
    return most - std::min(most, living);
}

/// Number of particles that fit into memory. It decides only whether a run continues, and never affects results.
class ParticleMemory {
public:
    /// bytes_each: memory of an additional particle, in bytes. Until measure() is called, any number of particles fits.
    explicit ParticleMemory(double bytes_each) : bytes_each_(bytes_each) {}

    [[nodiscard]] double bytes_each() const { return bytes_each_; }
    /// Measures the free memory. living: number of particles that live already.
    void measure(std::uint64_t living);
    /// Returns the number of particles that may live at a time; one more ends the run.
    [[nodiscard]] std::uint64_t most() const { return most_; }
    [[nodiscard]] std::uint64_t room(std::uint64_t living) const { return room_below(most_, living); }
    /// Throws RunError with the message that births would make more particles than fit.
    [[noreturn]] void refuse_to_grow(std::uint64_t living) const;

private:
    double bytes_each_;
    std::uint64_t most_ = std::numeric_limits<std::uint64_t>::max();
};

/// Returns the bytes of particles joined by springs, of these springs, and of the data to build both.
[[nodiscard]] double bytes_of_springs(double particles, double springs, IntegratorKind integrator);

}  // namespace ricochet
