/// \file
/// Measures cases: the simulation and, on the same segments, what Embree does by itself.
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
    /// Particles that the bounce loop has brought outside a closed mesh; nothing where the mesh has no inside, and for
    /// responses that let particles into the wall.
    std::optional<std::uint64_t> leaks;
    std::uint64_t state_hash = 0;
    double bytes_per_particle = 0.0;
    double bytes_per_triangle = 0.0;
    std::optional<double> ratio_points;  ///< time of a particle-step over that of points; nothing without such a case
    std::optional<double> ratio_exact;   ///< the same over the exact response
    std::optional<double> ratio_rest;    ///< the same over the same where nothing moves
    std::optional<double> ratio_apart;   ///< the same over spheres that pass through each other
    // Where spheres meet:
    std::optional<double> seconds_a_simulated_second;
    std::optional<double> seconds_an_impact;  ///< of spheres on each other; nothing where there is none by itself
    std::optional<double> largest_overlap;    ///< over the smaller radius
    /// Time of the same steps in the usual way, see NaiveMotion, over that of the simulation; nothing where nothing
    /// moves.
    std::optional<double> ratio_naive;
    std::optional<std::uint64_t> naive_leaks;  ///< particles that it brings outside a closed ground
    std::optional<double> speedup;             ///< time with one thread over time; nothing where that was not measured
    std::optional<double> speedup_raw;         ///< the same of the raw rays
};

/// How cases are measured.
struct MeasurementPlan {
    std::vector<int> threads = {0};  ///< numbers of worker threads, one row each; 0: all
    std::uint32_t repeats = 5;       ///< >= 1
};

/// Where a measurement is.
struct Progress {
    std::string_view name;     ///< of the case; empty while the mesh is made
    int threads = 0;           ///< 0: still preparing
    std::uint32_t repeat = 0;  ///< from 1
    std::string_view doing;    ///< what runs next
    std::uint64_t step = 0;    ///< from 1; 0 where it has no steps
};

/// Called between any two pieces of work; false ends the measurement.
using Hook = std::function<bool(const Progress&)>;

/// Measures a group of cases on one mesh (see groups_of()), one row a case and number of threads, case by case. Every
/// repeat goes through the numbers of threads and the cases in turns; each time the simulation starts from the state
/// before the warm-up's last step and the references run after it, so that noise hits all alike. Nothing when the hook
/// has ended it. Throws RunError when a repeat ends in another state than the others.
[[nodiscard]] std::optional<std::vector<Row>> measure_group(std::span<const Case> group, const MeasurementPlan& plan,
                                                            const Hook& hook = {});

/// The same for a case alone.
[[nodiscard]] std::optional<std::vector<Row>> measure_case(const Case& c, const MeasurementPlan& plan,
                                                           const Hook& hook = {});

}  // namespace ricochet::bench
