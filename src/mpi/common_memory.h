/// \file
/// Sharing of memory pages with equal content between the ranks of one machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace ricochet::mpi {

/// The ranks of one machine. All of them make the same calls.
class Neighbours {
public:
    Neighbours() = default;
    virtual ~Neighbours() = default;
    Neighbours(const Neighbours&) = delete;
    Neighbours& operator=(const Neighbours&) = delete;

    [[nodiscard]] virtual bool is_first() const = 0;
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// Replaces the values of all ranks by the values of the first rank.
    virtual void tell(std::span<std::int64_t> values) const = 0;
    /// Returns true if `is_so` is true on all ranks.
    [[nodiscard]] virtual bool all(bool is_so) const = 0;
};

/// Makes the ranks of one machine share equal pages. Returns the number of shared bytes; see Ranks::have_in_common().
[[nodiscard]] std::uint64_t have_in_common(std::span<const std::span<const std::byte>> pages, const Neighbours& here);

}  // namespace ricochet::mpi
