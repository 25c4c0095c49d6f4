// How a simulation is made, and how particles come into it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/core/algorithms.h"
#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/springs.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/response/penalty.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {
namespace {

/// A final step shorter than this fraction of a step is not made: duration / time_step is meant to be whole.
constexpr double kStepRounding = 1e-6;

std::uint64_t count_steps(const SimulationOptions& options) {
    return static_cast<std::uint64_t>(std::max(0.0, std::ceil(options.duration / options.time_step - kStepRounding)));
}

SimulationOptions checked(const SimulationOptions& options) {
    if (!(options.time_step > 0.0) || !std::isfinite(options.time_step)) {
        throw InputError("time_step must be a finite number above 0 s");
    }
    if (!(options.duration >= 0.0) || !std::isfinite(options.duration)) {
        throw InputError("duration must be a finite number of at least 0 s");
    }
    if (options.duration / options.time_step > 1e15) throw InputError("duration / time_step exceeds 1e15 steps");
    if (!(options.resting_speed >= 0.0)) throw InputError("resting_speed must be at least 0 m/s");
    if (!(options.frame_rate > 0.0) || !std::isfinite(options.frame_rate)) {
        throw InputError("frame_rate must be a finite number above 0 frames a second");
    }
    if (options.bounce_budget == 0) throw InputError("bounce_budget must be at least 1");
    return options;
}

/// Throws where a collider or one of its triangles names a material that is not there.
std::vector<Material> checked_materials(std::vector<Material> materials,
                                        const std::vector<ColliderDescription>& colliders) {
    for (const ColliderDescription& collider : colliders) {
        if (collider.material >= materials.size())
            throw InputError("collider \"" + collider.name + "\" has no material");
        const auto* const mesh = std::get_if<MeshShape>(&collider.shape);
        if (mesh == nullptr || mesh->triangle_materials.empty()) continue;
        const auto& list = mesh->triangle_materials;
        if (*std::max_element(list.begin(), list.end()) >= materials.size())
            throw InputError("collider \"" + collider.name + "\" has triangles without a material");
    }
    return materials;
}

bool makes_spheres(const SimulationSetup& setup) {
    return std::any_of(setup.particles.begin(), setup.particles.end(),
                       [](const Particle& particle) { return particle.radius > 0.0; }) ||
           std::any_of(setup.emitters.begin(), setup.emitters.end(), [](const EmitterDescription& emitter) {
               return emitter.radius.mean > 0.0 || emitter.radius.spread > 0.0;
           });
}

ResponseSettings response_settings(const SimulationOptions& options) {
    return {options.integrator, options.resting_speed, options.bounce_budget, options.seed,
            options.time_step,  options.rollback,      options.project,       options.penalty,
            options.flow,       options.walls,         options.look_ahead,    options.duration};
}

double lightest_particle(const SimulationSetup& setup) {
    double lightest = std::numeric_limits<double>::infinity();
    for (const Particle& particle : setup.particles) lightest = std::min(lightest, particle.mass);
    for (const auto& emitter : setup.emitters) lightest = std::min(lightest, emitter.mass.mean - emitter.mass.spread);
    return lightest;
}

/// Smallest restitution among the materials that surfaces use.
double least_restitution(const SimulationSetup& setup) {
    double least = 1.0;
    const auto use = [&](std::uint32_t material) {
        if (material < setup.materials.size()) least = std::min(least, setup.materials[material].restitution);
    };
    for (const ColliderDescription& collider : setup.colliders) {
        use(collider.material);
        const auto* const mesh = std::get_if<MeshShape>(&collider.shape);
        if (mesh != nullptr) std::for_each(mesh->triangle_materials.begin(), mesh->triangle_materials.end(), use);
    }
    return least;
}

/// The sub-step against the stability bound of the lightest particle on the dampest of the surfaces.
std::vector<std::string> penalty_warnings(const SimulationSetup& setup) {
    const SimulationOptions& options = setup.options;
    const double mass = lightest_particle(setup);
    if (options.response != ResponseKind::penalty || setup.colliders.empty() || !std::isfinite(mass)) return {};
    const double restitution = least_restitution(setup);
    const ContactSpring spring = contact_spring(response_settings(options), mass, restitution);
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

std::vector<std::string> spring_warnings(const SimulationSetup& setup) {
    if (setup.solver) return {};
    const IntegratorKind kind = setup.options.integrator.kind;
    const double bound = longest_stable_step(kind, setup.springs, setup.particles);
    if (setup.options.time_step <= bound) return {};
    return {
        fmt::format("the time step of {:.3g} s exceeds {:.3g} s, up to which {} is sure to be stable with these "
                    "springs: they may explode; use a shorter step or the integrator implicit_euler",
                    setup.options.time_step, bound, name_of(kind))};
}

double room_beside_chords(const SimulationOptions& options, const ForceField& forces) {
    const bool is_straight = forces.common_acceleration() == std::optional(Vec3{});
    return options.look_ahead && forces.is_uniform() && !is_straight ? kLookAheadMargin : kChordMargin;
}

std::vector<std::string> warnings_of(const SimulationSetup& setup) {
    std::vector<std::string> warnings = penalty_warnings(setup);
    for (std::string& warning : spring_warnings(setup)) warnings.push_back(std::move(warning));
    return warnings;
}

}  // namespace

Simulation::Impl::Impl(SimulationSetup setup)
    : options(checked(setup.options)),
      warnings(warnings_of(setup)),
      forces(std::move(setup.forces)),
      materials(checked_materials(std::move(setup.materials), setup.colliders)),
      world(std::move(setup.colliders), room_beside_chords(options, forces)),
      coupled(std::move(setup.springs), std::move(setup.solver), forces, options.integrator),
      bounds(setup.bounds),
      response(make_response(options.response, {world, forces, materials, response_settings(options)})),
      totals(options.triangle_totals ? world.surface_count() : 0),
      steps(count_steps(options)),
      may_sleep(options.sleeping && forces.is_steady()) {
    world.set_culling(options.culling);
    has_spheres = makes_spheres(setup);
    particles.attributes = AttributeTable(setup.attributes);
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        const EmitterDescription& emitter = setup.emitters[k];
        particles.keeps_origin = particles.keeps_origin || emitter.parent || !emitter.curves.empty();
        emitters.emplace_back(std::move(setup.emitters[k]), options.seed, static_cast<std::uint32_t>(k),
                              EmitterSurroundings{options.frame_rate, setup.reference_camera, setup.attributes});
    }
    offspring = std::make_unique<Offspring>(emitters, OffspringLimits{options.max_depth, options.most_particles});
    if (offspring->empty()) offspring.reset();
    make_room(setup.particles.size());
    for (const Particle& particle : setup.particles) add(particle);
    spring_faces = std::move(setup.spring_faces);
    if (coupled.is_active()) coupled.bind(particles);
    if (options.verify) check = std::make_unique<RunCheck>(world);
}

