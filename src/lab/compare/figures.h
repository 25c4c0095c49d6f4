/// \file
/// Results of one run of a comparison: the numbers of a row.
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

/// Particles that went through a surface. Each particle counts at most once in every number.
struct TunnelCounts {
    /// Particles that tunnelled: jumped, passed, or on the wrong side at the end of their life or of the run. A
    /// particle on the wrong side does not count while the response pushes it back.
    std::uint64_t tunnelled = 0;
    /// Particles on another side of a closed collider than at birth, or with an odd number of crossings of an open
    /// mesh.
    std::uint64_t wrong_side = 0;
    std::uint64_t penetrating = 0;  ///< particles on the wrong side that the response is pushing back
    std::uint64_t jumped = 0;       ///< particles that crossed a closed collider completely within one segment
    /// Particles that crossed a closed collider in several segments. They entered it and left it where the surface
    /// faces the opposite direction.
    std::uint64_t passed = 0;
};

/// Statistics of a set of errors. If the set is empty (count 0), the numbers are kNoNumber.
struct ErrorSpread {
    std::uint64_t count = 0;
    double median = kNoNumber;         ///< mean of the middle two if the count is even
    double percentile_95 = kNoNumber;  ///< smallest error that at least 95 % do not exceed
    double root_mean_square = kNoNumber;
    double largest = kNoNumber;
};

/// An entry of a time series of energy errors.
struct EnergyPoint {
    double time = 0.0;   ///< in s
    double error = 0.0;  ///< see ReferenceErrors
};

/// Results of one measured run by itself.
struct RunFigures {
    SimulationStatistics statistics;
    TunnelCounts tunnel;
    std::uint64_t alive = 0;  ///< particles at the end
    std::uint64_t state_hash = 0;
    std::vector<std::string> warnings;  ///< Simulation::warnings()

    /// Returns the share of particle-steps in which a particle was seen behind a surface; kNoNumber if there were no
    /// particle-steps.
    [[nodiscard]] double penetration_share() const {
        return statistics.particle_steps == 0
                   ? kNoNumber
                   : static_cast<double>(statistics.penetrations) / static_cast<double>(statistics.particle_steps);
    }
};

/// Errors of one measured run against the reference.
struct ReferenceErrors {
    /// Energy minus the reference's at the same time, over the energy scale, at most at kMostEnergyPoints of the steps.
    std::vector<EnergyPoint> energy;
    double energy_largest = kNoNumber;  ///< largest magnitude over all steps
    double energy_final = kNoNumber;    ///< signed
    /// Magnitudes, in s, of the difference between the times of a particle's first impact in this run and in the
    /// reference. Only particles with both impacts count.
    ErrorSpread impact;
    std::uint64_t impacts_missed = 0;  ///< particles with an impact in the reference only
    std::uint64_t impacts_extra = 0;   ///< particles with an impact in this run only
    /// Distances, in m, between a particle's last positions in both runs. Only particles alive in both count.
    ErrorSpread position;
};

/// Largest number of points of ReferenceErrors::energy.
inline constexpr std::size_t kMostEnergyPoints = 200;

/// Costs of a row. Only these numbers differ between two comparisons of the same scene.
struct RunCost {
    std::vector<double> seconds_each;         ///< time of all steps together, one per timed run
    double seconds = kNoNumber;               ///< median of seconds_each
    double ns_per_particle_step = kNoNumber;  ///< seconds over particle-steps
    double ns_per_contact = kNoNumber;        ///< seconds over contacts; kNoNumber without contacts
    double ratio_at_equal_step = kNoNumber;   ///< relative to exact at this step: the median of the repeats' ratios
    /// Ratio to the longest exact step with no larger error; kNoNumber without one.
    double ratio_at_equal_error = kNoNumber;
};

// Statistics of a set of numbers.

/// Returns the middle value, or the mean of the middle two; kNoNumber for an empty set.
[[nodiscard]] double median(std::vector<double> values);
/// Returns the smallest value that at least this share (0..1) of all values does not exceed (nearest rank); kNoNumber
/// for an empty set.
[[nodiscard]] double percentile(std::vector<double> values, double share);
/// Returns the statistics of errors >= 0. The root mean square is summed in the given order.
[[nodiscard]] ErrorSpread spread_of(const std::vector<double>& errors);

}  // namespace ricochet
