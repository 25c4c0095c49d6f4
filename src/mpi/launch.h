/// \file
/// What mpirun, srun and their like tell the processes that they start, by the environment.
#pragma once

#include <cstddef>

namespace ricochet::mpi {

/// Whether one of them has started this process: without that, starting MPI costs time for nothing.
[[nodiscard]] bool was_launched();
/// The process's number among those of its launch; 0 where nobody has said.
[[nodiscard]] std::size_t launch_rank();
/// How many they are; 1 where nobody has said.
[[nodiscard]] std::size_t launch_size();

}  // namespace ricochet::mpi