void Simulation::Impl::make_room(std::size_t births) {
    particles.reserve(births);
    grow_capacity_by(next_query_step, births);
    grow_capacity_by(candidates, births);
    if (deferred) deferred->reserve(births);
    if (response->keeps_sides()) grow_capacity_by(sides, births * world.colliders().size());
}

void Simulation::Impl::add(Particle particle) {
    particle.id = next_id++;
    particle.position = flush_tiny(particle.position);
    const auto size = particles.attributes.find(kSizeAttribute);
    if (size) {
        particle.attributes.resize(particles.attributes.columns().size(), missing_attribute());
        if (is_missing(particle.attributes[*size])) particle.attributes[*size] = {particle.radius, 0.0, 0.0};
    }
    if (particle.pinned) particle.velocity = particle.spin = Vec3{};
    world.prepare_radius(particle.radius);
    if (starts_in_overlap(particle)) ++statistics.started_inside;
    particles.append(particle);
    next_query_step.push_back(particle.pinned ? kStill : 0);
    candidates.emplace_back();
    if (deferred) deferred->append();
    if (response->keeps_sides()) {
        sides.resize(particles.size() * world.colliders().size());
        if (is_finite(particle.position)) response->first_sides(particle.position, sides_of(particles.size() - 1));
    }
    ++statistics.emitted;
}

bool Simulation::Impl::starts_in_overlap(const Particle& particle) const {
    if (!is_finite(particle.position) || max_abs(particle.position) > kLargestCoordinate) return false;
    ContactScratch scratch;
    ContactSearch search(world, scratch);
    (void)search.search(line_path(particle.position, Vec3{}, 0.0), particle.radius);
    return search.starts_in_overlap();
}

// Births of all emitters are merged by (birth time, emitter), which fixes the ids for any time step.
void Simulation::Impl::emit(double from, double to) {
    std::vector<Particle> born;
    for (Emitter& emitter : emitters) {
        const std::vector<Particle> births = emitter.births(from, to);
        born.insert(born.end(), births.begin(), births.end());
    }
    std::stable_sort(born.begin(), born.end(),
                     [](const Particle& a, const Particle& b) { return a.birth_time < b.birth_time; });
    const std::uint64_t room =
        options.most_particles - std::min<std::uint64_t>(options.most_particles, particles.size());
    const std::size_t allowed = std::min<std::uint64_t>(born.size(), room);
    statistics.births_refused_by_population += born.size() - allowed;
    make_room(allowed);
    for (std::size_t k = 0; k < allowed; ++k) add(born[k]);
    if (allowed > 0 && coupled.is_active()) coupled.bind(particles);
}

}  // namespace ricochet
