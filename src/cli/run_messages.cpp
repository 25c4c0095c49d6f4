#include "cli/run_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "ricochet/core/hash.h"
#include "ricochet/core/printable.h"

namespace ricochet::cli {
namespace {

// Formats a rate, or "-" if no time has passed.
std::string rate_text(std::uint64_t count, double seconds) {
    return seconds > 0.0 ? short_number(static_cast<double>(count) / seconds) : "-";
}

/// Smallest share of lasting contact in the impulses for which the report states the share of impacts.
constexpr double kNotableShare = 0.01;

void print_impulse_share(const ImpulseSizes& sizes) {
    if (!sizes.any() || 1.0 - sizes.share_of_impacts() < kNotableShare) return;
    print(
        "  note: impacts gave {:.3g} % of the impulse on surfaces; hits and the contact log do not include lasting "
        "contact "
        "(impact_share, lasting_impulse)\n",
        100.0 * sizes.share_of_impacts());
}

void print_pair_impacts(const SimulationStatistics& statistics) {
    print("  {} {} between spheres, besides those that are solved together\n", statistics.pair_impacts,
          statistics.pair_impacts == 1 ? "impact" : "impacts");
    const double loss = statistics.joined_impact_loss;
    const double energy = statistics.joined_impact_energy;
    if (!(loss > 0.0)) return;
    // A moving surface can hit spheres at rest, and gives them more energy than they have.
    const std::string share =
        loss <= energy ? fmt::format(", {:.3g} % of the energy of their spheres", 100.0 * loss / energy) : "";
    print("  impacts that are solved together lost {:.3g} J beyond their restitution{}\n", loss, share);
}

/// Prints one line with the most frequently hit groups of a collider.
void print_groups(const ColliderSummary& collider) {
    constexpr std::size_t kMostGroups = 8;
    if (collider.groups.empty()) return;
    std::vector<GroupTotals> groups = collider.groups;
    std::stable_sort(groups.begin(), groups.end(),
                     [](const GroupTotals& a, const GroupTotals& b) { return a.hits > b.hits; });
    std::string line;
    for (std::size_t k = 0; k < std::min(groups.size(), kMostGroups); ++k) {
        const std::string name = groups[k].name.empty() ? "(no name)" : printable(groups[k].name, 60);
        line += fmt::format("{}{} {}", k == 0 ? "" : ", ", name, groups[k].hits);
    }
    if (groups.size() > kMostGroups) line += fmt::format(" and {} more", groups.size() - kMostGroups);
    print("  hits on {} by group: {}\n", printable(collider.name, 60), line);
}

void print_counter(const CounterTotals& counter) {
    print("  counter {}: {} forward ({:.6g} kg), {} backward ({:.6g} kg)\n", printable(counter.name, 60),
          counter.forward, counter.forward_mass, counter.backward, counter.backward_mass);
}

/// Overlap of two spheres, relative to the smaller radius, above which a warning is printed. A contact island that is
/// solved to its tolerance leaves smaller overlaps.
constexpr double kLargeOverlap = 0.05;

void print_notes(const SimulationStatistics& statistics) {
    const auto warn = [](std::uint64_t count, const char* what) {
        if (count > 0) print("  note: {}: {}\n", what, count);
    };
    warn(statistics.springs_broken, "springs that broke (springs_broken)");
    warn(statistics.springs_lost, "springs that lost a particle at an end (springs_lost)");
    warn(statistics.unsolved_steps,
         "steps of the implicit or the adaptive method, or of spheres in contact, not solved to the tolerance "
         "(unsolved_steps)");
    warn(statistics.coarse_steps,
         "steps of a particle in which dormand_prince could not keep its tolerance, as near a force without bound "
         "(coarse_steps)");
    warn(statistics.budget_exhausted,
         "times that a particle spent its bounces or its adaptive sub-steps of a step (budget_exhausted)");
    warn(statistics.squeezed, "times that closing surfaces left a particle no space, so that it waits (squeezed)");
    warn(statistics.started_inside - statistics.started_in_overlap,
         "points born exactly on a surface (started_inside)");
    warn(statistics.started_in_overlap, "spheres born in overlap with a surface (started_in_overlap)");
    warn(statistics.stayed, "impacts that left the particle where it was (stayed)");
    warn(statistics.births_refused_by_depth, "births refused beyond max_depth (births_refused_by_depth)");
    warn(statistics.births_refused_by_population,
         "births refused beyond most_particles (births_refused_by_population)");
    warn(statistics.births_refused_by_overlap,
         "births refused, since no free position for the sphere was found (births_refused_by_overlap)");
}

}  // namespace

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::max(0.0, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

void RunProgress::show(const Simulation& simulation, const RunCounts& counts, double output_share) {
    if (!line_.due()) return;
    const double seconds = seconds_since(last_time_);
    const auto steps = static_cast<double>(simulation.step_index() - last_step_);
    const std::uint64_t moved = counts.particle_steps - last_particle_steps_;
    seconds_per_step_ = seconds_per_step_ == 0.0 ? seconds / steps : 0.8 * seconds_per_step_ + 0.2 * seconds / steps;
    last_time_ = Clock::now();
    last_step_ = simulation.step_index();
    last_particle_steps_ = counts.particle_steps;
    const auto left = static_cast<double>(simulation.step_count() - simulation.step_index());
    line_.show(fmt::format(
        "{:3.0f} %  step {} of {}  {} particles  {} particle-steps/s  {:.0f} % on output  {} left",
        100.0 * static_cast<double>(simulation.step_index()) / static_cast<double>(simulation.step_count()),
        simulation.step_index(), simulation.step_count(), short_number(static_cast<double>(counts.particles)),
        rate_text(moved, seconds), 100.0 * std::min(output_share, 1.0), duration_text(left * seconds_per_step_)));
}

void print_losses(const std::string& scene, const SimulationStatistics& statistics) {
    const auto warn = [&scene](std::uint64_t count, const char* what) {
        if (count > 0) print(stderr, "ricochet: warning: {}: {}: {}\n", scene, what, count);
    };
    warn(statistics.frozen, "particles stopped because their state was not finite or absurdly large (frozen)");
    warn(statistics.lost_impulses,
         "impulses of 6.7e7 N s or more along an axis, too large for the totals of the collider files; the motion is "
         "correct (lost_impulses)");
    if (statistics.overlap_largest > kLargeOverlap && statistics.born_in_overlap == 0) {
        print(stderr,
              "ricochet: warning: {}: spheres overlap by up to {:.2g} of the smaller radius (overlap_largest): reduce "
              "simulation.time_step, make radii and masses more similar, or leave more space between surfaces that "
              "press on them\n",
              scene, statistics.overlap_largest);
    }
}

void print_report(const RunSummary& summary, const std::string& output) {
    const SimulationStatistics& statistics = summary.statistics;
    const std::string end = summary.interrupted ? " (interrupted)" : summary.diverged ? " (diverged)" : "";
    const std::string processes = summary.processes > 1 ? fmt::format(" of {} processes", summary.processes) : "";
    print("{}: {} {}, {:.6g} s simulated in {:.3g} s on {} {}{}{}\n", summary.scene, statistics.steps,
          statistics.steps == 1 ? "step" : "steps", summary.simulated_time, summary.wall_seconds, summary.threads,
          summary.threads == 1 ? "thread" : "threads", processes, end);
    print("  {} particles emitted, {} alive; {} particle-steps ({}/s), {} contacts, at most {} bounces a step\n",
          statistics.emitted, summary.particles_alive, statistics.particle_steps,
          rate_text(statistics.particle_steps, summary.wall_seconds), statistics.contacts,
          statistics.bounces_per_step_max);
    if (summary.spheres_meet) print_pair_impacts(statistics);
    for (const ColliderSummary& collider : summary.colliders) print_groups(collider);
    for (const CounterTotals& counter : summary.counters) print_counter(counter);
    print_notes(statistics);
    print_impulse_share(summary.impulse_sizes());
    if (summary.verified) {
        const bool all_judged = statistics.started_in_overlap == 0;
        print("  verified by independent exact checks: {} violations, {} of energy{}\n", statistics.violations,
              statistics.energy_violations,
              all_judged ? "" : "; overlaps from birth count once the sphere has been free");
    }
    if (summary.verified && summary.spheres_meet) {
        print("  spheres on each other: {} violations, largest overlap {:.2g} of a radius\n",
              statistics.pair_violations, statistics.overlap_verified);
    }
    print("  state {} {:016x}; {} frames in {}\n", StateHash::kName, summary.state_hash, summary.frames, output);
}

bool print_violations(const Simulation& simulation) {
    const SimulationStatistics& statistics = simulation.statistics();
    const auto lines = violation_lines(
        simulation.violations(), statistics.violations + statistics.energy_violations + statistics.pair_violations,
        simulation.colliders());
    for (const std::string& line : lines) print(stderr, "{}\n", line);
    return !lines.empty();
}

}  // namespace ricochet::cli
