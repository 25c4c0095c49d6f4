/// \file
/// Pages that the ranks of one machine hold alike become the same memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace ricochet::mpi {

/// The ranks of one machine, which all make the same calls.
class Neighbours {
public:
    Neighbours() = default;
    virtual ~Neighbours() = default;
    Neighbours(const Neighbours&) = delete;
    Neighbours& operator=(const Neighbours&) = delete;

    [[nodiscard]] virtual bool is_first() const = 0;
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// What the first one says, to all.
    virtual void tell(std::span<std::int64_t> values) const = 0;
    /// Whether it is so on all of them.
    [[nodiscard]] virtual bool all(bool is_so) const = 0;
};

/// See Ranks::have_in_common().
[[nodiscard]] std::uint64_t have_in_common(std::span<const std::span<const std::byte>> pages, const Neighbours& here);

}  // namespace ricochet::mpi
