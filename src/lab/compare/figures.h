/// \file
/// What one run of a comparison shows: the numbers of a row.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// Instead of a number that does not exist, such as the mean of nothing.
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Particles that went through a surface. Each particle counts once in every number.
struct TunnelCounts {
    /// On the wrong side at the end of its life or of the run and not being pushed back, or jumped, or passed.
    std::uint64_t tunnelled = 0;
    /// On the other side of a closed collider than at birth, or with an odd number of crossings of an open mesh.
    std::uint64_t wrong_side = 0;
    std::uint64_t penetrating = 0;  ///< of those on the wrong side: the response knows and is pushing them back
    std::uint64_t jumped = 0;       ///< went right through a closed collider within one segment
    /// Went into a closed collider and came out of it where the surface faces the other way: through it in several
    /// segments.
    std::uint64_t passed = 0;
};

/// How large a set of errors is. Without any (count 0) the numbers are kNoNumber.
struct ErrorSpread {
    std::uint64_t count = 0;
    double median = kNoNumber;         ///< the mean of the middle two where the count is even
    double percentile_95 = kNoNumber;  ///< the smallest error that at least 95 % do not exceed
    double root_mean_square = kNoNumber;
    double largest = kNoNumber;
};

/// An entry of a series over time.
struct EnergyPoint {
    double time = 0.0;   ///< s
    double error = 0.0;  ///< see ReferenceErrors
};

/// What one measured run shows by itself.
struct RunFigures {
    SimulationStatistics statistics;
    TunnelCounts tunnel;
    std::uint64_t alive = 0;  ///< particles at the end
    std::uint64_t state_hash = 0;
    std::vector<std::string> warnings;  ///< Simulation::warnings()

    /// Particle-steps in which a particle was seen behind a surface, as a share of all; kNoNumber without any.
    [[nodiscard]] double penetration_share() const {
        return statistics.particle_steps == 0
                   ? kNoNumber
                   : static_cast<double>(statistics.penetrations) / static_cast<double>(statistics.particle_steps);
    }
    /// Mean of their depths, m; 0 without any.
    [[nodiscard]] double penetration_mean() const {
        return statistics.penetrations == 0 ? 0.0
                                            : statistics.penetration_sum / static_cast<double>(statistics.penetrations);
    }
};

/// What one measured run shows against the reference.
struct ReferenceErrors {
    /// Energy minus the reference's at the same time, over the energy scale; at most kMostEnergyPoints of the steps.
    std::vector<EnergyPoint> energy;
    double energy_largest = kNoNumber;  ///< largest magnitude over all steps
    double energy_final = kNoNumber;    ///< signed
    /// Magnitudes, s, of the time of a particle's first impact minus that in the reference, where both have one.
    ErrorSpread impact;
    std::uint64_t impacts_missed = 0;  ///< particles that have an impact in the reference only
    std::uint64_t impacts_extra = 0;   ///< particles that have one in this run only
    /// Distances, m, between the particles' last positions here and there, where both are alive.
    ErrorSpread position;
};

/// Most points of ReferenceErrors::energy.
inline constexpr std::size_t kMostEnergyPoints = 200;

/// What a row cost. Only these numbers differ between two comparisons of the same scene.
struct RunCost {
    std::vector<double> seconds_each;         ///< of all steps together, one a timed run
    double seconds = kNoNumber;               ///< their median
    double ns_per_particle_step = kNoNumber;  ///< seconds over particle-steps
    double ns_per_contact = kNoNumber;        ///< seconds over contacts; kNoNumber without contacts
    double ratio_at_equal_step = kNoNumber;   ///< over exact's at this step: the median of the repeats' ratios
    double ratio_at_equal_error = kNoNumber;  ///< over exact's at ReferenceErrors no larger; kNoNumber without such
};

// How large a set of numbers is.

/// The middle one, or the mean of the middle two; kNoNumber of nothing.
[[nodiscard]] double median(std::vector<double> values);
/// The smallest value that at least this share (0..1) of all does not exceed (nearest rank); kNoNumber of nothing.
[[nodiscard]] double percentile(std::vector<double> values, double share);
/// Of errors >= 0; the root of the mean square is summed in the order given.
[[nodiscard]] ErrorSpread spread_of(const std::vector<double>& errors);

}  // namespace ricochet
