#include "cli/shared_run.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <limits>
#include <string>
#include <vector>

#include "cli/interrupts.h"
#include "cli/terminal.h"
#include "mpi/launch.h"
#include "mpi/mpi_ranks.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"

namespace ricochet::cli {
namespace {

constexpr std::uint64_t kNobody = std::numeric_limits<std::uint64_t>::max();
/// Upper bound of the numbers of the handled signals SIGHUP, SIGINT and SIGTERM.
constexpr std::size_t kSignals = 32;
static_assert(SIGHUP < kSignals && SIGINT < kSignals && SIGTERM < kSignals);

/// Returns the exit code that main() uses for an error.
int exit_code_of(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const InputError&) {
        return 2;
    } catch (...) {
        return 1;
    }
}

/// Returns the name of this machine, or `an unknown machine`.
std::string machine_name() {
    std::array<char, 256> name{};
    const bool is_known = ::gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0';
    return is_known ? name.data() : "an unknown machine";
}

}  // namespace

RunResources RunResources::of_this_process() {
    rusage usage{};
    const bool is_known = ::getrusage(RUSAGE_SELF, &usage) == 0;
    return {1, static_cast<std::uint64_t>(thread_count()),
            is_known ? static_cast<std::uint64_t>(usage.ru_maxrss) * 1024U : 0U};  // Linux reports kilobytes
}

SharedRun::SharedRun(With with) {
    if (with == With::nobody) return;
    // All ranks except the first print nothing until the ranks have joined, because an earlier failure occurs on every
    // rank.
    be_silent(mpi::launch_rank() > 0);
    ranks_ = mpi::join();
    if (ranks_ && ranks_->size() < 2) ranks_.reset(), mpi::agree_to_end();
    if (ranks_) neighbours_ = mpi::ranks_on_these_processors();
    be_silent(!talks());
    if (!talks()) speak_as(fmt::format("rank {} on {}", ranks_->rank(), machine_name()));
}

SharedRun::~SharedRun() { be_silent(false); }

int SharedRun::threads_for(int wanted) const {
    if (!ranks_ || wanted != 0) return wanted;
    return std::max(1, thread_count() / static_cast<int>(neighbours_));
}

// Springs are rejected, because one process cannot tell from its own particles which springs have lost an end.
void SharedRun::require_shareable(const SceneDescription& scene) const {
    if (!ranks_ || !scene.output.pieces || scene.setup.springs.empty()) return;
    throw InputError(fmt::format(
        "{}: output.pieces: found true beside springs, expected false where several processes share the run",
        scene.file));
}

std::optional<int> SharedRun::together(const std::function<void()>& work) const {
    if (!ranks_) {
        work();
        return std::nullopt;
    }
    std::exception_ptr error;
    try {
        work();
    } catch (...) {
        error = std::current_exception();
    }
    // The rank and the exit code of this process, if its work failed. The minimum over all ranks finds the first failed
    // rank.
    const std::uint64_t mine = error ? 256 * ranks_->rank() + static_cast<std::uint64_t>(exit_code_of(error)) : kNobody;
    std::array<std::uint64_t, 1> first{mine};
    ranks_->least(first);
    if (first[0] == kNobody) return std::nullopt;
    std::array<std::uint64_t, 1> failed{error ? 1U : 0U};
    ranks_->sum(failed);
    if (failed[0] == ranks_->size()) speak_as({});  // all ranks failed, so the message names no rank
    end();
    if (error && mine == first[0]) std::rethrow_exception(error);
    return static_cast<int>(first[0] % 256);
}

std::optional<int> SharedRun::require_alike(std::span<const std::uint64_t> values) const {
    if (!ranks_) return std::nullopt;
    std::vector<std::uint64_t> least(values.begin(), values.end());
    std::vector<std::uint64_t> most;
    for (const std::uint64_t value : values) most.push_back(~value);
    ranks_->least(least);
    ranks_->least(most);
    const bool differ = !std::equal(least.begin(), least.end(), most.begin(),
                                    [](std::uint64_t low, std::uint64_t high) { return low == ~high; });
    return together([&] {
        if (!differ || !talks()) return;
        throw InputError(fmt::format(
            "ranks: the {} processes have found different scenes, options or checkpoints, expected the same "
            "arguments and the same files on every machine",
            ranks_->size()));
    });
}

RunCounts SharedRun::after_step(const RunCounts& here) const {
    if (!ranks_) return here;
    // Element s is the number of processes that received signal s. The last two elements are the counts.
    std::array<std::uint64_t, kSignals + 2> sums{};
    if (const int signal = InterruptGuard::signal(); signal > 0) ++sums.at(static_cast<std::size_t>(signal));
    sums[kSignals] = here.particles;
    sums[kSignals + 1] = here.particle_steps;
    ranks_->sum(sums);
    for (std::size_t signal = 1; signal < kSignals; ++signal) {
        if (sums[signal] > 0) agreed_signal_ = static_cast<int>(signal);
    }
    return {sums[kSignals], sums[kSignals + 1]};
}

int SharedRun::signal() const { return ranks_ ? agreed_signal_ : InterruptGuard::signal(); }

RunResources SharedRun::resources_of_others() const {
    if (!ranks_) return {};
    const RunResources here = RunResources::of_this_process();
    std::array<std::uint64_t, 3> sums{here.processes, here.threads, here.peak_memory_bytes};
    ranks_->sum(sums);
    return {sums[0] - here.processes, sums[1] - here.threads, sums[2] - here.peak_memory_bytes};
}

void SharedRun::end() const {
    if (ranks_) mpi::agree_to_end();
}

std::optional<int> fail_together(const std::exception_ptr& error) {
    if (mpi::has_joined()) return std::nullopt;
    const SharedRun run(SharedRun::With::launched);
    if (!run.ranks()) return std::nullopt;
    return run.together([&] { std::rethrow_exception(error); });
}

}  // namespace ricochet::cli
