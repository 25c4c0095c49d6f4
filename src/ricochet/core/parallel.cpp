#include "ricochet/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>
#include <tbb/version.h>

#include <algorithm>
#include <bit>
#include <exception>
#include <limits>
#include <mutex>
#include <numeric>
#include <string>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/loop_stop.h"
#include "ricochet/core/thread_sanitizer.h"

namespace ricochet {
namespace {

void require_loop(std::size_t block_size, bool has_function) {
    if (block_size == 0) throw InputError("block size: found 0, expected at least 1");
    if (!has_function) throw InputError("parallel loop: found an empty function, expected one that can be called");
}

/// Exception of the block with the lowest number among the blocks that throw. It is the same for any number of threads.
class FirstError {
public:
    /// Runs a block. Skips the block if one with a lower number has thrown. Blocks with lower numbers still run,
    /// because they may throw, too.
    template <class Run>
    void watch(std::size_t block, const Run& run) {
        if (block > first_.load(std::memory_order_relaxed)) return;
        try {
            run(block);
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (block > first_) return;
            first_ = block;
            error_ = std::current_exception();
        }
    }
    void rethrow() const {
        if (error_) std::rethrow_exception(error_);
    }

private:
    std::mutex mutex_;
    std::atomic<std::size_t> first_ = std::numeric_limits<std::size_t>::max();
    std::exception_ptr error_;
};

/// Largest number of threads. It is far above the number of processors of any machine. More threads would only waste
/// memory on stacks.
constexpr int kMostThreads = 1024;

int checked_threads(int threads) {
    if (threads < 0) throw InputError("threads: found a number below 0, expected 0 (all) or more");
    if (threads > kMostThreads) {
        throw InputError("threads: found " + std::to_string(threads) + ", expected 0 (all) to " +
                         std::to_string(kMostThreads));
    }
    return threads;
}

thread_local const std::function<void()>* loop_stop = nullptr;

/// Scope in which the thread of a block uses the LoopStop function of the thread that began the loop.
class LoopStopScope {
public:
    explicit LoopStopScope(const std::function<void()>* stop) : own_(std::exchange(loop_stop, stop)) {}
    ~LoopStopScope() { loop_stop = own_; }
    LoopStopScope(const LoopStopScope&) = delete;
    LoopStopScope& operator=(const LoopStopScope&) = delete;

private:
    const std::function<void()>* own_;
};

}  // namespace

LoopStop::LoopStop(std::function<void()> ask) : ask_(std::move(ask)), outer_(std::exchange(loop_stop, &ask_)) {}
LoopStop::~LoopStop() { loop_stop = outer_; }

void poll_loop_stop() {
    if (loop_stop != nullptr) (*loop_stop)();
}

struct ThreadLimit::Impl {
    explicit Impl(std::size_t threads) : control(tbb::global_control::max_allowed_parallelism, threads) {}
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
    : impl_(checked_threads(threads) > 0 ? std::make_unique<Impl>(static_cast<std::size_t>(threads)) : nullptr) {}
ThreadLimit::~ThreadLimit() = default;

int thread_count() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for_blocks(std::size_t count, std::size_t block_size,
                         const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
    require_loop(block_size, static_cast<bool>(body));
    if (count == 0) return;
    const std::size_t blocks = (count + block_size - 1) / block_size;
    LoopSync sync;
    FirstError errors;
    const std::function<void()>* const stop = loop_stop;
    const auto run_block = [&](std::size_t block) {
        const LoopSync::Iteration iteration(sync);
        const LoopStopScope scope(stop);
        poll_loop_stop();
        // Bodies use thread-local working memory. While a body waits for its own tasks, its thread must not start
        // another body of this loop or of an enclosing one.
        tbb::this_task_arena::isolate(
            [&] { body(block, block * block_size, std::min(count, (block + 1) * block_size)); });
    };
    if (blocks == 1) {
        run_block(0);
        return;
    }
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) { errors.watch(block, run_block); });
    errors.rethrow();
}

double ordered_sum(std::size_t count, std::size_t block_size,
                   const std::function<double(std::size_t, std::size_t)>& block_sum) {
    require_loop(block_size, static_cast<bool>(block_sum));
    const std::size_t blocks = (count + block_size - 1) / block_size;
    std::vector<double> partial(blocks, 0.0);
    parallel_for_blocks(count, block_size, [&](std::size_t block, std::size_t begin, std::size_t end) {
        partial[block] = block_sum(begin, end);
    });
    return std::accumulate(partial.begin(), partial.end(), 0.0);
}

// The sort is serial with the thread sanitizer. The sanitizer does not see how the packaged TBB synchronises the
// threads of its sort. No code of Ricochet runs inside the sort that could report the synchronisation.
void parallel_sort(std::vector<std::uint64_t>& values) {
#if defined(RICOCHET_THREAD_SANITIZER)
    std::ranges::sort(values);
#else
    tbb::parallel_sort(values.begin(), values.end());
#endif
}

namespace {

/// Bits of a digit of a key.
constexpr unsigned kDigitBits = 8;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
constexpr std::size_t kSortBlock = std::size_t{1} << 15U;

/// Performs one pass of a radix sort, by the digit that begins at bit `shift`.
void sort_by_digit(const std::vector<KeyedIndex>& from, std::vector<KeyedIndex>& to, unsigned shift) {
    const auto digit_of = [&](const KeyedIndex& item) { return (item.key >> shift) & (kDigits - 1); };
    std::vector<std::array<std::uint32_t, kDigits>> places((from.size() + kSortBlock - 1) / kSortBlock);
    parallel_for_blocks(from.size(), kSortBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        places[block].fill(0);
        for (std::size_t k = begin; k < end; ++k) ++places[block][digit_of(from[k])];
    });
    std::uint32_t next = 0;
    for (std::size_t digit = 0; digit < kDigits; ++digit) {
        for (auto& place : places) next += std::exchange(place[digit], next);
    }
    parallel_for_blocks(from.size(), kSortBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) to[places[block][digit_of(from[k])]++] = from[k];
    });
}

}  // namespace

void parallel_sort(std::vector<KeyedIndex>& items, std::vector<KeyedIndex>& spare) {
    constexpr std::size_t kFew = 1024;
    if (items.size() < kFew) {
        std::ranges::stable_sort(items, [](const KeyedIndex& a, const KeyedIndex& b) { return a.key < b.key; });
        return;
    }
    spare.resize(items.size());
    std::uint64_t differing = 0;
    for (const KeyedIndex& item : items) differing |= item.key ^ items.front().key;
    for (unsigned shift = 0; shift < 64 && (differing >> shift) != 0; shift += kDigitBits) {
        shift += static_cast<unsigned>(std::countr_zero(differing >> shift));  // skips bits that are equal in all keys
        sort_by_digit(items, spare, shift);
        items.swap(spare);
    }
}

const char* tbb_version() { return TBB_runtime_version(); }

}  // namespace ricochet
