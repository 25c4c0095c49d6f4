/// \file
/// Private to the simulation: the emitters of a run, and the births of a step, which all threads and all ranks make.
///
/// A birth depends only on its emitter and on its number within the emitter, so any thread and any rank can make it.
/// All ranks must know all births, because ids follow the order of (time, emitter, number) and a refused birth gets no
/// id. Each rank takes all births off the schedule, makes only its own particles, and tells the others of refusals.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/dynamics/emitter.h"
#include "ricochet/simulation/population.h"
#include "ricochet/simulation/rank_share.h"
#include "ricochet/simulation/spawn_occupancy.h"

namespace ricochet {

struct SimulationSetup;

/// Tests that decide whether a birth takes place. An empty function refuses nothing.
struct BirthTests {
    BirthTest alone;  ///< tests a birth without the other births; pure, called from any thread; accepts every point
    /// Tests a birth that has passed `alone` against the births before it. Stores each birth that it accepts. Called by
    /// one thread, for one emitter after the other. Not used if several ranks share the run.
    BirthTest among;
};

/// Limits of the births of a step.
struct BirthLimits {
    double end = 0.0;                  ///< end of the step, in s
    std::uint64_t most_births = 0;     ///< particles that may still be added, on all ranks
    std::uint64_t most_in_memory = 0;  ///< particles that still fit into the memory of this process
    std::uint64_t first_id = 0;        ///< id of the first birth
};

/// The births of a step.
class StepBirths {
public:
    /// The arguments must outlive the object.
    StepBirths(std::span<Emitter> emitters, const BirthLimits& limits, const BirthTests& tests, const RankShare& share);
    StepBirths(const StepBirths&) = delete;
    StepBirths& operator=(const StepBirths&) = delete;

    /// Makes the births. All ranks must call it. Returns false if more particles are born on this rank than fit into
    /// memory. In this case the schedules have advanced, but no ids have been given.
    [[nodiscard]] bool make();

    /// Returns the births of this rank with their ids, ascending.
    [[nodiscard]] std::span<Particle* const> here() const { return here_; }
    /// Counts over all ranks.
    [[nodiscard]] std::uint64_t count() const { return count_; }
    [[nodiscard]] std::uint64_t refused_by_overlap() const { return refused_by_overlap_; }
    [[nodiscard]] std::uint64_t refused_by_population() const { return refused_by_population_; }

private:
    struct Entry {
        DueBirth due;
        std::uint32_t emitter = 0;
        bool is_refused = false;
        Particle* made = nullptr;  ///< null on other ranks
    };
    using Wave = std::vector<Entry>;

    [[nodiscard]] Wave next_wave();
    void make(Wave& wave);
    void test_among(const Wave& wave, std::span<const std::size_t> mine,
                    std::vector<std::optional<Particle>>& made) const;
    void keep_local(Wave& wave, std::span<const std::size_t> mine, std::vector<std::optional<Particle>>& made);
    [[nodiscard]] bool may_be_refused(const Wave& wave) const;
    void give_ids();

    std::span<Emitter> emitters_;
    BirthLimits limits_;
    const BirthTests& tests_;
    const RankShare& share_;
    Wave all_;                                                // births of all waves, wave by wave
    std::vector<std::vector<std::optional<Particle>>> made_;  // made by this rank, one list per wave
    std::vector<std::uint64_t> made_of_;                      // per emitter, over all ranks
    std::uint64_t made_here_ = 0;
    std::uint64_t taken_ = 0;  // births taken off the schedule, over all ranks
    std::vector<Particle*> here_;
    std::uint64_t count_ = 0;
    std::uint64_t refused_by_overlap_ = 0;
    std::uint64_t refused_by_population_ = 0;
};

/// Adds particles to a population: particles of the setup at the start, and particles of the emitters in each step.
class Emission {
public:
    /// setup: its emitters are moved out. All other arguments must outlive the object.
    Emission(SimulationSetup& setup, Population& population, RankShare& share);

    [[nodiscard]] const std::vector<Emitter>& emitters() const { return emitters_; }
    /// Replaces the emitters by copies of them from an earlier time.
    void go_back(const std::vector<Emitter>& emitters) { emitters_ = emitters; }
    /// Returns true if particles of the setup or of its emitters can be spheres.
    [[nodiscard]] bool has_spheres() const { return has_spheres_; }

    /// Adds the particles of the setup. Moves them out of `first`.
    void add_first(std::vector<Particle>& first);
    /// Adds the particles that emitters emit in a step. All ranks must call it.
    void emit(const TimeSpan& step);
    /// Advances the emitters to a time, in s, without adding particles. steps: number of steps until this time.
    void replay(std::uint64_t steps, double time);

private:
    [[nodiscard]] BirthTests tests_in(const TimeSpan& step, std::optional<SpawnOccupancy>& occupancy) const;
    [[nodiscard]] SpawnOccupancy occupancy_of(const TimeSpan& step) const;

    std::vector<Emitter> emitters_;
    bool has_spheres_;
    Population& population_;
    const PopulationParts& parts_;
    RankShare& share_;
};

}  // namespace ricochet
