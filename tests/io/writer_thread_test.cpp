#include "ricochet/io/frame_writer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace ricochet {
namespace {

using Mode = WriterThread::Mode;

constexpr Mode kModes[] = {Mode::background, Mode::synchronous};

TEST(WriterThread, DoesItsJobsInTheOrderTheyAreGiven) {
    for (const Mode mode : kModes) {
        std::vector<int> done;
        WriterThread thread(mode);
        for (int i = 0; i < 200; ++i) thread.submit([&done, i] { done.push_back(i); });
        thread.drain();
        std::vector<int> expected(200);
        std::iota(expected.begin(), expected.end(), 0);
        EXPECT_EQ(done, expected);
    }
}

TEST(WriterThread, DoesThemOnOneThreadThatIsNotTheCallersUnlessItIsTold) {
    for (const Mode mode : kModes) {
        std::vector<std::thread::id> threads;
        WriterThread thread(mode);
        for (int i = 0; i < 5; ++i) thread.submit([&threads] { threads.push_back(std::this_thread::get_id()); });
        thread.drain();
        EXPECT_EQ(threads, std::vector<std::thread::id>(5, threads.front()));
        EXPECT_EQ(threads.front() == std::this_thread::get_id(), mode == Mode::synchronous);
    }
}

TEST(WriterThread, HoldsNoMoreThanTwoJobsAtATime) {
    constexpr int kInFlight = static_cast<int>(WriterThread::kMostInFlight);
    std::atomic<int> done = 0;
    WriterThread thread;
    for (int given = 1; given <= 300; ++given) {
        thread.wait_for_room();
        EXPECT_GE(done.load(), given - kInFlight);
        thread.submit([&done] {
            for (int i = 0; i < 20; ++i) std::this_thread::yield();
            ++done;
        });
        EXPECT_GE(done.load(), given - kInFlight);
    }
    thread.drain();
    EXPECT_EQ(done.load(), 300);
}

TEST(WriterThread, AJobIsGoneBeforeThereIsRoomForTheNext) {
    const auto memory = std::make_shared<int>(0);
    WriterThread thread;
    for (int i = 0; i < 100; ++i) {
        thread.submit([held = memory] { ++*held; });
        EXPECT_LE(memory.use_count(), 1 + static_cast<long>(WriterThread::kMostInFlight));
    }
    thread.drain();
    EXPECT_EQ(memory.use_count(), 1);
    EXPECT_EQ(*memory, 100);
}

TEST(WriterThread, AfterAnErrorEveryCallThrowsItAndNothingMoreIsDone) {
    std::atomic<int> done = 0;
    WriterThread thread;
    thread.submit([] { throw std::runtime_error("no space"); });
    EXPECT_THROW(thread.drain(), std::runtime_error);
    EXPECT_THROW(thread.check(), std::runtime_error);
    EXPECT_THROW(thread.wait_for_room(), std::runtime_error);
    EXPECT_THROW(thread.submit([&done] { ++done; }), std::runtime_error);
    EXPECT_THROW(thread.drain(), std::runtime_error);
    EXPECT_EQ(done.load(), 0);
}

TEST(WriterThread, AJobThatWaitsBehindAnErrorIsNotDone) {
    for (int repeat = 0; repeat < 50; ++repeat) {
        std::atomic<bool> go = false;
        std::atomic<int> done = 0;
        WriterThread thread;
        thread.submit([&go] {
            while (!go) std::this_thread::yield();
            throw std::runtime_error("no space");
        });
        thread.submit([&done] { ++done; });
        go = true;
        EXPECT_THROW(thread.drain(), std::runtime_error);
        EXPECT_EQ(done.load(), 0);
    }
}

TEST(WriterThread, TheSynchronousOneThrowsAtOnceAndFromThenOn) {
    WriterThread thread(Mode::synchronous);
    EXPECT_THROW(thread.submit([] { throw std::runtime_error("no space"); }), std::runtime_error);
    EXPECT_THROW(thread.check(), std::runtime_error);
    EXPECT_THROW(thread.submit([] {}), std::runtime_error);
}

TEST(WriterThread, GoesWithoutWaitingForJobsThatHaveNotBegun) {
    std::atomic<bool> go = false;
    std::atomic<int> done = 0;
    {
        WriterThread thread;
        thread.submit([&] {
            while (!go) std::this_thread::yield();
            ++done;
        });
        thread.check();
        go = true;
    }
    EXPECT_LE(done.load(), 1);  // done, or given up before it began
}

}  // namespace
}  // namespace ricochet
