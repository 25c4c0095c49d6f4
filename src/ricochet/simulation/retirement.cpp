#include "ricochet/simulation/retirement.h"

#include <algorithm>
#include <array>
#include <vector>

#include "ricochet/core/hash.h"
#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

/// Counts of removed particles in one block, by reason.
class LeaverCounts {
public:
    /// Counts a removed particle. lost: number of impulses of a sleeping particle's weight that were too large for the
    /// totals of triangles.
    void add(RemovalReason reason, std::uint64_t lost) {
        ++counts_[static_cast<std::size_t>(reason)];
        lost_impulses_ += lost;
    }
    void add_to(SimulationStatistics& statistics) const {
        const auto of = [this](RemovalReason reason) { return counts_[static_cast<std::size_t>(reason)]; };
        statistics.expired += of(RemovalReason::expired);
        statistics.absorbed += of(RemovalReason::absorbed);
        statistics.shattered += of(RemovalReason::shattered);
        statistics.out_of_bounds += of(RemovalReason::out_of_bounds);
        statistics.lost_impulses += lost_impulses_;
    }

private:
    std::array<std::uint64_t, 5> counts_{};  // by reason
    std::uint64_t lost_impulses_ = 0;
};

}  // namespace

// The lifetime of a particle in free flight is not tested, because a free flight ends before the particle's life.
RemovalReason Retirement::removal_reason(std::size_t i, double time) const {
    const RemovalReason by_bounds = is_outside(i) ? RemovalReason::out_of_bounds : RemovalReason::none;
    if (population_.schedule().is_in_free_flight(i)) return by_bounds;
    const Particles& particles = population_.particles();
    if (particles.absorbed[i] == kShattered) return RemovalReason::shattered;
    if (particles.absorbed[i] != 0) return RemovalReason::absorbed;
    if (particles.birth_time[i] + particles.lifetime[i] <= time) return RemovalReason::expired;
    return by_bounds;
}

void Retirement::retire(double time) {
    const Counts counts = count(time);
    if (counts.leaving > 0) remove_leavers(time);
    SimulationStatistics& statistics = recorder_.statistics();
    statistics.resting = counts.resting;
    statistics.asleep = population_.store().may_sleep() ? counts.held : 0;
}

Retirement::Counts Retirement::count(double time) const {
    const std::size_t size = population_.size();
    std::vector<Counts> blocks(blocks_of(size));
    parallel_for_blocks(size, kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        blocks[block] = count_block(begin, end, time);
    });
    Counts all;
    for (const Counts& block : blocks) {
        all.leaving += block.leaving;
        all.resting += block.resting;
        all.held += block.held;
    }
    return all;
}

Retirement::Counts Retirement::count_block(std::size_t begin, std::size_t end, double time) const {
    const Particles& particles = population_.particles();
    const QuerySchedule& schedule = population_.schedule();
    Counts counts;
    for (std::size_t i = begin; bounds_ && i < end; ++i) {
        counts.leaving += schedule.is_in_free_flight(i) && is_outside(i) ? 1 : 0;
    }
    schedule.visit_all_but_free_flights(begin, end, [&](std::size_t i) {
        const bool leaves = removal_reason(i, time) != RemovalReason::none;
        counts.leaving += leaves ? 1 : 0;
        counts.resting += leaves ? 0 : particles.resting[i];
        counts.held += leaves ? 0 : particles.held[i];
    });
    return counts;
}

void Retirement::remove_leavers(double time) {
    const Particles& particles = population_.particles();
    std::vector<std::uint8_t> keep(particles.size(), 1);
    std::vector<LeaverCounts> blocks(blocks_of(keep.size()));
    parallel_for_blocks(keep.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const RemovalReason reason = removal_reason(i, time);
            if (reason == RemovalReason::none) continue;
            keep[i] = 0;
            const double death = particles.birth_time[i] + particles.lifetime[i];
            blocks[block].add(reason, mover_.sleepers().add_weight(i, std::min(time, death), 1.0));
        }
    });
    for (const LeaverCounts& counts : blocks) counts.add_to(recorder_.statistics());
    population_.compact(keep);
}

void Retirement::add_to_fingerprint(StateHash& hash) const {
    if (!bounds_) return;
    hash.add(bounds_->lower);
    hash.add(bounds_->upper);
}

}  // namespace ricochet
