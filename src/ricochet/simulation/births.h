/// \file
/// Private to the simulation: the births of a step by emitters, made by all threads and by all ranks.
///
/// What a birth is depends on nobody but its emitter and its number there, so any thread and any rank can make it. What
/// all must know is which births there are: their ids are given in the order of (time, emitter, number), and one that
/// is refused takes none. Each rank takes all of them off the schedule, which is cheap, and makes its part; those that
/// surfaces refuse are told to all.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/dynamics/emitter.h"
#include "ricochet/simulation/rank_share.h"

namespace ricochet {

/// What decides whether a birth takes place. Empty: nothing refuses it.
struct BirthTests {
    BirthTest alone;  ///< of one by itself: pure, from any thread; refuses no point
    /// Of one that has passed, among those that were born before it: it takes note of what it lets pass. One emitter
    /// after the other, by one thread. Not where ranks share the run.
    BirthTest among;
};

/// Where births of a step end.
struct BirthLimits {
    double end = 0.0;            ///< s, of the step
    std::uint64_t room = 0;      ///< that may live, on all ranks
    std::uint64_t fitting = 0;   ///< that the memory of this process holds
    std::uint64_t first_id = 0;  ///< of the first
};

/// The births of a step.
class StepBirths {
public:
    /// All must outlive it.
    StepBirths(std::span<Emitter> emitters, const BirthLimits& limits, const BirthTests& tests, const RankShare& share);
    StepBirths(const StepBirths&) = delete;
    StepBirths& operator=(const StepBirths&) = delete;

    /// Makes them. All ranks call it. False where more are born here than fit: the schedules have gone on then, and
    /// nobody has been given an id.
    [[nodiscard]] bool make();

    /// Those that live here, with their ids, ascending.
    [[nodiscard]] std::span<Particle* const> here() const { return here_; }
    /// On all ranks:
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
    std::vector<std::vector<std::optional<Particle>>> made_;  // by this rank, wave by wave
    std::vector<std::uint64_t> made_of_;                      // by emitter, on all ranks
    std::uint64_t made_here_ = 0;
    std::uint64_t taken_ = 0;  // births off the schedule, on all ranks
    std::vector<Particle*> here_;
    std::uint64_t count_ = 0;
    std::uint64_t refused_by_overlap_ = 0;
    std::uint64_t refused_by_population_ = 0;
};

}  // namespace ricochet
