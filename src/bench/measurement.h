/// \file
/// Measures a case: the simulation and, on the same stretches, what the ray library does by itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/cases.h"

namespace ricochet::bench {

/// A case with a number of threads, measured. Rates are those of the median time of the repeats, ratios the median of
/// the repeats' ratios.
struct Row {
    std::string suite;
    std::string name;
    std::string response;
    std::size_t particles = 0;
    std::size_t triangles = 0;
    int threads = 0;
    std::uint64_t steps = 0;
    std::uint64_t particle_steps = 0;
    std::uint64_t contacts = 0;
    double seconds = 0.0;  ///< of all steps together
    double particle_steps_per_second = 0.0;
    double contacts_per_second = 0.0;
    double raw_rays_per_second = 0.0;         ///< one ray at a time, particles in arbitrary order
    double ratio_raw = 0.0;                   ///< particle-steps over raw rays in the same time
    double raw_sorted_rays_per_second = 0.0;  ///< packets of sixteen, particles in spatial order
    double ratio_raw_sorted = 0.0;
    double native_bounces_per_second = 0.0;      ///< of the usual bounce loop
    std::optional<double> ratio_native_bounces;  ///< contacts over native bounces; nothing where none bounces
    /// Particles that the bounce loop has brought outside a closed mesh; nothing where the mesh has no inside.
    std::optional<std::uint64_t> leaks;
    std::uint64_t state_hash = 0;
    double bytes_per_particle = 0.0;
    double bytes_per_triangle = 0.0;
};

/// How a case is measured.
struct MeasurementPlan {
    std::vector<int> threads = {0};  ///< numbers of worker threads, one row each; 0: all
    std::uint32_t repeats = 5;       ///< >= 1
};

/// Where a measurement is.
struct Progress {
    int threads = 0;           ///< 0: still preparing
    std::uint32_t repeat = 0;  ///< from 1
    std::string_view doing;    ///< what runs next
};

/// Called between any two pieces of work; false ends the measurement.
using Hook = std::function<bool(const Progress&)>;

/// Measures the case. Every repeat starts from the state after the warm-up and times the simulation and the references
/// one after the other, so that noise hits all alike. The references run on the straight stretches from up to
/// kMostSnapshots states of the measured steps, particles in the order of their ids. Nothing when the hook has ended
/// it. Throws RunError when a repeat ends in another state than the others.
[[nodiscard]] std::optional<std::vector<Row>> measure_case(const Case& c, const MeasurementPlan& plan,
                                                           const Hook& hook = {});

inline constexpr std::uint64_t kMostSnapshots = 4;

}  // namespace ricochet::bench
