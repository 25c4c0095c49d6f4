/// \file
/// Private to the simulation: particles at rest that are not moved. Their weights still count.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ricochet/response/response.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/simulation/run_recorder.h"

namespace ricochet {

struct MoveObservers;

/// Records the weights of sleeping particles in the totals of surfaces, and wakes them.
class SleepingParticles {
public:
    /// All must outlive it. response: supports the sleepers.
    SleepingParticles(ParticleStore& store, QuerySchedule& schedule, RunRecorder& recorder,
                      const MoveObservers& observers, const Response& response)
        : store_(store), schedule_(schedule), recorder_(recorder), observers_(observers), response_(response) {}

    /// Adds to the totals of surfaces the impulse of a sleeping particle's weight from its last move until a time, in
    /// s. A sign of -1 subtracts exactly the impulse that +1 adds. Returns the number of impulses that were too large
    /// for the totals. Several threads may call this function for different particles.
    std::uint64_t add_weight(std::size_t i, double until, double sign);
    /// Calls add_weight() for all particles.
    void add_weights(double until, double sign);
    /// Adds impulses to the totals of surfaces.
    void add_to_totals(std::span<const SurfaceHit> hits);
    /// Wakes a sphere that has slept on other spheres, at a time, in s. Must be called before the sleeping islands
    /// remove the sphere.
    void wake(std::size_t i, double time);
    /// Tells the verifier, if there is one, that a particle has kept its position in a step.
    void check(std::size_t i, const TimeSpan& step, BlockRecord& record) const;

private:
    ParticleStore& store_;
    QuerySchedule& schedule_;
    RunRecorder& recorder_;
    const MoveObservers& observers_;
    const Response& response_;
};

}  // namespace ricochet
