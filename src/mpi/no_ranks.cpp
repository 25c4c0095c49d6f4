// Replaces mpi_ranks.cpp if the program is built without MPI.
#include <string>

#include "mpi/launch.h"
#include "mpi/mpi_ranks.h"
#include "ricochet/core/error.h"

namespace ricochet::mpi {

std::shared_ptr<Ranks> join() {
    if (launch_size() < 2) return nullptr;
    throw InputError("started as " + std::to_string(launch_size()) +
                     " processes that share a run, but built without MPI, expected a program built with "
                     "-DRICOCHET_MPI=ON, or one process");
}

bool has_joined() { return false; }
std::size_t ranks_on_these_processors() { return 1; }
void agree_to_end() {}
void end_process(int) {}

}  // namespace ricochet::mpi
