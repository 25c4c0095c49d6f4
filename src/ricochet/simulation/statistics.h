/// \file
/// Statistics of a run, and the table that describes them. The summary, the Python package and sums over ranks use this
/// table.
#pragma once

#include <cstdint>
#include <string_view>
#include <variant>

namespace ricochet {

/// Counters over the whole run so far. Their values do not depend on the number of threads. kStatistics describes the
/// meaning of each counter. Saved states contain the members in this order.
struct SimulationStatistics {
    std::uint64_t steps = 0;
    std::uint64_t particle_steps = 0;
    std::uint64_t emitted = 0;
    std::uint64_t expired = 0;
    std::uint64_t absorbed = 0;
    std::uint64_t shattered = 0;
    std::uint64_t children = 0;
    std::uint64_t births_refused_by_depth = 0;
    std::uint64_t births_refused_by_population = 0;
    std::uint64_t births_refused_by_overlap = 0;
    std::uint64_t out_of_bounds = 0;
    std::uint64_t removed = 0;
    std::uint64_t contacts = 0;
    std::uint64_t pair_impacts = 0;
    double joined_impact_energy = 0.0;
    double joined_impact_loss = 0.0;
    double overlap_largest = 0.0;
    double overlap_verified = 0.0;
    std::uint64_t pair_violations = 0;
    std::uint64_t born_in_overlap = 0;
    std::uint32_t bounces_per_step_max = 0;
    std::uint64_t resting = 0;
    double unsimulated_time = 0.0;
    std::uint64_t budget_exhausted = 0;
    std::uint64_t asleep = 0;
    std::uint64_t started_inside = 0;
    std::uint64_t started_in_overlap = 0;
    std::uint64_t stayed = 0;
    std::uint64_t squeezed = 0;
    std::uint64_t lost_impulses = 0;
    std::uint64_t violations = 0;
    std::uint64_t energy_violations = 0;
    std::uint64_t trials = 0;
    std::uint64_t penetrations = 0;
    double penetration_sum = 0.0;
    double penetration_deepest = 0.0;
    std::uint64_t springs_broken = 0;
    std::uint64_t springs_lost = 0;
    std::uint64_t unsolved_steps = 0;
    std::uint64_t frozen = 0;
    std::uint64_t coarse_steps = 0;
    std::uint64_t body_parts = 0;

