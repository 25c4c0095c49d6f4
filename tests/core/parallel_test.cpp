#include "ricochet/core/parallel.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/loop_stop.h"

namespace ricochet {
namespace RICOCHET_FILE {

TEST(Parallel, EveryIndexIsVisitedOnce) {
    std::vector<std::atomic<int>> visits(10007);
    parallel_for_blocks(visits.size(), 64, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const auto& v : visits) ASSERT_EQ(v.load(), 1);
}

TEST(Parallel, AnOrderedSumHasTheSameBitsForAnyThreadCount) {
    const auto sum = [] {
        return ordered_sum(100003, 512, [](std::size_t begin, std::size_t end) {
            double s = 0;
            for (std::size_t i = begin; i < end; ++i) s += std::sqrt(static_cast<double>(i)) * 1e-3;
            return s;
        });
    };
    const ThreadLimit one(1);
    const double serial = sum();
    for (int threads : {2, 3, 7}) {
        const ThreadLimit limit(threads);
        EXPECT_EQ(sum(), serial);
    }
}

// The order in which threads reach the blocks must not matter. All earlier blocks run to their end.
TEST(Parallel, TheExceptionOfTheFirstThrowingBlockIsRethrown) {
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        for (int round = 0; round < 50; ++round) {
            std::vector<std::atomic<int>> done(200);
            try {
                parallel_for_blocks(done.size(), 1, [&](std::size_t block, std::size_t, std::size_t) {
                    if (block % 60 == 37) throw std::runtime_error(std::to_string(block));
                    done[block] = 1;
                });
                FAIL() << "no exception";
            } catch (const std::runtime_error& error) {
                EXPECT_STREQ(error.what(), "37");
            }
            for (std::size_t block = 0; block < 37; ++block) EXPECT_EQ(done[block], 1);
        }
    }
}

// The test uses plain memory on purpose, so that the thread sanitizer checks the ordering by the loop.
TEST(Parallel, WritesBeforeTheLoopAndInsideItAreVisible) {
    std::vector<int> values(5000, 0);
    for (int round = 1; round <= 20; ++round) {
        for (int& v : values) ++v;
        parallel_for_blocks(values.size(), 16, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) ++values[i];
        });
        ASSERT_EQ(values, std::vector<int>(values.size(), 2 * round));
    }
}

// There are more threads than processors, so waiting threads steal work from each other. The test makes its own arena,
// because the library's arena has no more slots than processors.
TEST(Parallel, ABlockThatWaitsForItsOwnTasksIsNotInterruptedByAnother) {
    const ThreadLimit limit(8);
    std::atomic<int> interrupted{0};
    std::atomic<double> sink{0};
    const auto work = [&](std::size_t piece, std::size_t, std::size_t) {
        double sum = 0;
        for (std::size_t k = 0; k < 500 + 500 * (piece % 5); ++k) sum += std::sqrt(static_cast<double>(k));
        sink = sum;
    };
    const auto body = [&](std::size_t, std::size_t, std::size_t) {
        thread_local bool in_use = false;
        if (in_use) ++interrupted;
        in_use = true;
        parallel_for_blocks(8, 1, work);
        in_use = false;
    };
    tbb::task_arena(8).execute([&] {
        for (int round = 0; round < 200; ++round) parallel_for_blocks(200, 1, body);
    });
    EXPECT_EQ(interrupted.load(), 0);
}

TEST(Parallel, AnExceptionReachesTheCaller) {
    EXPECT_THROW(parallel_for_blocks(1000, 10,
                                     [](std::size_t, std::size_t begin, std::size_t) {
                                         if (begin == 500) throw std::runtime_error("stop");
                                     }),
                 std::runtime_error);
}

TEST(Parallel, MoreThreadsThanAnyMachineHasAreRefused) {
    EXPECT_THROW(const ThreadLimit limit(1025), InputError);
    EXPECT_THROW(const ThreadLimit limit(1'000'000), InputError);
    EXPECT_THROW(const ThreadLimit limit(-1), InputError);
    const ThreadLimit most(1024);
    EXPECT_GE(thread_count(), 1);
}

TEST(LoopStop, EndsLoopsAndNestedLoops) {
    struct Ended : std::exception {};
    for (const int threads : {1, 4}) {
        const ThreadLimit limit(threads);
        std::atomic<int> asked = 0;
        std::atomic<int> done = 0;
        const LoopStop stop([&] {
            if (++asked > 20) throw Ended();
        });
        const auto loops = [&] {
            parallel_for_blocks(100, 1, [&](std::size_t, std::size_t, std::size_t) {
                parallel_for_blocks(100, 1, [&](std::size_t, std::size_t, std::size_t) { ++done; });
            });
        };
        EXPECT_THROW(loops(), Ended);
        EXPECT_LE(done, 20);
        EXPECT_GT(asked, 20);
    }
}

TEST(LoopStop, IsCheckedByItsOwnLoopsAloneAndOnlyDuringItsLifetime) {
    std::atomic<int> asked = 0;
    const auto loop = [] { parallel_for_blocks(8, 1, [](std::size_t, std::size_t, std::size_t) {}); };
    {
        const LoopStop stop([&] { ++asked; });
        std::thread(loop).join();
        EXPECT_EQ(asked, 0);
        {
            const LoopStop none([] {});
            loop();
            poll_loop_stop();
        }
        EXPECT_EQ(asked, 0);
        loop();
        EXPECT_EQ(asked, 8);
        poll_loop_stop();
        EXPECT_EQ(asked, 9);
    }
    loop();
    poll_loop_stop();
    EXPECT_EQ(asked, 9);
}

// Sorts keys that differ in few bits, in all, or in none, with many equal ones.
TEST(Parallel, SortsByKeyAndKeepsTheOrderOfEqualKeys) {
    for (const std::size_t count : {0U, 1U, 1000U, 1024U, 100003U}) {
        for (const std::uint64_t mask : {0ULL, 0x7ULL, 0xFF00FULL << 20U, 0x8000000000000001ULL, ~0ULL}) {
            SCOPED_TRACE(std::to_string(count) + " " + std::to_string(mask));
            std::vector<KeyedIndex> items(count);
            std::uint64_t random = 1;
            for (std::size_t k = 0; k < count; ++k) {
                random = random * 6364136223846793005ULL + 1442695040888963407ULL;
                items[k] = {(random ^ random >> 31U) & mask, static_cast<std::uint32_t>(k)};
            }
            std::vector<KeyedIndex> expected = items;
            std::stable_sort(expected.begin(), expected.end(),
                             [](const KeyedIndex& a, const KeyedIndex& b) { return a.key < b.key; });
            std::vector<KeyedIndex> spare;
            parallel_sort(items, spare);
            ASSERT_EQ(items.size(), count);
            for (std::size_t k = 0; k < count; ++k) {
                ASSERT_EQ(items[k].key, expected[k].key);
                ASSERT_EQ(items[k].index, expected[k].index);
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
