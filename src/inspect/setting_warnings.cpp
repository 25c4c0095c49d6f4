#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "inspect/scene_warnings.h"

namespace ricochet {
namespace {

/// Smallest restitution at which the user probably expects spheres to keep their energy. Local, because it decides only
/// about a warning.
constexpr double kNearlyElastic = 0.9;

}  // namespace

std::vector<std::string> pair_method_warnings(const Simulation& simulation, const Vec3& fall) {
    const std::optional<PairContactSettings>& pairs = simulation.options().particle_contacts;
    std::vector<std::string> lines;
    if (!pairs) return lines;
    double least = pairs->restitution;
    double most = pairs->restitution < 1.0 ? pairs->restitution : 0.0;  // largest restitution below 1
    for (const MaterialPair& pair : pairs->pairs) {
        const double restitution = pair.material.restitution;
        least = std::min(least, restitution);
        if (restitution < 1.0) most = std::max(most, restitution);
    }
    if (pairs->method == PairMethod::events && fall != Vec3{} && least < 1.0) {
        lines.emplace_back(
            "particle_contacts.method: events: spheres that come to rest on each other under gravity rattle, use up "
            "the impacts of each step and stop in the air; use auto");
    }
    if (pairs->method == PairMethod::contacts && most >= kNearlyElastic) {
        lines.push_back(
            fmt::format("particle_contacts.method: contacts: successive impacts in a step count as one: a gas loses "
                        "energy and a Newton's cradle spreads it, whatever the restitution of {:g}; use auto or events",
                        most));
    }
    return lines;
}

std::optional<std::string> long_step_warning(const SimulationOptions& options, const Box3& scene, const Vec3& fall) {
    const double step = std::min(options.time_step, options.duration);
    const double displacement = 0.5 * length(fall) * step * step;
    const double size = scene.empty() ? 0.0 : scene.diagonal();
    if (options.flow || !(size > 0.0) || !(displacement > size)) return std::nullopt;
    return fmt::format(
        "simulation.time_step: in one step of {:.3g} s, a free fall from rest covers {:.3g} m, and the whole scene is "
        "{:.3g} m: times are in s, lengths in m; use a step of {:.1g} s or less, in which it covers a hundredth of it",
        step, displacement, size, 0.1 * std::sqrt(2.0 * size / length(fall)));
}

}  // namespace ricochet
