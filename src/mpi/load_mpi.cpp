// Loads the library that contains the calls to MPI, in processes that a launcher has started. Other processes must not
// load it, because libraries of MPI change the process before main(). UCX (of Open MPI 5 on Debian) handles SIGHUP,
// starts a thread and prints errors if memory is short. PSM2 measures the clock and prints the result.
#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdio>

#include "mpi/launch.h"
#include "mpi/mpi_library.h"
#include "mpi/mpi_ranks.h"
#include "ricochet/core/error.h"

namespace ricochet::mpi {
namespace {

MpiLibrary* library = nullptr;  // null until join() has joined a launch
bool agreed = false;            // true after agree_to_end()

/// Restores the actions of the signals that the tool handles at the end of the scope.
class KeptSignalActions {
public:
    KeptSignalActions() {
        for (std::size_t k = 0; k < kSignals.size(); ++k) (void)::sigaction(kSignals[k], nullptr, &actions_[k]);
    }
    ~KeptSignalActions() {
        for (std::size_t k = 0; k < kSignals.size(); ++k) (void)::sigaction(kSignals[k], &actions_[k], nullptr);
    }
    KeptSignalActions(const KeptSignalActions&) = delete;
    KeptSignalActions& operator=(const KeptSignalActions&) = delete;

private:
    static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
    std::array<struct sigaction, kSignals.size()> actions_{};
};

MpiLibrary* load() {
    // Plug-ins of MPI find its symbols only if they are global.
    void* const file = ::dlopen(kMpiLibraryFile, RTLD_NOW | RTLD_GLOBAL);
    void* const function = file == nullptr ? nullptr : ::dlsym(file, kMpiLibraryFunction);
    if (function == nullptr) {
        const char* const why = ::dlerror();
        throw RunError(fmt::format("ranks: the library for MPI cannot be loaded: {}", why == nullptr ? "" : why));
    }
    return reinterpret_cast<MpiLibraryFunction>(function)();
}

}  // namespace

std::shared_ptr<Ranks> join() {
    if (!was_launched()) return nullptr;
    const KeptSignalActions kept;
    MpiLibrary* const loaded = load();
    std::shared_ptr<Ranks> ranks = loaded->join();
    library = loaded;
    return ranks;
}

bool has_joined() { return library != nullptr; }
std::size_t ranks_on_these_processors() { return library == nullptr ? 1 : library->ranks_on_these_processors(); }
void agree_to_end() { agreed = true; }

void end_process(int exit_code) {
    if (library == nullptr) return;
    (void)std::fflush(nullptr);
    if (!agreed) library->abort(exit_code);
    library->finalize();
}

}  // namespace ricochet::mpi
