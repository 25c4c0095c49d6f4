/// \file
/// Measurement of cases: the time of the simulation, and the time of Embree alone on the same segments.
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

/// Result for one case and one number of threads. Rates are computed from the median time of the repeats. A ratio is
/// the median of the ratios of the repeats. Optional members are std::nullopt if they do not apply to the case.
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
    double seconds = 0.0;  ///< total time of all steps
    double particle_steps_per_second = 0.0;
    double contacts_per_second = 0.0;
    double raw_rays_per_second = 0.0;         ///< Embree, one ray at a time, particles in arbitrary order
    double ratio_raw = 0.0;                   ///< particle-steps per second divided by raw rays per second
    double raw_sorted_rays_per_second = 0.0;  ///< Embree, packets of sixteen rays, particles in spatial order
    double ratio_raw_sorted = 0.0;
    double native_bounces_per_second = 0.0;  ///< bounces of the usual bounce loop, see NativeRays::bounce()
    /// Contacts per second divided by native bounces per second; std::nullopt without bounces.
    std::optional<double> ratio_native_bounces;
    /// Particles that the bounce loop moved outside a closed mesh. std::nullopt if the mesh is open or the response is
    /// not exact.
    std::optional<std::uint64_t> leaks;
    std::uint64_t state_hash = 0;
    double bytes_per_particle = 0.0;
    double bytes_per_triangle = 0.0;
    std::optional<double> ratio_points;  ///< time of a particle-step relative to the base case with points
    std::optional<double> ratio_exact;   ///< time of a particle-step relative to the base case with the exact response
    std::optional<double> ratio_rest;    ///< time of a particle-step relative to the base case without moving colliders
    /// Time of a particle-step relative to the base case without contacts between spheres.
    std::optional<double> ratio_apart;
    // The next three members are set if spheres collide with each other.
    std::optional<double> seconds_a_simulated_second;
    /// Time per impact between spheres; std::nullopt if no impact is resolved sequentially.
    std::optional<double> seconds_an_impact;
    std::optional<double> largest_overlap;  ///< largest overlap of two spheres, divided by the smaller radius
    /// Time of the same steps with NaiveMotion, divided by the time of the simulation. std::nullopt if no collider
    /// moves.
    std::optional<double> ratio_naive;
    std::optional<std::uint64_t> naive_leaks;  ///< number of particles that NaiveMotion moved outside a closed ground
    /// Time with one thread, divided by the time of this row; std::nullopt if one thread was not measured.
    std::optional<double> speedup;
    std::optional<double> speedup_raw;  ///< the same for the raw rays
};

/// Settings of a measurement.
struct MeasurementPlan {
    std::vector<int> threads = {0};  ///< numbers of threads; each gives one row per case; 0: all threads
    std::uint32_t repeats = 5;       ///< number of repeats, at least 1
};

/// Progress of a measurement.
struct Progress {
    std::string_view name;     ///< name of the case; empty while the mesh is created
    int threads = 0;           ///< current number of threads; 0 during the preparation
    std::uint32_t repeat = 0;  ///< number of the current repeat, from 1; 0 during the preparation
    std::string_view doing;    ///< name of the next task
    std::uint64_t step = 0;    ///< current step of the task, from 1; 0 if the task has no steps
};

/// Function that is called before each task and at each step. If it returns false, the measurement ends.
using Hook = std::function<bool(const Progress&)>;

/// Measures a group of cases on one mesh (see groups_of()). Returns one row per case and number of threads, case by
/// case. Each repeat runs all cases with each number of threads. The simulation always restarts from the saved state
/// before the last step of the warm-up. The references run directly after the simulation, so that noise affects both
/// alike. Returns std::nullopt if the hook ends the measurement. Throws RunError if the final states of the repeats
/// differ.
[[nodiscard]] std::optional<std::vector<Row>> measure_group(std::span<const Case> group, const MeasurementPlan& plan,
                                                            const Hook& hook = {});

/// Measures a single case like measure_group().
[[nodiscard]] std::optional<std::vector<Row>> measure_case(const Case& c, const MeasurementPlan& plan,
                                                           const Hook& hook = {});

}  // namespace ricochet::bench
