/// \file
/// A run shared by several processes: which process prints, and how all of them end together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "cli/run_messages.h"
#include "ricochet/core/ranks.h"
#include "ricochet/io/scene.h"

namespace ricochet::cli {

/// Resources of a run.
struct RunResources {
    std::uint64_t processes = 0;
    std::uint64_t threads = 0;
    std::uint64_t peak_memory_bytes = 0;  ///< sum of the peak resident sets

    [[nodiscard]] static RunResources of_this_process();
};

/// The processes of a run; usually one. Only one object can exist at a time. All processes must make the same calls in
/// the same order. Only functions whose comment ends with "Local." may be called by a single process.
class SharedRun {
public:
    enum class With {
        nobody,    ///< this process runs its scene alone
        launched,  ///< joins the processes that mpirun started, if any; only once per process
    };
    /// Joins the other processes. All processes except the first print nothing from now on. Throws InputError if other
    /// processes exist and the program cannot join them.
    explicit SharedRun(With with);
    /// Allows this process to print again, so that it can report an exception that has ended its work.
    ~SharedRun();
    SharedRun(const SharedRun&) = delete;
    SharedRun& operator=(const SharedRun&) = delete;

    /// Returns the processes of the run, or null for a single process.
    [[nodiscard]] const std::shared_ptr<Ranks>& ranks() const { return ranks_; }
    /// Returns true if this process writes files and reports.
    [[nodiscard]] bool talks() const { return !ranks_ || ranks_->rank() == 0; }
    /// Returns the number of threads for this process, or 0 for the whole machine. `wanted` is the number of threads
    /// that the user asked for, or 0. Local.
    [[nodiscard]] int threads_for(int wanted) const;

    /// Throws InputError for a scene that only a single process can run. Local.
    void require_shareable(const SceneDescription& scene) const;

    /// Runs work of this process that can fail on some processes. If the work fails on any process, all processes end.
    /// The first failed process throws its error. The other processes return its exit code. Returns nothing if all can
    /// continue.
    [[nodiscard]] std::optional<int> together(const std::function<void()>& work) const;
    /// Checks that numbers are equal on all processes, such as the fingerprints of the scene and of the checkpoint.
    /// Fails like together().
    [[nodiscard]] std::optional<int> require_alike(std::span<const std::uint64_t> values) const;

    /// Sums the counts of all processes and exchanges signals. Must be called after each step.
    RunCounts after_step(const RunCounts& here) const;
    /// Returns the highest signal that any process had received at the last after_step() (see InterruptGuard), or 0.
    /// For a single process, returns its current signal. Local.
    [[nodiscard]] int signal() const;

    /// Returns the resources of all other processes.
    [[nodiscard]] RunResources resources_of_others() const;

    /// Allows each process to end separately from now on.
    void end() const;

private:
    std::shared_ptr<Ranks> ranks_;
    std::size_t neighbours_ = 1;  // number of ranks that may run on the same processors, including this one
    mutable int agreed_signal_ = 0;
};

/// Handles an error that occurs before a run has joined the other processes, such as an unknown option. Joins the other
/// processes and fails like SharedRun::together(). Returns nothing if this process has already joined or is alone.
[[nodiscard]] std::optional<int> fail_together(const std::exception_ptr& error);

}  // namespace ricochet::cli
