/// \file
/// Interface between the tool and the loadable library that contains all calls to MPI.
#pragma once

#include <cstddef>
#include <memory>

#include "ricochet/core/ranks.h"

namespace ricochet::mpi {

/// File name of the loadable library. The tool's run path has its folder.
constexpr const char* kMpiLibraryFile = "ricochet_mpi.so";

/// The calls to MPI. join() must be called first.
class MpiLibrary {
public:
    MpiLibrary() = default;
    virtual ~MpiLibrary() = default;
    MpiLibrary(const MpiLibrary&) = delete;
    MpiLibrary& operator=(const MpiLibrary&) = delete;

    /// Initialises MPI. Returns the processes of this launch.
    [[nodiscard]] virtual std::shared_ptr<Ranks> join() = 0;
    /// See mpi::ranks_on_these_processors().
    [[nodiscard]] virtual std::size_t ranks_on_these_processors() = 0;
    /// Finalises MPI after all ranks have called this function.
    virtual void finalize() = 0;
    /// Ends all ranks with this exit code.
    virtual void abort(int exit_code) = 0;
};

/// Name and type of the function of the loadable library that returns its only object. The object is never destroyed.
constexpr const char* kMpiLibraryFunction = "ricochet_mpi_library";
using MpiLibraryFunction = MpiLibrary* (*)();

}  // namespace ricochet::mpi
