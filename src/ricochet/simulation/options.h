/// \file
/// The options of a simulation.
#pragma once

#include <cstdint>
#include <optional>

#include "ricochet/response/settings.h"

namespace ricochet {

/// Default for the largest number of living particles. They need some forty gigabytes, about the memory of the largest
/// single-processor machines. The number is fixed, so that all machines refuse the same births.
inline constexpr std::uint64_t kDefaultMostParticles = 100'000'000;

/// Options for the time steps, for the response to impacts, and for the recorded data of a run.
struct SimulationOptions : ResponseSettings {
    /// Simulated time, in s, >= 0. The number of steps is ceil(duration / time_step - 1e-6), and at least 1 if the
    /// duration is above 0. The last step ends at the duration.
    double duration = 1.0;
    ResponseKind response = ResponseKind::exact;  ///< method that resolves impacts
    bool record_contacts = false;                 ///< record every impact of the last step, see contact_records()
    /// Check every segment, side and distance with independent code, see verify/verifier.h, without changing results.
    bool verify = false;
    bool triangle_totals = true;   ///< record hits and impulse per triangle (56 bytes per triangle)
    double frame_rate = 24.0;      ///< frames per second for emission rates per frame, > 0
    std::uint32_t max_depth = 16;  ///< highest generation of particles spawned by particles; 0: none are spawned
    /// Largest number of living particles, < 2^32. Births beyond it are refused and counted.
    std::uint64_t most_particles = kDefaultMostParticles;
    /// Contact between spheres, only with the exact response. Without it, spheres pass through each other, as points
    /// do.
    std::optional<PairContactSettings> particle_contacts = std::nullopt;
};

/// Accelerations of a simulation, which change no bit. Tests and benchmarks can switch off each of them separately.
struct AccelerationSwitches {
    bool look_ahead = true;      ///< particles that certainly hit nothing are not queried
    bool deferred_steps = true;  ///< steps of free flights are integrated together, see Simulation::advance()
    bool sleeping = true;        ///< particles held at rest by steady forces cost nothing
    bool spatial_order = true;   ///< neighbours in space are queried one after the other
    bool culling = true;         ///< the broad phase proposes candidates of a path, instead of every triangle
};

}  // namespace ricochet
