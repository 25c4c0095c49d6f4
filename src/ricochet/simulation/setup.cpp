// Construction of a simulation.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/neighbour_grid.h"
#include "ricochet/response/penalty.h"
#include "ricochet/simulation/impl.h"
#include "ricochet/simulation/memory_estimate.h"
#include "ricochet/simulation/stability_warnings.h"
#include "ricochet/simulation/validation.h"
#include "ricochet/verify/sphere_overlaps.h"

namespace ricochet {
namespace {

bool makes_spheres(const SimulationSetup& setup) {
    return std::any_of(setup.particles.begin(), setup.particles.end(),
                       [](const Particle& particle) { return particle.radius > 0.0; }) ||
           std::any_of(setup.emitters.begin(), setup.emitters.end(), [](const EmitterDescription& emitter) {
               return emitter.radius.mean > 0.0 || emitter.radius.spread > 0.0;
           });
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
        visit_materials(collider, use);
    }
    return least;
}

/// Compares the substep with the stability bound of the lightest particle on the surface with the most damping.
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

/// Returns the distance that paths may lie beside their chords. It is larger if the look-ahead follows parabolas.
double chord_margin(const AccelerationSwitches& acceleration, const ForceField& forces) {
    const bool is_straight = forces.common_acceleration() == std::optional(Vec3{});
    return acceleration.look_ahead && forces.is_uniform() && !is_straight ? kLookAheadMargin : kChordMargin;
}

std::vector<std::string> warnings_of(const SimulationSetup& setup) {
    std::vector<std::string> warnings = penalty_warnings(setup);
    for (std::string& warning : stability_warnings(setup)) warnings.push_back(std::move(warning));
    return warnings;
}

std::vector<Emitter> make_emitters(SimulationSetup& setup) {
    std::vector<Emitter> emitters;
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        emitters.emplace_back(std::move(setup.emitters[k]), setup.options.seed, static_cast<std::uint32_t>(k),
                              EmitterSurroundings{setup.options.frame_rate, setup.reference_camera, setup.attributes});
    }
    return emitters;
}

/// Copies the frames, because the paths of bodies belong to this simulation.
std::shared_ptr<FrameTree> own_frames(const SimulationSetup& setup) {
    return setup.frames ? std::make_shared<FrameTree>(*setup.frames) : nullptr;
}

/// Returns the number of colliders with recorded loads: all or none.
std::size_t count_with_loads(const MovingColliders* bodies, const std::vector<Material>& materials,
                             const ColliderList& colliders) {
    const bool drives = std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.drives(); });
    return bodies != nullptr || drives ? colliders.all().size() : 0;
}

/// Returns null if no collider moves.
std::unique_ptr<MovingColliders> make_bodies(const CollisionWorld& world,
                                             const std::shared_ptr<ColliderList>& colliders,
                                             const std::shared_ptr<const FrameTree>& frames) {
    auto bodies = std::make_unique<MovingColliders>(world, colliders, frames, kChordMargin);
    if (bodies->empty()) bodies.reset();
    return bodies;
}

/// Returns null if no emitter has a parent.
std::unique_ptr<Offspring> make_offspring(const std::vector<Emitter>& emitters, const SimulationOptions& options) {
    auto offspring = std::make_unique<Offspring>(emitters, OffspringLimits{options.max_depth, options.most_particles});
    if (offspring->empty()) offspring.reset();
    return offspring;
}

/// Returns null without clouds.
std::unique_ptr<CloudMotion> make_clouds(const std::vector<Emitter>& emitters, const MoverParts& parts,
                                         ActiveMover& mover) {
    if (std::none_of(emitters.begin(), emitters.end(), [](const Emitter& e) { return is_cloud(e.description()); })) {
        return nullptr;
    }
    return std::make_unique<CloudMotion>(emitters, parts, mover);
}

/// Returns null if spheres do not meet.
std::unique_ptr<PairMotion> make_pairs(const SimulationOptions& options, ParticleStore& store, QuerySchedule& schedule,
                                       ActiveMover& mover, const Response& response, const CoupledMotion& coupled) {
    if (!options.particle_contacts) return nullptr;
    const PairContactSettings& settings = *options.particle_contacts;
    PairParts parts{store, schedule, mover, response, coupled, settings, PairMaterials(settings)};
    if (!settings.materials.empty()) parts.material_column = store.particles().attributes.find(kMaterialAttribute);
    return std::make_unique<PairMotion>(parts);
}

