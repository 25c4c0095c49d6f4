/// \file
/// Parallel loops and sums: the only interface to TBB. Results do not depend on the number of threads, since block
/// boundaries depend only on the amount of work.
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace ricochet {

/// Scope that limits the number of worker threads of the process. threads = 0 means all hardware threads. Throws
/// InputError for a negative number or one above 1024.
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

/// Returns the number of worker threads that a parallel loop can use now.
[[nodiscard]] int thread_count();

/// Calls body(block, begin, end) for [0, count) in blocks of block_size, in any order, on any thread. Runs serially if
/// there is one block. A body that waits for its own tasks is not interrupted by another body on the same thread, so
/// bodies may use thread_local memory.
/// If bodies throw, the exception of the throwing block with the lowest number is rethrown, for any number of threads.
/// By then all blocks with lower numbers have finished. Some blocks with higher numbers may have finished, too. Throws
/// InputError for a block_size of 0 and an empty function.
void parallel_for_blocks(std::size_t count, std::size_t block_size,
                         const std::function<void(std::size_t block, std::size_t begin, std::size_t end)>& body);

/// Calls body(i) for every i in [0, count), in blocks like parallel_for_blocks().
template <class Body>
void parallel_for(std::size_t count, std::size_t block_size, const Body& body) {
    parallel_for_blocks(count, block_size, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

/// Returns the sum over [0, count). The sums of the blocks are added in block order, so the bits do not depend on the
/// number of threads. Throws like parallel_for_blocks().
[[nodiscard]] double ordered_sum(std::size_t count, std::size_t block_size,
                                 const std::function<double(std::size_t begin, std::size_t end)>& block_sum);

/// Sorts in ascending order with all threads.
void parallel_sort(std::vector<std::uint64_t>& values);

/// Index of an item, and its sort key.
struct KeyedIndex {
    std::uint64_t key = 0;
    std::uint32_t index = 0;
};

/// Sorts by key in ascending order with all threads; items with equal keys keep their order. The time is proportional
/// to the number of items and to the number of bits in which keys differ. spare: working memory, which is resized to
/// the number of items.
void parallel_sort(std::vector<KeyedIndex>& items, std::vector<KeyedIndex>& spare);

/// Returns TBB's version, for `--version` and reports.
[[nodiscard]] const char* tbb_version();

/// Sum whose bits do not depend on the order of its terms, accumulated from any number of threads. It is a 128-bit
/// two's complement count of `unit`s. Terms are rounded to the unit; all later operations are exact. add() refuses NaN
/// and terms beyond 2^126 units, and totals wrap beyond 2^127 units.
class FixedPointSum {
public:
    /// Adds a term; thread-safe. Returns false, and adds nothing, if the term cannot be represented.
    bool add(double term, double unit) {
        const double scaled = term / unit;
        if (!(std::fabs(scaled) < 0x1p126)) return false;
        // The magnitude is split exactly into a multiple of 2^64 and a remainder. Negative terms then become a two's
        // complement.
        const double magnitude = std::nearbyint(std::fabs(scaled));
        const double high_part = std::floor(magnitude * 0x1p-64);
        auto high = static_cast<std::uint64_t>(high_part);
        auto low = static_cast<std::uint64_t>(magnitude - high_part * 0x1p64);
        if (scaled < 0.0) {
            low = ~low + 1;
            high = ~high + (low == 0 ? 1 : 0);
        }
        add_words(low, high);
        return true;
    }
    /// Returns the total. Not safe while other threads add.
    [[nodiscard]] double value(double unit) const {
        std::uint64_t high = high_.load(std::memory_order_relaxed);
        std::uint64_t low = low_.load(std::memory_order_relaxed);
        const bool negative = (high >> 63) != 0;
        if (negative) {  // as magnitude and sign, to avoid cancellation
            low = ~low + 1;
            high = ~high + (low == 0 ? 1 : 0);
        }
        const double magnitude = static_cast<double>(high) * 0x1p64 + static_cast<double>(low);
        return (negative ? -magnitude : magnitude) * unit;
    }

    /// Returns the 128-bit count, low word first. Not safe while other threads add.
    [[nodiscard]] std::array<std::uint64_t, 2> words() const {
        return {low_.load(std::memory_order_relaxed), high_.load(std::memory_order_relaxed)};
    }
    void set_words(const std::array<std::uint64_t, 2>& words) {
        low_.store(words[0], std::memory_order_relaxed);
        high_.store(words[1], std::memory_order_relaxed);
    }

private:
    static std::uint64_t carry_of(std::uint64_t a, std::uint64_t b) { return a + b < a ? 1 : 0; }

    void add_words(std::uint64_t low, std::uint64_t high) {
        const std::uint64_t before = low_.fetch_add(low, std::memory_order_relaxed);
        const std::uint64_t carried = high + carry_of(before, low);
        if (carried != 0) high_.fetch_add(carried, std::memory_order_relaxed);
    }

    std::atomic<std::uint64_t> low_{0};
    std::atomic<std::uint64_t> high_{0};
};

}  // namespace ricochet
