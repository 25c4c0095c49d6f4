// Steps that can be stopped, and the return to the last whole step.
#include <atomic>
#include <chrono>
#include <utility>

#include "ricochet/simulation/impl.h"

namespace ricochet {

/// Makes a step. If it is stopped, restores the state before it and throws StoppedError.
void Simulation::Impl::step_unless_stopped(const std::function<bool()>& goes_on) {
    if (return_point.is_due() && !inside_step) keep_return_point();
    std::atomic<bool> is_stopped = false;
    const auto ask = [&] {
        if (is_stopped || (return_point.is_near() && !goes_on())) {
            is_stopped = true;  // for the other threads, too
            throw StoppedError("the step was stopped before its end");
        }
    };
    const auto start = std::chrono::steady_clock::now();
    stop.set(ask);
    try {
        step();
    } catch (const StoppedError&) {
        stop.set({});
        go_back();
        throw;
    } catch (...) {
        stop.set({});
        throw;
    }
    stop.set({});
    return_point.add_step(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

void Simulation::Impl::keep_return_point() {
    const bool was_deferring = free_flights.is_deferring();
    free_flights.end_deferring();
    return_point.keep([this](const ByteSink& sink) { save(sink); }, {emitters, recorder.violations()});
    if (was_deferring) free_flights.begin_deferring();
}

/// Restores the kept state, and repeats the steps since then without callbacks.
void Simulation::Impl::go_back() {
    free_flights.drop_deferred();
    read_state(return_point.source());
    forget_queries();
    emitters = return_point.beside().emitters;
    bind_modules();
    const double now = clock.time_at(recorder.statistics().steps);
    modules.each([&](Module& module) { module.restart(now); });
    recorder.forget_step(return_point.beside().violations);
    birth_records.clear();
    inside_step = false;
    const ContactCallback seen = std::exchange(callback, {});
    for (std::uint64_t k = return_point.steps(); k > 0; --k) step();
    callback = seen;
}

}  // namespace ricochet