/// Returns null if temperatures do not change.
std::unique_ptr<HeatStage> make_heat(std::optional<HeatSettings>& heat, const ParticleStore& store,
                                     const ForceField& forces, const MovingColliders* bodies) {
    if (!heat) return nullptr;
    const auto column = store.particles().attributes.find(kTemperatureAttribute);
    return std::make_unique<HeatStage>(std::move(*heat), column.value(), forces, bodies);
}

/// Returns null without counters.
std::unique_ptr<CounterTally> make_counters(const SimulationSetup& setup) {
    if (setup.counters.empty()) return nullptr;
    return std::make_unique<CounterTally>(setup.counters, setup.options.response == ResponseKind::exact);
}

bool keeps_origin(const std::vector<Emitter>& emitters, const std::vector<ParticlesForceEntry>& mutual) {
    const bool asks_for_emitters = std::any_of(
        mutual.begin(), mutual.end(), [](const ParticlesForceEntry& entry) { return !entry.emitters.empty(); });
    return asks_for_emitters || std::any_of(emitters.begin(), emitters.end(), [](const Emitter& emitter) {
               return emitter.description().parent || !emitter.description().curves.empty();
           });
}

std::string named(const ColliderDescription& collider, std::size_t number) {
    return collider.name.empty() ? fmt::format("colliders[{}]", number) : fmt::format("'{}'", collider.name);
}

/// The memory of the machine decides only whether a run continues, never its results.
std::uint64_t particles_that_fit(double bytes_each) {
    return static_cast<std::uint64_t>(std::min(memory_limit().bytes / bytes_each, 0x1p63));
}

}  // namespace

std::optional<std::string> Simulation::Impl::overlap_warning() const {
    std::size_t count = 0;
    std::size_t first = 0;
    std::uint32_t collider = 0;
    double first_depth = 0.0;
    double deepest = 0.0;
    for (std::size_t i = 0; i < store.size() && recorder.statistics().started_in_overlap > 0; ++i) {
        const double radius = particles().radius[i];
        const auto overlap = deepest_overlap(world, bodies.get(), particles().position[i], radius, 0.0);
        if (!overlap) continue;
        const double depth = radius - overlap->distance;
        if (count++ == 0) {
            first = i;
            first_depth = depth;
            collider = world.name_of(overlap->surface).collider;
        }
        deepest = std::max(deepest, depth);
    }
    if (count == 0) return std::nullopt;
    return fmt::format(
        "{} {} born in overlap with a surface: the first is particle {}, {:.3g} m deep in {}; the deepest is {:.3g} m; "
        "they can leave and slide, but nothing pushes them out: place them a radius away",
        count, count == 1 ? "sphere is" : "spheres are", particles().id[first], first_depth,
        named(world.colliders()[collider], collider), deepest);
}

/// Spheres that only touch do not overlap.
std::optional<std::string> Simulation::Impl::sphere_overlap_warning() {
    if (!pairs) return std::nullopt;
    std::vector<Box3> boxes;
    for (std::size_t i = 0; i < store.size(); ++i) {
        const double radius = particles().radius[i];
        const bool meets = radius > 0.0 && particles().frozen[i] == 0;
        boxes.push_back(meets ? ball_box(particles().position[i], radius) : Box3{});
    }
    std::vector<std::uint8_t> is_inside(store.size(), 0);
    std::optional<NeighbourPair> first;
    double deepest = 0.0;
    const auto depth_of = [&](const NeighbourPair& pair) {
        return particles().radius[pair.first] + particles().radius[pair.second] -
               length(particles().position[pair.first] - particles().position[pair.second]);
    };
    NeighbourGrid grid;
    for (const NeighbourPair& pair : grid.find_pairs(boxes)) {
        const double depth = depth_of(pair);
        if (!(depth > kMostMetOverlap * std::min(particles().radius[pair.first], particles().radius[pair.second]))) {
            continue;
        }
        if (!first) first = pair;
        deepest = std::max(deepest, depth);
        is_inside[pair.first] = is_inside[pair.second] = 1;
    }
    if (!first) return std::nullopt;
    const auto count = std::count(is_inside.begin(), is_inside.end(), 1);
    recorder.statistics().born_in_overlap = static_cast<std::uint64_t>(count);
    return fmt::format(
        "{} spheres are born in overlap with others: the first is particle {}, {:.3g} m deep in particle {}; the "
        "deepest is {:.3g} m; they get no deeper, but nothing parts them at once: place them the sum of their radii "
        "apart",
        count, particles().id[first->first], depth_of(*first), particles().id[first->second], deepest);
}

