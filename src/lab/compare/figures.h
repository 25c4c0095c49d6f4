/// \file
/// Results, errors and costs of one row of a comparison.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// Value of a number that does not exist, such as the mean of an empty set.
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Numbers of particles that went through a surface. Each number counts a particle at most once.
struct TunnelCounts {
    /// Particles in at least one of `jumped`, `passed` and `wrong_side`. Particles in `penetrating` do not count as on
    /// the wrong side.
    std::uint64_t tunnelled = 0;
    /// Particles that are, at the end of their life or of the run, on another side of a closed collider than at birth.
    /// Also counts particles with an odd number of crossings of an open mesh.
    std::uint64_t wrong_side = 0;
    /// Particles in `wrong_side` that the response was pushing back after their last step.
    std::uint64_t penetrating = 0;
    std::uint64_t jumped = 0;  ///< particles that entered and left a closed collider within one segment
    /// Particles that entered and left a closed collider in different segments. The normals at entry and exit point in
    /// opposite directions (negative dot product).
    std::uint64_t passed = 0;
};

/// Statistics of a set of errors. If the set is empty (count 0), the numbers are kNoNumber.
struct ErrorSpread {
    std::uint64_t count = 0;
    double median = kNoNumber;         ///< mean of the two middle values if the count is even
    double percentile_95 = kNoNumber;  ///< smallest error that at least 95 % of the errors do not exceed
    double root_mean_square = kNoNumber;
    double largest = kNoNumber;
};

/// An entry of a time series of energy errors.
struct EnergyPoint {
    double time = 0.0;   ///< in s
    double error = 0.0;  ///< see ReferenceErrors
};

/// Results of one measured run that do not need the reference.
struct RunFigures {
    SimulationStatistics statistics;
    TunnelCounts tunnel;
    std::uint64_t alive = 0;  ///< number of particles at the end
    std::uint64_t state_hash = 0;
    std::vector<std::string> warnings;  ///< Simulation::warnings()

    /// Returns the share of particle-steps in which the particle was found behind a surface. Returns kNoNumber if there
    /// were no particle-steps.
    [[nodiscard]] double penetration_share() const {
        return statistics.particle_steps == 0
                   ? kNoNumber
                   : static_cast<double>(statistics.penetrations) / static_cast<double>(statistics.particle_steps);
    }
};

/// Errors of one measured run relative to the reference.
struct ReferenceErrors {
    /// Energy minus the energy of the reference at the same time, divided by the energy scale. Contains at most
    /// kMostEnergyPoints steps.
    std::vector<EnergyPoint> energy;
    double energy_largest = kNoNumber;  ///< largest magnitude over all steps
    double energy_final = kNoNumber;    ///< at the end of the run, signed
    /// Differences, in s, between the times of a particle's first impact in this run and in the reference, as
    /// magnitudes. Only particles with an impact in both runs count.
    ErrorSpread impact;
    std::uint64_t impacts_missed = 0;  ///< particles with an impact in the reference only
    std::uint64_t impacts_extra = 0;   ///< particles with an impact in this run only
    /// Distances, in m, between a particle's final positions in both runs. Only particles that are alive at the end of
    /// both runs count.
    ErrorSpread position;
};

/// Largest number of points of ReferenceErrors::energy.
inline constexpr std::size_t kMostEnergyPoints = 200;

/// Costs of a row. Only these results differ between two comparisons of the same scene.
struct RunCost {
    std::vector<double> seconds_each;         ///< total time of all steps, for each timed run
    double seconds = kNoNumber;               ///< median of seconds_each
    double ns_per_particle_step = kNoNumber;  ///< time divided by the number of particle-steps
    double ns_per_contact = kNoNumber;        ///< time divided by the number of contacts; kNoNumber without contacts
    /// Time divided by the time of the response `exact` at the same time step, as the median over the repeats.
    double ratio_at_equal_step = kNoNumber;
    /// Time divided by the time of `exact` at the longest time step at which its error is not larger, see
    /// equally_good(). kNoNumber if there is no such time step.
    double ratio_at_equal_error = kNoNumber;
};

// Statistics of a set of numbers.

/// Returns the middle value, or the mean of the two middle values if their number is even. Returns kNoNumber for an
/// empty set.
[[nodiscard]] double median(std::vector<double> values);
/// Returns the percentile by the nearest-rank method: the smallest value that at least the given share (0..1) of all
/// values does not exceed. Returns kNoNumber for an empty set.
[[nodiscard]] double percentile(std::vector<double> values, double share);
/// Returns the statistics of errors >= 0. The squares are summed in the given order.
[[nodiscard]] ErrorSpread spread_of(const std::vector<double>& errors);

}  // namespace ricochet
