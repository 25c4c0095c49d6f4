/// \file
/// Private to the simulation: the births of a step by emitters, made by all threads and by all ranks, and the emitters
/// of a run.
///
/// A birth depends only on its emitter and its number there, so any thread and any rank can make it. All ranks must
/// know which births there are: ids are given in the order of (time, emitter, number), and a refused birth gets none.
/// Each rank takes all births off the schedule, which is cheap, and makes its part. Births that surfaces refuse are
/// communicated to all ranks.
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

/// Tests that decide whether a birth takes place. Empty functions refuse nothing.
struct BirthTests {
    BirthTest alone;  ///< tests a birth by itself; pure, called from any thread; never refuses a point
    /// Tests a birth that has passed `alone` against the births before it, and remembers the accepted ones. Called by
    /// one thread, for one emitter after the other. Not used if ranks share the run.
    BirthTest among;
};

/// Limits of the births of a step.
struct BirthLimits {
    double end = 0.0;            ///< end of the step, in s
    std::uint64_t room = 0;      ///< particles that may still be added, on all ranks
    std::uint64_t fitting = 0;   ///< particles that still fit into the memory of this process
    std::uint64_t first_id = 0;  ///< id of the first birth
};

/// The births of a step.
class StepBirths {
public:
    /// All must outlive it.
    StepBirths(std::span<Emitter> emitters, const BirthLimits& limits, const BirthTests& tests, const RankShare& share);
    StepBirths(const StepBirths&) = delete;
    StepBirths& operator=(const StepBirths&) = delete;

    /// Makes the births. All ranks call it. Returns false if more particles are born here than fit. The schedules have
    /// then advanced, and no ids have been given.
    [[nodiscard]] bool make();

    /// Returns the births of this rank with their ids, ascending.
    [[nodiscard]] std::span<Particle* const> here() const { return here_; }
    /// Counts on all ranks.
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
    void make_by_threads(const Wave& wave, std::span<const std::size_t> mine,
                         std::vector<std::optional<Particle>>& made) const;
    void look_among(const Wave& wave, std::span<const std::size_t> mine,
                    std::vector<std::optional<Particle>>& made) const;
    void keep_local(Wave& wave, std::span<const std::size_t> mine, std::vector<std::optional<Particle>>& made);
    [[nodiscard]] bool may_be_refused(const Wave& wave) const;
    void give_ids();

    std::span<Emitter> emitters_;
    BirthLimits limits_;
    const BirthTests& tests_;
    const RankShare& share_;
    Wave all_;                                                // in the order of waves
    std::vector<std::vector<std::optional<Particle>>> made_;  // by this rank, in a list per wave
    std::vector<std::uint64_t> made_of_;                      // per emitter, on all ranks
    std::uint64_t made_here_ = 0;
    std::uint64_t taken_ = 0;  // births off the schedule, on all ranks
    std::vector<Particle*> here_;
    std::uint64_t count_ = 0;
    std::uint64_t refused_by_overlap_ = 0;
    std::uint64_t refused_by_population_ = 0;
};

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
