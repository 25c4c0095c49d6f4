/// \file
/// Measures cases: the simulation, and Embree alone on the same segments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/bench/cases.h"

namespace ricochet::bench {

/// Result for one case and one number of threads. Rates use the median time of the repeats; ratios are the median of
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
    std::optional<double> ratio_native_bounces;  ///< contacts over native bounces; nothing without bounces
    /// Particles that the bounce loop has moved outside a closed mesh. Nothing if the mesh has no inside, and for
    /// responses that let particles enter the wall.
    std::optional<std::uint64_t> leaks;
    std::uint64_t state_hash = 0;
    double bytes_per_particle = 0.0;
    double bytes_per_triangle = 0.0;
    std::optional<double> ratio_points;  ///< time of a particle-step over that of points; nothing without such a case
    std::optional<double> ratio_exact;   ///< time of a particle-step over that of the exact response
    std::optional<double> ratio_rest;    ///< time of a particle-step over that without motion
    std::optional<double> ratio_apart;   ///< time of a particle-step over that without contacts between spheres
    // Set if spheres collide with each other.
    std::optional<double> seconds_a_simulated_second;
    std::optional<double> seconds_an_impact;  ///< between spheres; nothing if none is resolved separately
    std::optional<double> largest_overlap;    ///< over the smaller radius
    /// Time of the same steps with NaiveMotion over the time of the simulation; nothing if nothing moves.
    std::optional<double> ratio_naive;
    std::optional<std::uint64_t> naive_leaks;  ///< particles that NaiveMotion moves outside a closed ground
    std::optional<double> speedup;      ///< time with one thread over time; nothing if one thread was not measured
    std::optional<double> speedup_raw;  ///< speedup of the raw rays
};

/// Settings of a measurement.
struct MeasurementPlan {
    std::vector<int> threads = {0};  ///< numbers of worker threads, one row each; 0: all
    std::uint32_t repeats = 5;       ///< at least 1
};

/// Progress of a measurement.
struct Progress {
    std::string_view name;     ///< of the case; empty while the mesh is created
    int threads = 0;           ///< 0: still preparing
    std::uint32_t repeat = 0;  ///< from 1
    std::string_view doing;    ///< next piece of work
    std::uint64_t step = 0;    ///< from 1; 0 if the work has no steps
};

/// Function called between any two pieces of work. If it returns false, the measurement ends.
using Hook = std::function<bool(const Progress&)>;

/// Measures a group of cases on one mesh (see groups_of()). Returns one row per case and number of threads, case by
/// case. Every repeat runs all numbers of threads and all cases in turn. Each time, the simulation starts from the
/// state before the last step of the warm-up, and the references run after it. Noise therefore affects all of them
/// alike. Returns nothing if the hook has ended it. Throws RunError if a repeat ends in another state than the others.
[[nodiscard]] std::optional<std::vector<Row>> measure_group(std::span<const Case> group, const MeasurementPlan& plan,
                                                            const Hook& hook = {});

/// Measures a single case.
[[nodiscard]] std::optional<std::vector<Row>> measure_case(const Case& c, const MeasurementPlan& plan,
                                                           const Hook& hook = {});

}  // namespace ricochet::bench
