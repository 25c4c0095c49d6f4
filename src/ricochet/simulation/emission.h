/// \file
/// Private to the simulation: the emitters of a run, and the particles of its setup.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/simulation/births.h"
#include "ricochet/simulation/population.h"
#include "ricochet/simulation/spawn_occupancy.h"

namespace ricochet {

struct SimulationSetup;

/// Adds particles to a population: those of the setup at the start, and those of emitters in each step.
class Emission {
public:
    /// setup: gives its emitters away. parts: of the population; all must outlive it.
    Emission(SimulationSetup& setup, Population& population, const PopulationParts& parts, RankShare& share);

    [[nodiscard]] const std::vector<Emitter>& emitters() const { return emitters_; }
    /// Replaces the emitters by the same ones at an earlier time.
    void go_back(const std::vector<Emitter>& emitters) { emitters_ = emitters; }
    /// Returns true if particles of the setup or of its emitters can be spheres.
    [[nodiscard]] bool has_spheres() const { return has_spheres_; }

    /// Adds the particles of the setup, which are moved out of it.
    void add_first(std::vector<Particle>& first);
    /// Adds the particles that emitters emit in a step. All ranks call it.
    void emit(const TimeSpan& step);
    /// Repeats the births until a time, in s, after a number of steps, without adding particles.
    void replay(std::uint64_t steps, double time);

private:
    [[nodiscard]] BirthTests tests_in(const TimeSpan& step, std::optional<SpawnOccupancy>& occupancy) const;
    [[nodiscard]] SpawnOccupancy occupancy_of(const TimeSpan& step) const;

    std::vector<Emitter> emitters_;
    bool has_spheres_;
    Population& population_;
    PopulationParts parts_;
    RankShare& share_;
};

}  // namespace ricochet
