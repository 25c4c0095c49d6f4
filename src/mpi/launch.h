/// \file
/// Environment variables that mpirun, srun and similar launchers set for the processes that they start.
#pragma once

#include <cstddef>

namespace ricochet::mpi {

/// Returns true if a launcher has started this process. Otherwise MPI is not initialised, because that would cost time.
[[nodiscard]] bool was_launched();
/// Returns the rank of this process within its launch, or 0 if the rank is unknown.
[[nodiscard]] std::size_t launch_rank();
/// Returns the number of processes of the launch, or 1 if the number is unknown.
[[nodiscard]] std::size_t launch_size();

}  // namespace ricochet::mpi
