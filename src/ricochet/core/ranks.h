/// \file
/// Processes that share the particles of one run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ricochet {

/// The processes that share a run, numbered from 0. Each process makes the same calls in the same order, from one
/// thread. Each call waits for all processes, except rank() and size(). The library contains no implementation; the
/// command-line tool implements the class with MPI.
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
    /// Collects bytes of all ranks. Returns one entry per rank on rank 0, and an empty list on the other ranks. The
    /// ranks may pass different numbers of bytes.
    [[nodiscard]] virtual std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) = 0;
    /// Collects bytes of all ranks. Returns one entry per rank on every rank.
    [[nodiscard]] virtual std::vector<std::vector<std::byte>> gather_to_all(std::span<const std::byte> bytes) = 0;
    /// Sends bytes of any length to each rank, including this one. Returns the bytes sent to this rank, one entry per
    /// sender.
    [[nodiscard]] virtual std::vector<std::vector<std::byte>> exchange(
        const std::vector<std::vector<std::byte>>& to_each) = 0;
    /// Shares memory pages (see own_pages()) that are equal on all ranks and are no longer written. Ranks on one
    /// machine then use the same memory, if the system supports this, and the pages become read-only. Returns the
    /// number of bytes that a machine now stores only once, or 0 if each rank keeps its own pages. Throws RunError if
    /// the pages differ.
    [[nodiscard]] virtual std::uint64_t have_in_common(std::span<const std::span<const std::byte>> /*pages*/) {
        return 0;
    }
};

}  // namespace ricochet
