/// \file
/// Processes that share the particles of one run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ricochet {

/// The processes that share a run, numbered from 0. Each process makes the same calls in the same order, from one
/// thread. Each call waits for all processes, except rank() and size(). The library has no implementation: the
/// command-line tool has one with MPI.
class Ranks {
public:
    Ranks() = default;
    virtual ~Ranks() = default;
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;

    /// Returns the number of this process.
    [[nodiscard]] virtual std::size_t rank() const = 0;
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// Replaces each value by the sum over all ranks. All ranks must pass equally many values.
    virtual void sum(std::span<std::uint64_t> values) = 0;
    /// Replaces each value by the minimum over all ranks. All ranks must pass equally many values.
    virtual void least(std::span<std::uint64_t> values) = 0;
    /// Returns the bytes of all ranks, by rank, on rank 0, and an empty list on the others. The lengths may differ.
    [[nodiscard]] virtual std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) = 0;
    /// Returns the bytes of all ranks, by rank, on every rank.
    [[nodiscard]] virtual std::vector<std::vector<std::byte>> gather_to_all(std::span<const std::byte> bytes) = 0;
    /// Sends bytes of any length to each rank, including this one. Returns the bytes sent to this rank, by rank.
    [[nodiscard]] virtual std::vector<std::vector<std::byte>> exchange(
        const std::vector<std::vector<std::byte>>& to_each) = 0;
    /// Shares pages (own_pages()) that are equal on all ranks and that are not written any more. Ranks on one machine
    /// then use the same memory, if the system allows it, and the pages become read-only. Returns the number of bytes
    /// that a machine now stores once, or 0 if each rank keeps its own. Throws RunError if the pages differ.
    [[nodiscard]] virtual std::uint64_t have_in_common(std::span<const std::span<const std::byte>> /*pages*/) {
        return 0;
    }
};

}  // namespace ricochet
