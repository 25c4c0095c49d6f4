/// \file
/// Processes that share the particles of one run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ricochet {

/// The processes that share a run, numbered from 0. Each makes the same calls in the same order, and each call waits
/// for all of them, except rank() and size(). One thread of a process makes them. The library has no implementation:
/// the tool has one with MPI.
class Ranks {
public:
    Ranks() = default;
    virtual ~Ranks() = default;
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;

    /// The number of this process.
    [[nodiscard]] virtual std::size_t rank() const = 0;
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// Each value becomes the sum of those of all ranks; all give equally many.
    virtual void sum(std::span<std::uint64_t> values) = 0;
    /// Each value becomes the least of those of all ranks; all give equally many.
    virtual void least(std::span<std::uint64_t> values) = 0;
    /// The bytes of all ranks, by rank: on rank 0; an empty list on the others. Of any length.
    [[nodiscard]] virtual std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) = 0;
    /// The bytes of all ranks, by rank, on each of them.
    [[nodiscard]] virtual std::vector<std::vector<std::byte>> gather_to_all(std::span<const std::byte> bytes) = 0;
    /// Bytes for each rank, of any length, the own one too: those that each has sent to this one, by rank.
    [[nodiscard]] virtual std::vector<std::vector<std::byte>> exchange(
        const std::vector<std::vector<std::byte>>& to_each) = 0;
    /// Pages (own_pages()) that all ranks hold alike and write no more: those of ranks on one machine become the same
    /// memory, where the system allows it, and can only be read from then on. Bytes of them that a machine holds once;
    /// 0 where each rank keeps its own. Throws RunError where they are not alike.
    [[nodiscard]] virtual std::uint64_t have_in_common(std::span<const std::span<const std::byte>> /*pages*/) {
        return 0;
    }
};

}  // namespace ricochet
