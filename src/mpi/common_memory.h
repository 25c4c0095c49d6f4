/// \file
/// Pages that the ranks of one machine hold alike become the same memory.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace ricochet::mpi {

/// How a rank waits for a call of MPI to be done.
using Wait = std::function<void(MPI_Request&)>;

/// See Ranks::have_in_common(). All ranks call it.
[[nodiscard]] std::uint64_t have_in_common(std::span<const std::span<const std::byte>> pages, const Wait& wait_for);

}  // namespace ricochet::mpi
