/// \file
/// Private to the simulation: the living particles of a run, and the changes of their number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ricochet/simulation/collision_scene.h"
#include "ricochet/simulation/free_flights.h"
#include "ricochet/simulation/memory_estimate.h"
#include "ricochet/simulation/module.h"
#include "ricochet/simulation/options.h"

namespace ricochet {

/// Parts of a run that the population needs. All parts must outlive the population.
struct PopulationParts {
    const SimulationOptions& options;
    CollisionScene& scene;
    const Response& response;
    const StepClock& clock;
    RunRecorder& recorder;
    ModuleList& modules;  ///< notified of each change
};

/// The particles of a run, with their query schedule and their free flights.
class Population {
public:
    Population(ParticleStore store, const AccelerationSwitches& acceleration, double particle_bytes,
               const PopulationParts& parts);

    [[nodiscard]] ParticleStore& store() { return store_; }
    [[nodiscard]] const ParticleStore& store() const { return store_; }
    [[nodiscard]] const Particles& particles() const { return store_.particles(); }
    [[nodiscard]] std::size_t size() const { return store_.size(); }
    [[nodiscard]] QuerySchedule& schedule() { return schedule_; }
    [[nodiscard]] ParticleMemory& memory() { return memory_; }
    [[nodiscard]] const PopulationParts& parts() const { return parts_; }

    // Changes of the number of particles.

    /// Reserves memory for `more` particles.
    void reserve(std::size_t more);
    /// Adds particles in ascending order of ids. after: called after each, with its index in `added`.
    void add(std::span<Particle* const> added, const std::function<void(std::size_t)>& after = {});
    /// Keeps the particles whose flag is not 0.
    void compact(const std::vector<std::uint8_t>& keep);
    /// Inserts particles of other stores, given as bytes, in the order of ids.
    void merge(std::vector<std::vector<std::byte>> parts);
    /// Tells the modules that particles were added, removed or replaced.
    void bind() const;

    // Motion.

    /// Advances the range's particles in free flight. Returns those that need a query, in blocks and sorted for speed.
    [[nodiscard]] ActiveSet advance(const ParticleRange& range, const TimeSpan& part, std::vector<BlockRecord>& blocks);
    /// Returns true if particles in free flight may defer their steps, because no module reads their positions.
    [[nodiscard]] bool may_defer() const;
    [[nodiscard]] FreeFlights& flights() { return flights_; }
    /// Wakes a particle, from the next step on.
    void wake(std::size_t i);
    /// Discards the results of earlier queries. They affect only the speed of a run.
    void forget_queries();
    /// Decides whether held particles may sleep. Must be called when the forces have changed.
    void allow_sleep();

private:
    struct Arrival;

    [[nodiscard]] Arrival arrival_of(Particle& particle) const;
    void insert(Particle&& particle, const Arrival& arrival);

    ParticleStore store_;
    QuerySchedule schedule_;
    FreeFlights flights_;
    AccelerationSwitches acceleration_;
    ParticleMemory memory_;
    PopulationParts parts_;
};

}  // namespace ricochet
