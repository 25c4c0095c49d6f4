#include "ricochet/simulation/sleeping_particles.h"

#include <vector>

#include "ricochet/simulation/active_mover.h"
#include "ricochet/simulation/sleeping_islands.h"

namespace ricochet {

std::uint64_t SleepingParticles::add_weight(std::size_t i, double until, double sign) {
    SurfaceTotals& totals = recorder_.totals();
    const double elapsed = until - store_.particles().accounted_until[i];
    if (totals.empty() || !(elapsed > 0.0)) return 0;
    std::vector<SurfaceHit> hits;
    const std::uint64_t id = store_.particles().id[i];
    const SleepingIslands* const sleeping_islands = observers_.sleeping_islands;
    if (sleeping_islands != nullptr && sleeping_islands->is_asleep(id)) {
        sleeping_islands->add_weight(id, elapsed, hits);
    } else if (store_.is_asleep(i)) {
        MovingParticle sleeper = store_.load(i, until, true);
        sleeper.state.coupling = observers_.coupled->coupling_of(i);
        response_.add_weight(sleeper, elapsed, hits);
    }
    for (SurfaceHit& hit : hits) hit.impulse *= sign;
    return totals.add(hits);
}

void SleepingParticles::add_weights(double until, double sign) {
    for (std::size_t i = 0; i < store_.size(); ++i) (void)add_weight(i, until, sign);
}

void SleepingParticles::add_to_totals(std::span<const SurfaceHit> hits) {
    SurfaceTotals& totals = recorder_.totals();
    if (!totals.empty()) recorder_.statistics().lost_impulses += totals.add(hits);
}

void SleepingParticles::wake(std::size_t i, double time) {
    recorder_.statistics().lost_impulses += add_weight(i, time, 1.0);
    store_.wake(i);
    schedule_.forget(i);
}

void SleepingParticles::check(std::size_t i, const TimeSpan& step, BlockRecord& record) const {
    if (observers_.check == nullptr) return;
    const Particles& particles = store_.particles();
    const Vec3& position = particles.position[i];
    const Segment staying{position, position, step.end, step.begin, step.end};
    observers_.check->check(i, particles, store_.force_input(i, step.end), {step.end, step.end}, {&staying, 1},
                            record.violations);
}

}  // namespace ricochet
