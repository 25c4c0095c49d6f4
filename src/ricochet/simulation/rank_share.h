/// \file
/// Private to the simulation: the part of a run that one process has if several processes share the run.
///
/// Each rank has the whole scene and moves its own particles. All ranks run the same schedules of emitters, in which
/// the position of a birth determines its rank (births.h). The id of a particle of the setup determines its rank. A
/// child lives on the rank of its parent. Particles joined by springs live on the first rank, which plans their motion
/// in substeps for all ranks. Each rank keeps its own sums if they do not depend on the order of their terms. For
/// others (unsimulated time, loads on moving colliders) the first rank adds the stored terms in the order of a single
/// process.
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
#include "ricochet/core/binary_archive.h"
#include "ricochet/core/ranks.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/run_recorder.h"

namespace ricochet {

/// A whole run, or the part of one rank.
class RankShare {
public:
    /// ranks: null or a single rank if this process has the whole run.
    explicit RankShare(std::shared_ptr<Ranks> ranks)
        : ranks_(ranks && ranks->size() > 1 ? std::move(ranks) : nullptr),
          rank_(ranks_ ? ranks_->rank() : 0),
          size_(ranks_ ? ranks_->size() : 1) {}

    [[nodiscard]] bool is_alone() const { return ranks_ == nullptr; }
    /// Returns true for the first rank, which records the counts that are common to all ranks.
    [[nodiscard]] bool is_first() const { return rank_ == 0; }
    /// Throws InputError if several ranks share the run, because only a single process can be changed.
    void require_alone(const char* call) const;
    /// Must not be called if is_alone().
    [[nodiscard]] Ranks& ranks() const { return *ranks_; }
    /// Keeps the particles with these ids on the first rank, because they act on each other.
    void keep_together(std::vector<std::uint64_t> ids);
    [[nodiscard]] bool keeps_together() const { return !together_.empty(); }
    [[nodiscard]] bool stays(std::uint64_t id) const {
        return !together_.empty() && std::ranges::binary_search(together_, id);
    }
    /// Returns true if a particle with this id lives on this rank. Not valid for children. A birth is tested with the
    /// id that it gets if no earlier birth of the step is refused.
    [[nodiscard]] bool has_place_for(std::uint64_t id) const {
        if (is_alone()) return true;
        if (stays(id)) return is_first();
        return (id / kNeighbours) % size_ == rank_;
    }
    /// Returns the shortest duration of all ranks, in s. Durations must be above 0. All ranks must call this function.
    [[nodiscard]] double shortest(double duration) const;

    /// Returns the number of living particles on all ranks. here: number on this rank, the result if is_alone().
    [[nodiscard]] std::uint64_t living(std::size_t here) const { return is_alone() ? here : living_; }
    /// Sets the number of living particles at the start, or after a restore.
    void begin(std::uint64_t living) { living_ = living; }
    /// Adds the births of all ranks to the number of living particles.
    void add_births(std::uint64_t count) { living_ += count; }
    /// Ends a step. All ranks exchange their numbers of living particles, and add up terms if there are many.
    void end_step(std::size_t living_here, const ColliderList& colliders);

    /// Returns the same message on all ranks: that of the rank with the lowest `id` among those with a message.
    [[nodiscard]] std::optional<std::string> first_message(const std::optional<std::string>& message,
                                                           std::uint64_t id) const;

    // Sums that depend on the order of their terms.

    /// Sets the sums at the start of a run, or after a restore. colliders: result of RunRecorder::loads().
    void begin_sums(double unsimulated_time, const std::vector<ColliderTotals>& colliders);
    /// Records the results of blocks in one substep. id: ids of all particles on this rank.
    void note(const std::vector<BlockRecord>& blocks, const std::vector<std::uint64_t>& id);
    /// Adds up the terms of all ranks on the first rank. All ranks must call this function.
    void add_up(const ColliderList& colliders);
    [[nodiscard]] double unsimulated_time() const { return unsimulated_time_; }        ///< s, on the first rank
    [[nodiscard]] const std::vector<ColliderTotals>& loads() const { return loads_; }  ///< on the first rank

private:
    /// Number of particles with consecutive ids that live on the same rank.
    static constexpr std::uint64_t kNeighbours = 16;
    /// Number of terms on all ranks above which the terms are added up before the next output.
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
    std::size_t rank_;                     // rank of this process
    std::size_t size_;                     // number of ranks
    std::vector<std::uint64_t> together_;  // ids, ascending
    std::uint64_t living_ = 0;
    std::uint64_t part_ = 0;  // number of substeps so far
    std::vector<LostTime> new_lost_times_;
    std::vector<Load> new_loads_;
    double unsimulated_time_ = 0.0;
    std::vector<ColliderTotals> loads_;
};

/// Returns the bytes that the archive function of an object writes.
template <class Archived>
[[nodiscard]] std::vector<std::byte> archived_bytes(Archived& object) {
    std::vector<std::byte> bytes;
    BinaryWriter writer([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    object.archive(writer);
    return bytes;
}

/// Returns the values of lists that are given as bytes, one list after the other.
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

/// Returns the lists of all ranks, one after the other, on the first rank. T must be trivially copyable.
template <class T>
[[nodiscard]] std::vector<T> gather_list(Ranks& ranks, const std::vector<T>& list) {
    return joined_list<T>(ranks.gather(std::as_bytes(std::span(list))));
}

/// Returns the lists of all ranks, one after the other, on each rank.
template <class T>
[[nodiscard]] std::vector<T> gather_list_to_all(Ranks& ranks, const std::vector<T>& list) {
    return joined_list<T>(ranks.gather_to_all(std::as_bytes(std::span(list))));
}

}  // namespace ricochet
