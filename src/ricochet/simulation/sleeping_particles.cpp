// Particles at rest that are not moved. Their weights still count in the totals of surfaces.
#include <vector>

#include "ricochet/simulation/active_mover.h"
#include "ricochet/simulation/sleeping_islands.h"

namespace ricochet {

std::uint64_t ActiveMover::add_weight(std::size_t i, double until, double sign) {
    SurfaceTotals& totals = parts_.recorder.totals();
    const double elapsed = until - parts_.store.particles().accounted_until[i];
    if (totals.empty() || !(elapsed > 0.0)) return 0;
    std::vector<SurfaceHit> hits;
    const std::uint64_t id = parts_.store.particles().id[i];
    const SleepingIslands* const sleeping_islands = parts_.hooks.sleeping_islands;
    if (sleeping_islands != nullptr && sleeping_islands->is_asleep(id)) {
        sleeping_islands->add_weight(id, elapsed, hits);
    } else if (parts_.store.is_asleep(i)) {
        MovingParticle sleeper = parts_.store.load(i, until, true);
        sleeper.state.coupling = coupled().coupling_of(i);
        response_.add_weight(sleeper, elapsed, hits);
    }
    for (SurfaceHit& hit : hits) hit.impulse *= sign;
    return totals.add(hits);
}

void ActiveMover::add_weights(double until, double sign) {
    for (std::size_t i = 0; i < parts_.store.size(); ++i) (void)add_weight(i, until, sign);
}

void ActiveMover::wake(std::size_t i, double time) {
    parts_.recorder.statistics().lost_impulses += add_weight(i, time, 1.0);
    parts_.store.wake(i);
    parts_.schedule.forget(i);
}

void ActiveMover::report_sleeper(std::size_t i, const TimeSpan& step, BlockRecord& record) const {
    if (!parts_.hooks.observers.needs().has_path()) return;
    const Particles& particles = parts_.store.particles();
    const Vec3& position = particles.position[i];
    const Segment staying{position, position, step.end, step.begin, step.end};
    const ForceInput moved = parts_.store.force_input(i, step.end);
    MoveReport report{i, particles, moved};
    report.end = report.stored_time = step.end;
    report.segments = {&staying, 1};
    parts_.hooks.observers.report(report, record);
}

}  // namespace ricochet
