/// \file
/// The processes that mpirun (or srun) has started together, from joining to the end. The only interface to MPI.
#pragma once

#include <cstddef>
#include <memory>

#include "ricochet/core/ranks.h"

namespace ricochet::mpi {

/// Joins the processes of this launch. Returns null if this process was started alone. Call it once. Throws InputError
/// if several processes were started and the program was built without MPI.
[[nodiscard]] std::shared_ptr<Ranks> join();
/// Returns true if join() has joined a launch.
[[nodiscard]] bool has_joined();

/// Returns the number of ranks that may run on the processors of this one, itself included; 1 if it was started alone.
/// All ranks must call it.
[[nodiscard]] std::size_t ranks_on_these_processors();

/// Makes each rank end with its own exit code from now on. All ranks must call it.
void agree_to_end();

/// Ends the use of MPI at the end of the process, after its last output. A process that was started alone does nothing.
/// If the ranks have agreed to end, it waits until all have called it. Otherwise a launcher could kill all ranks when
/// one ends with an error. Without that agreement it aborts all ranks, including this one, with this exit code.
void end_process(int exit_code);

}  // namespace ricochet::mpi
