/// \file
/// Information in the environment that mpirun, srun and similar launchers give to the processes that they start.
#pragma once

#include <cstddef>

namespace ricochet::mpi {

/// Returns true if a launcher has started this process. Otherwise MPI is not started, because that would waste time.
[[nodiscard]] bool was_launched();
/// Returns the number of this process within its launch; 0 if it is unknown.
[[nodiscard]] std::size_t launch_rank();
/// Returns the number of processes of the launch; 1 if it is unknown.
[[nodiscard]] std::size_t launch_size();

}  // namespace ricochet::mpi
