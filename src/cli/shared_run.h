/// \file
/// A run that several processes may share: who talks, and how all of them end together.
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

/// What a run takes.
struct RunResources {
    std::uint64_t processes = 0;
    std::uint64_t threads = 0;
    std::uint64_t peak_memory_bytes = 0;  ///< largest resident sets so far

    [[nodiscard]] static RunResources of_this_process();
};

/// The processes of a run; one as a rule. One at a time. All of them make the same calls in the same order, besides
/// those that ask nobody.
class SharedRun {
public:
    enum class With {
        nobody,    ///< this process runs its scene by itself
        launched,  ///< with those that mpirun has started beside it, if it has; only once in a process
    };
    /// Joins the others; all but the first are silent from now on. Throws InputError where there are others and the
    /// program cannot join them.
    explicit SharedRun(With with);
    /// Where an error passes by: this process may tell it.
    ~SharedRun();
    SharedRun(const SharedRun&) = delete;
    SharedRun& operator=(const SharedRun&) = delete;

    /// Null for one process.
    [[nodiscard]] const std::shared_ptr<Ranks>& ranks() const { return ranks_; }
    /// This process writes files and reports.
    [[nodiscard]] bool talks() const { return !ranks_ || ranks_->rank() == 0; }
    /// Threads of this process; 0 for all of the machine. wanted: 0 where nobody has said. Asks nobody.
    [[nodiscard]] int threads_for(int wanted) const;

    /// Throws InputError for a scene that one process can run, and several cannot. Asks nobody.
    void require_shareable(const SceneDescription& scene) const;

    /// Does what may fail on some and succeed on others, and asks nobody. Where it fails on any, all end: the first one
    /// that failed throws its error, the others return the exit code. Nothing where all can go on.
    [[nodiscard]] std::optional<int> together(const std::function<void()>& work) const;
    /// The same about numbers that must not differ: those of the scene and of the checkpoint that each has read.
    [[nodiscard]] std::optional<int> require_alike(std::span<const std::uint64_t> values) const;

    /// To be called after each step: adds up what all have, and asks all for a signal.
    RunCounts after_step(const RunCounts& here) const;
    /// The highest signal that had come to any of them then (see InterruptGuard), 0 for none; of one process alone, as
    /// it is now. Asks nobody.
    [[nodiscard]] int signal() const;

    /// What all but this one take.
    [[nodiscard]] RunResources resources_of_others() const;

    /// From now on each ends for itself.
    void end() const;

private:
    std::shared_ptr<Ranks> ranks_;
    std::size_t neighbours_ = 1;  // those that may run on the same processors, with this one
    mutable int agreed_signal_ = 0;
};

/// For an error that comes before a run has joined the others, such as an option that nobody knows: joins them and
/// fails with them, as SharedRun::together() does. Nothing where this process has joined already or is alone.
[[nodiscard]] std::optional<int> fail_together(const std::exception_ptr& error);

}  // namespace ricochet::cli
