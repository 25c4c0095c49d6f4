/// \file
/// The processes that mpirun (or srun) has started together, and how they begin and end. The one door to MPI.
#pragma once

#include <cstddef>
#include <memory>

#include "ricochet/core/ranks.h"

namespace ricochet::mpi {

/// Joins the processes of this one's launch; null where it was started alone. To be called once. Throws InputError
/// where several were started and the program was built without MPI.
[[nodiscard]] std::shared_ptr<Ranks> join();
/// Whether it did.
[[nodiscard]] bool has_joined();

/// How many of them may run on the processors of this one, itself included; 1 where it was started alone. All call it.
[[nodiscard]] std::size_t ranks_on_these_processors();

/// From now on each ends with an exit code of its own. All call it.
void agree_to_end();

/// For the end of the process, once what it has to say is said. Where it has joined others: once they have agreed to
/// end, waits until all have come here, since a launcher may kill all when one ends with an error; otherwise ends them
/// all with this exit code, and this one.
void end_process(int exit_code);

}  // namespace ricochet::mpi
