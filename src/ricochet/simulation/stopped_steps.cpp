// Steps that can be stopped, and the return to the last whole step.
#include "ricochet/simulation/children_module.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {

/// Makes a step. If it is stopped, restores the state before it and throws StoppedError.
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
    control.return_point().keep([this](const ByteSink& sink) { state().save(sink); },
                                {emission.emitters(), recorder.violations()});
    if (was_deferring) flights.begin_deferring();
}

/// Restores the kept state, and repeats the steps since then without callbacks.
void Simulation::Impl::go_back() {
    const ReturnPoint& kept = control.return_point();
    control.replace([&] {
        read_state(kept.source());
        emission.go_back(kept.beside().emitters);
        modules.each([now = now()](Module& module) { module.restart(now); });
        recorder.forget_step(kept.beside().violations);
        if (ChildrenModule* const children = modules.find<ChildrenModule>()) children->forget_births();
    });
    ContactCallback seen = reporter.take();
    for (std::uint64_t k = kept.steps(); k > 0; --k) step();
    reporter.set(std::move(seen));
}

}  // namespace ricochet
