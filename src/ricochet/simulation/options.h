/// \file
/// The options of a simulation.
#pragma once

#include <cstdint>
#include <optional>

#include "ricochet/response/settings.h"

namespace ricochet {

/// Particles that may live at a time unless a setup says otherwise: some forty gigabytes, about what the largest
/// machines of one processor hold, and more than any run has needed. A fixed number, so that which births are refused
/// does not depend on the machine.
inline constexpr std::uint64_t kDefaultMostParticles = 100'000'000;

/// How time is stepped, how impacts are answered, and what is kept of a run.
struct SimulationOptions : ResponseSettings {
    /// s, >= 0; steps = ceil(duration / time_step - 1e-6), at least 1 above 0; the last one ends there.
    double duration = 1.0;
    ResponseKind response = ResponseKind::exact;  ///< how impacts are answered
    bool record_contacts = false;                 ///< keep every impact of the last step, see contact_records()
    /// Check every segment, side and distance by code of its own, see verify/verifier.h. The same bits as without it.
    bool verify = false;
    bool triangle_totals = true;   ///< keep hits and impulse per triangle (56 bytes each)
    double frame_rate = 24.0;      ///< frames a second of emission rates per frame, > 0
    std::uint32_t max_depth = 16;  ///< highest generation of particles spawned by particles; 0: none are
    /// Living at a time, < 2^32; births beyond are refused and counted.
    std::uint64_t most_particles = kDefaultMostParticles;
    /// Spheres meet each other, with the exact response; nothing: they pass through each other. Points never meet.
    std::optional<PairContactSettings> particle_contacts = std::nullopt;
};

/// What makes a simulation faster, each to be switched off by itself: for tests and benchmarks. The bits of every
/// result are the same without it.
struct AccelerationSwitches {
    bool look_ahead = true;      ///< particles that certainly hit nothing are not queried
    bool deferred_steps = true;  ///< steps of free flights are made together, see Simulation::advance()
    bool sleeping = true;        ///< particles held at rest by steady forces cost nothing
    bool spatial_order = true;   ///< neighbours in space are queried one after the other
    bool culling = true;         ///< the broad phase proposes candidates; false: every triangle is one of every path
};

}  // namespace ricochet
