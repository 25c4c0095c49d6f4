// One step of the simulation, stage by stage, and the return from a stopped step to the state before it.
#include <cstdint>
#include <utility>
#include <vector>

#include "ricochet/simulation/impl.h"

namespace ricochet {

void Simulation::Impl::step() {
    reporter.require_idle();
    control.make([this] { make_step(); });
    reporter.report(recorder.contact_records());
}

// Moves all particles over the step. Newly spawned children are moved from their birth time to the end of the step.
// Children can spawn children, so this repeats until a generation spawns none.
void Simulation::Impl::make_step() {
    SimulationStatistics& statistics = recorder.statistics();
    const TimeSpan step = clock.span_of(statistics.steps);
    recorder.begin_step();
    population.schedule().begin_step(statistics.steps);
    modules.each([&](Module& module) { module.begin_step(step); });
    scene.begin_step(step);
    control.stop().poll();
    emission.emit(step);
    ParticleRange generation{0, population.size()};
    for (bool is_born = true; is_born;) {
        move_generation(generation, step);
        const std::size_t first = population.size();
        is_born = modules.spawn(step);
        generation = {first, population.size(), true};
    }
    modules.each([&](Module& module) { module.retire(step.end); });
    modules.each([&](Module& module) { module.verify(step); });
    recorder.end_step();
    statistics.unsolved_steps = 0;
    modules.each([&](Module& module) { module.end_step(statistics); });
    ++statistics.steps;
}

// Moves a spawn generation over the step, in one or more substeps. Each substep is recorded separately, so that the
// events of a particle stay in the order of time.
void Simulation::Impl::move_generation(const ParticleRange& generation, const TimeSpan& step) {
    recorder.begin_generation();
    modules.each([&](Module& module) { module.before_generation(generation, step); });
    for (double now = step.begin; now < step.end;) {
        control.stop().poll();
        const TimeSpan substep = modules.plan(generation, {now, step.end});  // only springs and bodies shorten it
        std::vector<BlockRecord> blocks;
        modules.each([&](Module& module) { module.before_substep(generation, substep); });
        move_substep(generation, substep, blocks);
        modules.each([&](Module& module) { module.after_substep(generation, substep, blocks); });
        modules.each([&](Module& module) { module.correct(generation, substep, blocks); });
        record(generation, blocks);
        now = substep.end;
    }
    modules.each([&](Module& module) { module.after_generation(generation, step); });
    recorder.end_generation(generation.size());
}

void Simulation::Impl::move_substep(const ParticleRange& generation, const TimeSpan& substep,
                                    std::vector<BlockRecord>& blocks) {
    if (options.response == ResponseKind::rollback && options.rollback.global) {
        mover.move_as_system(generation, substep, blocks);
    } else {
        const ActiveSet active = population.advance(generation, substep, blocks);  // moves free flights, returns others
        mover.move(active, substep, blocks);
    }
}

void Simulation::Impl::record(const ParticleRange& generation, const std::vector<BlockRecord>& blocks) {
    recorder.record(blocks);
    std::vector<ColliderLoad> loads = joined(blocks, &BlockRecord::loads);
    modules.each([&](Module& module) { module.record(generation, blocks, loads); });
    recorder.add_loads(loads, scene.list());
}

/// Makes a step. If the step is stopped, restores the state before the step and throws StoppedError.
void Simulation::Impl::step_unless_stopped(const std::function<bool()>& goes_on) {
    if (control.return_point().is_due() && control.is_between_steps()) keep_return_point();
    try {
        control.make_stoppable(goes_on, [this] { step(); });
    } catch (const StoppedError&) {
        go_back();
        throw;
    }
}

void Simulation::Impl::keep_return_point() {
    FreeFlights& flights = population.flights();
    const bool was_deferring = flights.is_deferring();
    flights.end_deferring();
    control.return_point().keep([this](const ByteSink& sink) { save_state(parts(), modules, sink); },
                                {emission.emitters(), recorder.violations()});
    if (was_deferring) flights.begin_deferring();
}

/// Restores the state of the return point, and repeats the steps since this state without callbacks.
void Simulation::Impl::go_back() {
    const ReturnPoint& kept = control.return_point();
    control.replace([&] {
        restore(kept.source());
        emission.go_back(kept.beside().emitters);
        modules.each([now = now()](Module& module) { module.restart(now); });
        recorder.forget_step(kept.beside().violations);
        if (ChildrenModule* const children = modules.find<ChildrenModule>()) children->forget_births();
    });
    ContactCallback seen = reporter.take();
    for (std::uint64_t k = kept.steps(); k > 0; --k) step();
    reporter.set(std::move(seen));
}

void Simulation::step() {
    impl().control.return_point().invalidate();
    if (!finished()) impl().step();
}

void Simulation::advance(std::uint64_t count, const std::function<bool()>& go_on,
                         const std::function<bool()>& goes_on_within) {
    FreeFlights& flights = impl().population.flights();
    if (count > 1 && impl().population.may_defer()) flights.begin_deferring();
    // Ranks that share a run stop only at the end of a step, all at the same one.
    const bool may_stop = goes_on_within && impl().share.is_alone();
    if (!may_stop) impl().control.return_point().invalidate();
    try {
        bool goes_on = true;
        for (std::uint64_t k = 0; k < count && goes_on && !finished(); ++k) {
            may_stop ? impl().step_unless_stopped(goes_on_within) : impl().step();
            goes_on = !go_on || go_on();
        }
    } catch (...) {
        flights.end_deferring();
        throw;
    }
    flights.end_deferring();
}

}  // namespace ricochet
