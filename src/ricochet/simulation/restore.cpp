// Functions with which users save and restore a run.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/core/error.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {

/// Reads a whole state, or throws.
void Simulation::Impl::restore(const ByteSource& source) {
    population.flights().drop_deferred();
    read_state(parts(), modules, source);
    population.forget_queries();
    population.bind();
}

void Simulation::save(const ByteSink& sink) const {
    if (!sink) throw InputError("save: found an empty function, expected one that takes the bytes");
    if (!impl().control.is_between_steps()) {
        throw RunError("save: the last step or restore() of this simulation has ended with an error");
    }
    save_state(impl().parts(), impl().modules, sink);
}

// Wakes particles that slept in the saved run, if particles may not sleep in this run. Before that, adds the weights
// with which they have pressed on their supports until now.
void Simulation::Impl::wake_all_sleepers() {
    ParticleStore& store = population.store();
    if (store.may_sleep()) return;
    store.set_may_sleep(true);
    mover.add_weights(now(), 1.0);
    store.set_may_sleep(false);
    for (std::size_t i = 0; i < store.size(); ++i) store.wake(i);
}

void Simulation::restore(const ByteSource& source) {
    if (!source) throw InputError("restore: found an empty function, expected one that gives the bytes");
    if (!impl().emission.emitters().empty() && step_index() > 0) {
        throw InputError(
            fmt::format("restore: found a simulation with emitters that has made {} steps, expected one "
                        "before its first step",
                        step_index()));
    }
    Impl& run = impl();
    run.control.return_point().invalidate();
    run.control.replace([&] {
        run.restore(source);
        for (const double radius : run.particles().radius) run.scene.prepare_radius(radius);
        run.emission.replay(step_index(), time());
        if (SharedRun* const shared = run.modules.find<SharedRun>()) shared->take_share();
        run.wake_all_sleepers();
        run.modules.each([&](Module& module) { module.restart(time()); });
    });
}

void Simulation::save_particles(const ByteSink& sink) const {
    if (!sink) throw InputError("save_particles: found an empty function, expected one that takes the bytes");
    if (!springs().empty())
        throw InputError("save_particles: found springs, expected none: a part does not know both ends");
    if (!impl().control.is_between_steps()) {
        throw RunError("save_particles: the last step or restore() of this simulation has ended with an error");
    }
    const std::vector<std::byte> bytes = archived_bytes(impl().population.store());
    sink(bytes);
}

void Simulation::restore_particles(const ByteSource& source) {
    if (!source) throw InputError("restore_particles: found an empty function, expected one that gives the bytes");
    impl().control.return_point().invalidate();
    impl().control.replace([&] {
        Population& population = impl().population;
        ParticleStore part = population.store().empty_copy();
        BinaryReader reader(source);
        part.archive(reader);
        if (part.next_id() != population.store().next_id()) throw InputError("the particles belong to another state");
        const std::vector<std::uint64_t>& ids = part.particles().id;
        if (!std::ranges::is_sorted(ids)) {
            throw InputError("the particles are damaged: they are not in the order of their ids");
        }
        std::vector<std::uint8_t> keep;
        for (const std::uint64_t id : ids) keep.push_back(impl().share.has_place_for(id) ? 1 : 0);
        part.compact(keep);
        population.merge({archived_bytes(part)});
        require_sound_state(impl().parts(), impl().modules);
        impl().share.add_births(keep.size());
        impl().wake_all_sleepers();
    });
}

}  // namespace ricochet
