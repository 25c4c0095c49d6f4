/// \file
/// The one thread beside the workers: it writes the files of a run while the simulation goes on.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace ricochet {

/// Does jobs one after the other in the order they are given, and holds few of them: when kMostInFlight are waiting or
/// in work, whoever brings the next one waits. After a job that throws none is done any more, and every call throws
/// what it threw. Jobs are to be given by one thread.
class WriterThread {
public:
    /// In the background, or at once in submit(): the same files, for tests and for whoever wants no further thread.
    enum class Mode { background, synchronous };
    static constexpr std::size_t kMostInFlight = 2;

    explicit WriterThread(Mode mode = Mode::background);
    /// Finishes the job in work and gives up those that wait.
    ~WriterThread();
    WriterThread(const WriterThread&) = delete;
    WriterThread& operator=(const WriterThread&) = delete;

    /// Waits until another job can be given without waiting.
    void wait_for_room();
    void submit(std::function<void()> job);
    /// Waits until all jobs given so far are done.
    void drain();
    /// Only throws, if an earlier job threw; never waits for a job.
    void check();

private:
    void work();
    void wait_until_at_most(std::size_t in_flight);

    Mode mode_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> jobs_;  // the first one may be in work
    std::exception_ptr error_;
    bool closing_ = false;
    std::thread thread_;
};

}  // namespace ricochet
