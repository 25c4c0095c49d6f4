/// \file
/// Private to the simulation: what of a run one of several processes has.
///
/// Each rank has the whole scene and moves particles of its own. The schedules of emitters run on all of them alike; a
/// birth is made, and lives, where its place in them puts it (births.h), a particle of the setup where its id does, a
/// child where its parent lives. Those that springs join live on the first rank, which plans their motion; the others
/// take a step in as many parts as it does. Sums that do not depend on the order of their terms are kept by each rank
/// for itself; for the others (seconds that budgets have cut off, what colliders that move have been given) each keeps
/// its terms, and the first one adds them up in the order in which one process would.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ricochet/collision/collider_list.h"
#include "ricochet/core/ranks.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/run_recorder.h"

namespace ricochet {

/// All of a run, or a rank's part of it.
class RankShare {
public:
    /// ranks: null, or only one: all is here.
    explicit RankShare(std::shared_ptr<Ranks> ranks)
        : ranks_(ranks && ranks->size() > 1 ? std::move(ranks) : nullptr),
          rank_(ranks_ ? ranks_->rank() : 0),
          size_(ranks_ ? ranks_->size() : 1) {}

    [[nodiscard]] bool is_alone() const { return ranks_ == nullptr; }
    /// The one that enters what all ranks count alike.
    [[nodiscard]] bool is_first() const { return rank_ == 0; }
    /// Throws InputError where it is not: what users change between steps, they change in one process.
    void require_alone(const char* call) const;
    /// Not when alone.
    [[nodiscard]] Ranks& ranks() const { return *ranks_; }
    /// Those with these ids live on the first one and stay there: they act on each other.
    void keep_together(std::vector<std::uint64_t> ids);
    [[nodiscard]] bool keeps_together() const { return !together_.empty(); }
    [[nodiscard]] bool stays(std::uint64_t id) const {
        return !together_.empty() && std::binary_search(together_.begin(), together_.end(), id);
    }
    /// Whether a particle that no other one spawns lives here. Of a birth: by the id that it has where
    /// none before it in the step is refused.
    [[nodiscard]] bool has_place_for(std::uint64_t id) const {
        if (is_alone()) return true;
        if (stays(id)) return is_first();
        return (id / kNeighbours) % size_ == rank_;
    }
    /// s: the least of what ranks are ready to do next, all of them above 0. All call it.
    [[nodiscard]] double shortest(double duration) const;

    /// Particles that live on all ranks; here: those of this one, all when alone.
    [[nodiscard]] std::uint64_t living(std::size_t here) const { return is_alone() ? here : living_; }
    /// All know how many live at the start, or where a run goes on.
    void begin(std::uint64_t living) { living_ = living; }
    /// So many more are born, on whichever rank.
    void add_births(std::uint64_t count) { living_ += count; }
    /// At the end of a step all tell how many live with them; where there are many terms, they are added up.
    void end_step(std::size_t living_here, const ColliderList& colliders);

    /// The message of the rank with the lowest id among those that have one, for all of them.
    [[nodiscard]] std::optional<std::string> first_message(const std::optional<std::string>& message,
                                                           std::uint64_t id) const;

    // Sums whose terms have an order.

    /// From where a run begins or goes on; colliders: as RunRecorder::loads().
    void begin_sums(double unsimulated_time, const std::vector<ColliderTotals>& colliders);
    /// What blocks have done in one part of a step. id: of all particles here.
    void note(const std::vector<BlockRecord>& blocks, const std::vector<std::uint64_t>& id);
    /// Adds the terms of all ranks up, on the first one. All call it.
    void add_up(const ColliderList& colliders);
    [[nodiscard]] double unsimulated_time() const { return unsimulated_time_; }        ///< s, of the first one
    [[nodiscard]] const std::vector<ColliderTotals>& loads() const { return loads_; }  ///< of the first one

private:
    /// Particles that follow each other by id and live together.
    static constexpr std::uint64_t kNeighbours = 16;
    /// Terms of all ranks from which on they are added up within a run's output interval.
    static constexpr std::uint64_t kManyTerms = 1'000'000;

    struct LostTime {
        std::uint64_t part = 0;
        std::uint64_t particle = 0;  ///< id
        double time = 0.0;           ///< s
    };
    struct Load {
        std::uint64_t part = 0;
        ColliderLoad load;
    };

    std::shared_ptr<Ranks> ranks_;
    std::size_t rank_;                     // of this process
    std::size_t size_;                     // ranks
    std::vector<std::uint64_t> together_;  // ascending
    std::uint64_t living_ = 0;
    std::uint64_t part_ = 0;  // parts of steps so far
    std::vector<LostTime> new_lost_times_;
    std::vector<Load> new_loads_;
    double unsimulated_time_ = 0.0;
    std::vector<ColliderTotals> loads_;
};

/// Lists of values that may be copied byte by byte, of all ranks one after the other: on the first one.
template <class T>
[[nodiscard]] std::vector<T> gather_list(Ranks& ranks, const std::vector<T>& list);

/// The same on all of them.
template <class T>
[[nodiscard]] std::vector<T> gather_list_to_all(Ranks& ranks, const std::vector<T>& list);

/// What the bytes of lists hold, one list after the other.
template <class T>
[[nodiscard]] std::vector<T> joined_list(const std::vector<std::vector<std::byte>>& parts) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> all;
    for (const std::vector<std::byte>& part : parts) {
        const std::size_t first = all.size();
        all.resize(first + part.size() / sizeof(T));
        if (!part.empty()) std::memcpy(&all[first], part.data(), part.size());
    }
    return all;
}

template <class T>
std::vector<T> gather_list(Ranks& ranks, const std::vector<T>& list) {
    return joined_list<T>(ranks.gather(std::as_bytes(std::span(list))));
}

template <class T>
std::vector<T> gather_list_to_all(Ranks& ranks, const std::vector<T>& list) {
    return joined_list<T>(ranks.gather_to_all(std::as_bytes(std::span(list))));
}

}  // namespace ricochet
