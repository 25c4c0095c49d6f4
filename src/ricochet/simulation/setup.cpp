// Construction of a simulation.
#include <algorithm>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/impl.h"
#include "ricochet/simulation/validation.h"

namespace ricochet {
namespace {

/// Returns the chord margin for CollisionWorld. The margin is larger if the look-ahead follows parabolas.
double chord_margin(const AccelerationSwitches& acceleration, const ForceField& forces) {
    const bool is_straight = forces.common_acceleration() == std::optional(Vec3{});
    return acceleration.look_ahead && forces.is_uniform() && !is_straight ? kLookAheadMargin : kChordMargin;
}

bool keeps_origin(const SimulationSetup& setup) {
    const auto asks_for_emitters = [](const ParticlesForceEntry& entry) { return !entry.emitters.empty(); };
    const auto has_curves = [](const EmitterDescription& emitter) { return !emitter.curves.empty(); };
    return has_children(setup) || std::ranges::any_of(setup.particles_forces, asks_for_emitters) ||
           std::ranges::any_of(setup.emitters, has_curves);
}

ParticleStore make_store(const SimulationSetup& setup, const CollisionScene& scene, const Response& response) {
    const std::size_t sides = response.keeps_sides() ? scene.list().all().size() : 0;
    return {setup.attributes, keeps_origin(setup), false, sides, !scene.moving().empty()};
}

RunRecorder make_recorder(const SimulationSetup& setup, const CollisionScene& scene) {
    const SimulationOptions& options = setup.options;
    const bool heats = setup.heat && setup.heat->is_heated_by_surfaces();
    return {options.triangle_totals ? scene.world().surface_count() : 0,
            scene.has_loads() ? scene.list().all().size() : 0, options.record_contacts, has_children(setup) || heats};
}

}  // namespace

Simulation::Impl::Impl(SimulationSetup& setup, double particle_bytes)
    : options(validated(setup).options),
      warnings(setup),
      clock(options.time_step, options.duration),
      share(std::move(setup.ranks)),
      forces(std::move(setup.forces)),
      scene(std::move(setup.colliders), std::move(setup.materials), setup.frames,
            chord_margin(setup.acceleration, forces)),
      queries(Simulation::queries_of(scene.shared_world())),
      response(make_response(options.response,
                             {scene.world(), scene.moving(), forces, scene.materials(), options, options.duration,
                              setup.acceleration.look_ahead && scene.moving().empty(), nullptr, &control.stop()})),
      recorder(make_recorder(setup, scene)),
      population(make_store(setup, scene, *response), setup.acceleration, particle_bytes,
                 {options, scene, *response, clock, recorder, modules}),
      emission(setup, population, share),
      mover({population.store(), population.schedule(), recorder, modules.hooks()}, *response) {
    scene.set_culling(setup.acceleration.culling);
    add_modules(modules, setup, parts());
    scene.begin_step({0.0, options.time_step});
    emission.add_first(setup.particles);
    warnings.add_overlaps(scene, particles(), options.particle_contacts.has_value(), recorder.statistics());
    if (SharedRun* const shared = modules.find<SharedRun>()) shared->take_share();
    population.bind();
    population.memory().measure(population.size());
}

}  // namespace ricochet
