/// \file
/// summary.json: what came out of a run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// One collider's totals over the run.
struct ColliderSummary {
    std::string name;
    std::string type;  ///< see type_name()
    std::string file;  ///< the collider's file in the run's folder
    std::uint64_t triangles = 0;
    std::uint64_t hits = 0;
    Vec3 impulse;  ///< N s
};

/// Everything that summary.json says.
struct RunSummary {
    std::string version;  ///< of ricochet
    std::string scene;    ///< the scene file as it was named
    int threads = 0;
    std::string response;  ///< by which impacts were answered
    std::uint64_t seed = 0;
    double time_step = 0.0;       ///< s
    double simulated_time = 0.0;  ///< s
    double wall_seconds = 0.0;
    double output_seconds = 0.0;  ///< of them on output: what the simulation spent on it or waiting for it
    std::uint64_t frames = 0;
    bool interrupted = false;
    std::optional<std::string> diverged;  ///< why the run stopped, where its numbers became nonsense
    std::uint64_t particles_alive = 0;
    SimulationStatistics statistics;
    std::optional<std::uint64_t> leaks;      ///< violations that a verified run found; nothing without --verify
    double kinetic_energy = 0.0;             ///< J
    std::optional<double> potential_energy;  ///< J; nothing where a force has no potential
    std::uint64_t state_hash = 0;
    std::uint64_t peak_memory_bytes = 0;
    std::vector<ColliderSummary> colliders;
};

/// What the simulation itself knows for its summary; the colliders' files are left empty.
[[nodiscard]] RunSummary summarize(const Simulation& simulation);
/// The JSON text of summary.json. Numbers that are not finite become null.
[[nodiscard]] std::string summary_text(const RunSummary& summary);

}  // namespace ricochet
