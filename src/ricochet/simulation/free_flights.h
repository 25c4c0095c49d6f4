/// \file
/// Private to the simulation: the steps of particles that meet nothing.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/dynamics/free_flight.h"
#include "ricochet/simulation/active_set.h"
#include "ricochet/simulation/deferred_steps.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/simulation/run_check.h"
#include "ricochet/simulation/run_recorder.h"

namespace ricochet {

/// Advances the particles in free flight, and finds the others: the pass over all particles that every step begins
/// with.
class FreeFlights {
public:
    /// All must outlive it; check may be null.
    FreeFlights(ParticleStore& store, const QuerySchedule& schedule, const ForceField& forces,
                const Integrator& integrator, RunCheck* check)
        : store_(store), schedule_(schedule), forces_(forces), integrator_(integrator), check_(check) {}

    /// Advances those of the range that are in free flight. Returns those that need a query, listed in ascending order
    /// in one block for kParticleBlock particles of the range.
    [[nodiscard]] ActiveSet advance(const ParticleRange& range, const TimeSpan& step, std::vector<BlockRecord>& blocks);

    /// From now on particles in free flight stay where they are, and make several steps at once when they need a query.
    /// Only where nothing asks in between where they are. No effect where accelerations differ.
    void begin_deferring();
    /// All particles make the steps that they have deferred.
    void end_deferring();
    /// Forgets deferred steps.
    void drop_deferred() { deferred_.reset(); }

    // As for Particles.
    void append();
    void reserve(std::size_t more);
    void compact(const std::vector<std::uint8_t>& keep);

private:
    void advance_together(std::size_t begin, std::size_t end, const FreeFlight& flight);
    void advance_each(std::size_t begin, std::size_t end, const TimeSpan& step, std::vector<Violation>* violations);
    void advance_one(std::size_t i, const FreeFlight& flight, const TimeSpan& step, std::vector<Violation>* violations);
    [[nodiscard]] FreeFlight flight_of(std::size_t i, const TimeSpan& step) const;
    void catch_up(std::size_t i);
    void catch_up_active(std::span<const std::uint32_t> active);
    void catch_up_all();

    ParticleStore& store_;
    const QuerySchedule& schedule_;
    const ForceField& forces_;
    Integrator integrator_;
    RunCheck* check_;
    std::optional<DeferredSteps> deferred_;
};

}  // namespace ricochet