    /// Returns the mean penetration depth before the correction, in m; 0 without penetrations.
    [[nodiscard]] double penetration_mean() const {
        return penetrations == 0 ? 0.0 : penetration_sum / static_cast<double>(penetrations);
    }
};

/// Condition under which summary.json contains a statistic.
enum class InSummary {
    always,
    above_zero,
    of_spheres,           ///< if spheres meet
    of_spheres_verified,  ///< if spheres meet; null if the run was not verified
    verified,             ///< null if the run was not verified
    apart,                ///< in another part of the summary, or not included
};

/// Rule that combines the values of the parts of a run into the value of the run.
enum class OverParts { sum, largest, same };

/// A line of the table.
struct Statistic {
    using S = SimulationStatistics;
    std::string_view name;
    /// A member, or a function for a value that is computed from other members.
    std::variant<std::uint64_t S::*, std::uint32_t S::*, double S::*, double (S::*)() const> member;
    std::string_view meaning;  ///< contains the unit, unless the statistic is a count or a ratio
    InSummary in_summary = InSummary::always;
    OverParts over_parts = OverParts::sum;
    std::string_view summary_name = name;
};

/// Short names for the lines of the table.
namespace statistics_table {
using S = SimulationStatistics;
using enum InSummary;
using enum OverParts;

/// All statistics, in the order of summary.json.
inline constexpr Statistic kStatistics[] = {
    {"steps", &S::steps, "steps done", apart, same},
    {"emitted", &S::emitted, "all particles ever created, explicit ones included", always, sum, "particles_emitted"},
    {"expired", &S::expired, "particles removed at the end of their lifetime"},
    {"absorbed", &S::absorbed, "particles removed by absorbing surfaces"},
    {"out_of_bounds", &S::out_of_bounds, "particles removed outside the bounds"},
    {"shattered", &S::shattered, "particles replaced by fragments at an impact"},
    {"children", &S::children, "emitted particles that were spawned by particles"},
    {"births_refused_by_depth", &S::births_refused_by_depth, "births that would exceed max_depth"},
    {"births_refused_by_population", &S::births_refused_by_population, "births that would exceed most_particles"},
    {"births_refused_by_overlap", &S::births_refused_by_overlap, "spheres for which an emitter found no free position"},
    {"frozen", &S::frozen, "particles stopped because their state was not finite or beyond 1e75"},
    {"particle_steps", &S::particle_steps, "sum over steps of the particles alive, resting ones included"},
    {"contacts", &S::contacts, "impacts"},
    {"bounces_per_step_max", &S::bounces_per_step_max, "largest number of bounces of a particle in a step", always,
     largest},
    {"resting", &S::resting, "particles at rest after the last step"},
    {"asleep", &S::asleep, "resting particles that cost no time"},
    // If several ranks share the run, this sum is computed again in the order of particles.
    {"unsimulated_time", &S::unsimulated_time, "time lost because a budget was spent, in s, summed over particles"},
    {"budget_exhausted", &S::budget_exhausted,
     "particle-steps that spent their budget of bounces, or of dormand_prince substeps"},
    {"coarse_steps", &S::coarse_steps,
     "particle-steps in which dormand_prince could not keep its tolerance with its shortest substeps"},
    {"started_inside", &S::started_inside, "particles born on a surface or, for spheres, overlapping one"},
    {"started_in_overlap", &S::started_in_overlap, "spheres among started_inside"},
    {"stayed", &S::stayed, "impacts without a certified position nearer to the surface"},
    {"squeezed", &S::squeezed, "particle-steps that ended pinched between approaching surfaces", above_zero},
    {"body_parts", &S::body_parts, "substeps of scenes with dynamic bodies; at least one per step", above_zero, same},
    {"lost_impulses", &S::lost_impulses, "impulses too large for the per-triangle totals"},
    {"springs_broken", &S::springs_broken, "springs stretched beyond their limit"},
    {"springs_lost", &S::springs_lost, "springs removed because a particle at one end was gone"},
    // Also counts steps of coupled particles in which dormand_prince could not keep its tolerance.
    {"unsolved_steps", &S::unsolved_steps,
     "steps whose equations were not solved to the tolerance, or whose contacts did not settle"},
    {"trials", &S::trials, "states that a response tested for collision or penetration; 0 for exact"},
    {"penetrations", &S::penetrations, "particle-steps in which a particle was found behind a surface"},
    {"penetration_mean", &S::penetration_mean, "mean of these depths, in m, before their correction"},
    {"penetration_deepest", &S::penetration_deepest, "largest of these depths, in m", always, largest},
    {"penetration_sum", &S::penetration_sum, "sum of these depths, in m", apart},
    {"removed", &S::removed, "particles removed by remove_particles()", apart},
    {"pair_impacts", &S::pair_impacts, "impacts between two spheres", of_spheres},
    {"joined_impact_energy", &S::joined_impact_energy,
     "kinetic energy of spheres whose impacts were solved together, in J, summed over steps", of_spheres},
    {"joined_impact_loss", &S::joined_impact_loss,
     "energy that impacts solved together lost beyond the restitution of each, in J", of_spheres},
    {"overlap_largest", &S::overlap_largest, "largest overlap of two spheres at a step's end, over the smaller radius",
     of_spheres, largest},
    {"born_in_overlap", &S::born_in_overlap, "spheres that overlapped others at their birth", of_spheres},
    {"overlap_verified", &S::overlap_verified,
     "largest overlap of two spheres that verification found, over the smaller radius", of_spheres_verified, largest},
    {"pair_violations", &S::pair_violations, "violations between spheres that verification found", of_spheres_verified},
    {"violations", &S::violations, "violations of positions and paths that verification found", verified, sum, "leaks"},
    {"energy_violations", &S::energy_violations, "violations of energies and rebounds that verification found",
     verified},
};

}  // namespace statistics_table
using statistics_table::kStatistics;

/// Returns true if the value is known only in a verified run.
[[nodiscard]] constexpr bool is_found_by_verification(const Statistic& line) {
    return line.in_summary == InSummary::verified || line.in_summary == InSummary::of_spheres_verified;
}

/// Adds the statistics of a part of a run, which is another rank or a block of particles.
void add_part(SimulationStatistics& run, const SimulationStatistics& part);

}  // namespace ricochet