void Simulation::Impl::add_first(std::vector<Particle>& first) {
    reserve(first.size());
    std::vector<Particle*> added;
    for (Particle& particle : first) {
        particle.id = store.next_id() + added.size();
        added.push_back(&particle);
    }
    add_all(added);
    if (auto warning = overlap_warning()) warnings.push_back(std::move(*warning));
    if (auto warning = sphere_overlap_warning()) warnings.push_back(std::move(*warning));
}

void Simulation::Impl::connect() {
    coupled.call_between([this] { stop.poll(); });
    world.set_culling(acceleration.culling);
    if (bodies) {
        bodies->set_culling(acceleration.culling);
        if (driven.is_active()) driven.plan(0.0, options.time_step, 0.0);
        bodies->begin_step(0.0, options.time_step);
    }
    if (clouds) {
        mover.set_clouds(clouds.get());
        offspring->set_clouds(clouds.get(), spawn_test());
    }
}

Simulation::Impl::Impl(SimulationSetup setup)
    : options(validated(setup).options),
      particle_bytes(bytes_per_particle(setup)),
      acceleration(setup.acceleration),
      share(std::move(setup.ranks)),
      clock(options.time_step, options.duration),
      warnings(warnings_of(setup)),
      knows_implicit(may_be_implicit(setup)),
      has_spheres(makes_spheres(setup)),
      forces(std::move(setup.forces)),
      materials(std::move(setup.materials)),
      colliders(std::make_shared<ColliderList>(std::move(setup.colliders))),
      shared_world(std::make_shared<CollisionWorld>(colliders, std::string_view(), chord_margin(acceleration, forces))),
      world(*shared_world),
      frames(own_frames(setup)),
      bodies(make_bodies(world, colliders, frames)),
      driven(std::move(setup.bodies), frames.get(), bodies.get(), forces, options),
      queries(Simulation::queries_of(shared_world)),
      coupled(std::move(setup.springs), setup.particles_forces, std::move(setup.solver), forces, options.integrator,
              {options.time_step, knows_implicit}),
      emitters(make_emitters(setup)),
      offspring(make_offspring(emitters, options)),
      bounds(setup.bounds),
      response(make_response(options.response, {world, forces, materials, options, options.duration,
                                                acceleration.look_ahead && !bodies, bodies.get(), nullptr, &stop})),
      store(setup.attributes, keeps_origin(emitters, setup.particles_forces),
            acceleration.sleeping && forces.is_steady() && !(bodies && options.verify),
            response->keeps_sides() ? world.colliders().size() : 0, bodies != nullptr),
      spring_faces(std::move(setup.spring_faces)),
      schedule(clock),
      check(options.verify ? std::make_unique<RunCheck>(world, bodies.get()) : nullptr),
      heat(make_heat(setup.heat, store, forces, bodies.get())),
      counters(make_counters(setup)),
      recorder(options.triangle_totals ? world.surface_count() : 0,
               count_with_loads(bodies.get(), materials, *colliders), options.record_contacts,
               offspring != nullptr || (heat && heat->meter() != nullptr)),
      free_flights(store, schedule, forces, options.integrator, check.get(), counters ? &counters->finder() : nullptr),
      mover({store, schedule, recorder, *response, coupled, offspring.get(), check.get(),
             heat ? heat->meter() : nullptr, counters ? &counters->finder() : nullptr}),
      clouds(make_clouds(emitters,
                         {store, schedule, recorder, *response, coupled, offspring.get(), check.get(),
                          heat ? heat->meter() : nullptr, counters ? &counters->finder() : nullptr},
                         mover)),
      pairs(make_pairs(options, store, schedule, mover, *response, coupled)),
      retirement(store, schedule, bounds) {
    connect();
    if (!share.is_alone()) keep_springs_together();
    modules = make_modules({store, recorder, mover, clock, world, materials, options, bounds, retirement, share,
                            bodies.get(), offspring.get(), heat.get(), clouds.get(), driven, coupled, pairs.get(),
                            check.get(), counters.get()});
    add_first(setup.particles);
    if (!share.is_alone()) keep_share();
    bind_modules();
    most_that_fit = store.size() + particles_that_fit(particle_bytes);
    if (offspring) offspring->set_memory(most_that_fit, particle_bytes);
}

}  // namespace ricochet
