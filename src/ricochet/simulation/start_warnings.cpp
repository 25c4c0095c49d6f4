#include "ricochet/simulation/start_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/core/box_tools.h"
#include "ricochet/dynamics/neighbour_grid.h"
#include "ricochet/response/penalty.h"
#include "ricochet/verify/sphere_overlaps.h"

namespace ricochet {
namespace {

double lightest_particle(const SimulationSetup& setup) {
    double lightest = std::numeric_limits<double>::infinity();
    for (const Particle& particle : setup.particles) lightest = std::min(lightest, particle.mass);
    for (const auto& emitter : setup.emitters) lightest = std::min(lightest, least_mass(emitter));
    return lightest;
}

/// Returns the smallest restitution among the materials that surfaces use.
double least_restitution(const SimulationSetup& setup) {
    double least = 1.0;
    const auto use = [&](std::uint32_t material) {
        if (material < setup.materials.size()) least = std::min(least, setup.materials[material].restitution);
    };
    for (const ColliderDescription& collider : setup.colliders) visit_materials(collider, use);
    return least;
}

/// Returns a warning if the penalty sub-step exceeds the lightest particle's bound on the most damping surface.
std::vector<std::string> penalty_warnings(const SimulationSetup& setup) {
    const SimulationOptions& options = setup.options;
    const double mass = lightest_particle(setup);
    if (options.response != ResponseKind::penalty || setup.colliders.empty() || !std::isfinite(mass)) return {};
    const double restitution = least_restitution(setup);
    const ContactSpring spring = contact_spring(options, mass, restitution);
    const double bound = longest_stable_step(spring, mass);
    const double substep = options.time_step / options.penalty.substeps;
    if (substep <= bound) return {};
    const std::string advice =
        options.penalty.stiffness
            ? fmt::format("use at least {} substeps or a softer spring", std::ceil(options.time_step / bound))
            : fmt::format("use contact_steps of at least {}",
                          std::ceil(options.penalty.contact_steps * substep / bound));
    return {
        fmt::format("the penalty sub-step of {:.3g} s exceeds the stability bound of {:.3g} s (stiffness {:.3g} N/m, "
                    "lightest particle {:.3g} kg, restitution {}): contacts may explode; {}",
                    substep, bound, spring.stiffness, mass, restitution, advice)};
}

/// Returns a warning if spheres overlap surfaces.
std::optional<std::string> overlap_warning(const CollisionScene& scene, const Particles& particles) {
    std::size_t count = 0;
    std::size_t first = 0;
    std::uint32_t collider = 0;
    double first_depth = 0.0;
    double deepest = 0.0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double radius = particles.radius[i];
        const auto overlap = deepest_overlap(scene.moving(), particles.position[i], radius, 0.0);
        if (!overlap) continue;
        const double depth = radius - overlap->distance;
        if (count++ == 0) {
            first = i;
            first_depth = depth;
            collider = scene.list().collider_of(overlap->surface);
        }
        deepest = std::max(deepest, depth);
    }
    if (count == 0) return std::nullopt;
    return fmt::format(
        "{} {} born in overlap with a surface: the first is particle {}, {:.3g} m deep in {}; the deepest is {:.3g} m; "
        "they can leave and slide, but nothing pushes them out: place them a radius away",
        count, count == 1 ? "sphere is" : "spheres are", particles.id[first], first_depth,
        named(scene.list().all()[collider].name, "colliders", collider), deepest);
}

/// Returns a warning if spheres overlap each other. Counts these spheres. Spheres that only touch do not overlap.
std::optional<std::string> sphere_overlap_warning(const Particles& particles, std::uint64_t& born_in_overlap) {
    std::vector<Box3> boxes;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double radius = particles.radius[i];
        const bool meets = radius > 0.0 && particles.frozen[i] == 0;
        boxes.push_back(meets ? ball_box(particles.position[i], radius) : Box3{});
    }
    std::vector<std::uint8_t> is_inside(particles.size(), 0);
    std::optional<NeighbourPair> first;
    double deepest = 0.0;
    const auto depth_of = [&](const NeighbourPair& pair) {
        return particles.radius[pair.first] + particles.radius[pair.second] -
               length(particles.position[pair.first] - particles.position[pair.second]);
    };
    NeighbourGrid grid;
    for (const NeighbourPair& pair : grid.find_pairs(boxes)) {
        const double depth = depth_of(pair);
        if (!(depth > kMostMetOverlap * std::min(particles.radius[pair.first], particles.radius[pair.second]))) {
            continue;
        }
        if (!first) first = pair;
        deepest = std::max(deepest, depth);
        is_inside[pair.first] = is_inside[pair.second] = 1;
    }
    if (!first) return std::nullopt;
    const auto count = std::ranges::count(is_inside, 1);
    born_in_overlap = static_cast<std::uint64_t>(count);
    return fmt::format(
        "{} spheres are born in overlap with others: the first is particle {}, {:.3g} m deep in particle {}; the "
        "deepest is {:.3g} m; they get no deeper, but nothing parts them at once: place them the sum of their radii "
        "apart",
        count, particles.id[first->first], depth_of(*first), particles.id[first->second], deepest);
}

}  // namespace

std::string named(const std::string& name, const char* list, std::size_t number) {
    return name.empty() ? fmt::format("{}[{}]", list, number) : fmt::format("'{}'", name);
}

StartWarnings::StartWarnings(const SimulationSetup& setup)
    : texts_(penalty_warnings(setup)), knows_implicit_(may_be_implicit(setup)) {
    for (std::string& warning : stability_warnings(setup)) texts_.push_back(std::move(warning));
}

void StartWarnings::add_overlaps(const CollisionScene& scene, const Particles& particles, bool do_spheres_meet,
                                 SimulationStatistics& statistics) {
    std::optional<std::string> found;
    if (statistics.started_in_overlap > 0) found = overlap_warning(scene, particles);
    if (found) texts_.push_back(std::move(*found));
    found = do_spheres_meet ? sphere_overlap_warning(particles, statistics.born_in_overlap) : std::nullopt;
    if (found) texts_.push_back(std::move(*found));
}

}  // namespace ricochet
