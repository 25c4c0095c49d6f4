/// \file
/// The one door to the thread library. Results must not depend on the number of threads: work is cut into blocks whose
/// borders depend on the amount of work only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace ricochet {

/// Limits the number of worker threads of the process while it lives. threads = 0 means all hardware threads.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Worker threads that a parallel loop can use now.
[[nodiscard]] int thread_count();

/// Calls body(block, begin, end) for [0, count) cut into blocks of block_size, in any order, on any thread.
/// Runs serially when there is one block. A body that waits for tasks of its own is not interrupted by another body on
/// the same thread, so that bodies may use thread_local memory. An exception of any body is rethrown here (which one is
/// not fixed).
void parallel_for_blocks(std::size_t count, std::size_t block_size,
                         const std::function<void(std::size_t block, std::size_t begin, std::size_t end)>& body);

/// Sum over [0, count) of block sums, added in block order: the same bits for any thread count.
[[nodiscard]] double ordered_sum(std::size_t count, std::size_t block_size,
                                 const std::function<double(std::size_t begin, std::size_t end)>& block_sum);

/// Sorts in ascending order with all threads.
void parallel_sort(std::vector<std::uint64_t>& values);

/// The thread library's version, for `--version` and reports.
[[nodiscard]] const char* tbb_version();

}  // namespace ricochet
