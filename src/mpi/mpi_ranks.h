/// \file
/// The processes that mpirun or srun has started together: joining, and ending together. This is the only interface to
/// MPI.
#pragma once

#include <cstddef>
#include <memory>

#include "ricochet/core/ranks.h"

namespace ricochet::mpi {

/// Joins the processes of this launch. Returns null if this process was started alone. Call this function once. Throws
/// InputError if several processes were started and the program was built without MPI.
[[nodiscard]] std::shared_ptr<Ranks> join();
/// Returns true if join() has joined a launch.
[[nodiscard]] bool has_joined();

/// Returns the number of ranks, including this one, that may run on the same processors as this rank. Returns 1 if the
/// process was started alone. All ranks must call this function.
[[nodiscard]] std::size_t ranks_on_these_processors();

/// Allows each rank to end with its own exit code from now on. All ranks must call this function.
void agree_to_end();

/// Ends the use of MPI. Call it at the end of the process, after the last output. Does nothing if the process was
/// started alone. After agree_to_end(), waits until all ranks have called this function. Otherwise a launcher could
/// kill all ranks when one rank ends early with an error. Without agree_to_end(), aborts all ranks, including this one,
/// with this exit code.
void end_process(int exit_code);

}  // namespace ricochet::mpi
