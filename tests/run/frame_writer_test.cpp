#include "run/frame_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/io/frames.h"
#include "run/example_frames.h"
#include "run/run_folder.h"
#include "run/vtp_reader.h"
#include "support/temporary_folder.h"

namespace ricochet {

namespace RICOCHET_FILE {

using Mode = WriterThread::Mode;

constexpr Mode kModes[] = {Mode::background, Mode::synchronous};

TEST(WriterThread, JobsRunInTheOrderOfSubmission) {
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

TEST(WriterThread, JobsRunOnOneOtherThreadUnlessSynchronous) {
    for (const Mode mode : kModes) {
        std::vector<std::thread::id> threads;
        WriterThread thread(mode);
        for (int i = 0; i < 5; ++i) thread.submit([&threads] { threads.push_back(std::this_thread::get_id()); });
        thread.drain();
        EXPECT_EQ(threads, std::vector<std::thread::id>(5, threads.front()));
        EXPECT_EQ(threads.front() == std::this_thread::get_id(), mode == Mode::synchronous);
    }
}

TEST(WriterThread, AtMostTwoJobsAreInFlight) {
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

TEST(WriterThread, JobIsDestroyedBeforeTheNextIsAccepted) {
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

TEST(WriterThread, EveryCallAfterAnErrorThrowsItAndRunsNothing) {
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

TEST(WriterThread, JobBehindAnErrorDoesNotRun) {
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

TEST(WriterThread, SynchronousWriterThrowsAtOnceAndFromThenOn) {
    WriterThread thread(Mode::synchronous);
    EXPECT_THROW(thread.submit([] { throw std::runtime_error("no space"); }), std::runtime_error);
    EXPECT_THROW(thread.check(), std::runtime_error);
    EXPECT_THROW(thread.submit([] {}), std::runtime_error);
}

TEST(WriterThread, DestructorDoesNotWaitForJobsThatHaveNotBegun) {
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
    EXPECT_LE(done.load(), 1);  // done, or dropped before it began
}

}  // namespace RICOCHET_FILE

namespace RICOCHET_FILE {

using test::TemporaryFolder;

VtkPolyData frame_at(double time) { return particle_frame(test::example_particles(20), time); }

std::size_t listed_frames(const TemporaryFolder& folder) {
    const std::string text = folder.read(kParticleSeriesFile);
    std::size_t count = 0;
    for (std::size_t at = text.find("<DataSet"); at != std::string::npos; at = text.find("<DataSet", at + 1)) ++count;
    return count;
}

TEST(FrameWriter, EveryFrameIsWrittenAndListedWithItsTime) {
    const TemporaryFolder folder;
    FrameWriter writer(folder.path(""));
    for (std::uint64_t step = 0; step < 10; ++step) writer.submit(3 * step, frame_at(0.1 * static_cast<double>(step)));
    writer.finish();
    EXPECT_EQ(writer.submitted(), 10U);
    EXPECT_EQ(listed_frames(folder), 10U);
    for (std::uint64_t step = 0; step < 10; ++step) {
        EXPECT_EQ(read_vtp(folder.path(frame_file_name(3 * step))).time, 0.1 * static_cast<double>(step));
    }
}

TEST(FrameWriter, UnfinishedRunLeavesOnlyCompleteListedFiles) {
    const TemporaryFolder folder;
    {
        FrameWriter writer(folder.path(""));
        for (std::uint64_t step = 0; step < 6; ++step) writer.submit(step, frame_at(static_cast<double>(step)));
    }
    std::size_t frames = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path(""))) {
        const std::string name = entry.path().filename().string();
        EXPECT_EQ(name.find("partial"), std::string::npos) << name;
        if (!step_of_frame_file(name)) continue;
        ++frames;
        EXPECT_EQ(read_vtp(entry.path()).points.size(), 20U);
        EXPECT_NE(folder.read(kParticleSeriesFile).find(name), std::string::npos) << name;
    }
    EXPECT_GE(frames, 4U);  // at most two were still waiting
    EXPECT_EQ(listed_frames(folder), frames);
}

TEST(FrameWriter, LongSeriesAreListedCompletelyAtTheEnd) {
    const TemporaryFolder folder;
    FrameWriter writer(folder.path(""));
    for (std::uint64_t step = 0; step < 1100; ++step) writer.submit(step, particle_frame(Particles{}, 0.0));
    writer.finish();
    EXPECT_EQ(listed_frames(folder), 1100U);
}

TEST(FrameWriter, BackgroundErrorIsThrownInTheRun) {
    const TemporaryFolder folder;
    FrameWriter writer(folder.path("missing"));
    writer.submit(0, frame_at(0.0));
    EXPECT_THROW(writer.finish(), RunError);
    FrameWriter other(folder.path("missing"));
    EXPECT_THROW(
        {
            for (std::uint64_t step = 0; step < 10; ++step) other.submit(step, frame_at(0.0));
        },
        RunError);
}

TEST(FrameWriter, ReusedMemoryDoesNotChangeAFrame) {
    const TemporaryFolder folder;
    FrameWriter writer(folder.path(""));
    for (const std::uint64_t count : {50U, 3U, 0U, 80U}) {
        const Particles particles = test::example_particles(count);
        const AttributeTable none;
        VtkPolyData frame = writer.blank_frame();
        fill_particle_frame(frame, particles, none, 0.5, count == 3);
        (void)write_vtp(folder.path("filled.vtp"), frame);
        (void)write_vtp(folder.path("new.vtp"), particle_frame(particles, none, 0.5, count == 3));
        EXPECT_EQ(folder.read("filled.vtp"), folder.read("new.vtp")) << count;
        if (count > 0) frame.lines.assign(2, {0, 0});  // none of this may appear in a later frame
        frame.fields = {{"mark", {1.0}}};
        frame.cell_arrays = {{"cell", std::vector<double>(frame.cell_count())}};
        writer.submit(count, std::move(frame));
        (void)writer.drain();
    }
}

TEST(FrameWriter, MemoryOfWrittenFramesIsReused) {
    const TemporaryFolder folder;
    FrameWriter writer(folder.path(""));
    VtkPolyData frame = writer.blank_frame();
    fill_particle_frame(frame, test::example_particles(1000), AttributeTable(), 0.0, false);
    const Vec3* const memory = frame.points.data();
    writer.submit(0, std::move(frame));
    (void)writer.drain();
    frame = writer.blank_frame();
    fill_particle_frame(frame, test::example_particles(900), AttributeTable(), 1.0, false);
    EXPECT_EQ(frame.points.data(), memory);
}

TEST(FrameWriter, SeriesOnOneThreadAreBothCompleteAndShareItsErrors) {
    const TemporaryFolder folder;
    const auto thread = std::make_shared<WriterThread>();
    FrameWriter frames(folder.path(""), kParticleSeries, {}, thread);
    FrameWriter contacts(folder.path(""), kContactSeries, {}, thread);
    for (std::uint64_t step = 0; step < 5; ++step) {
        contacts.submit(step, frame_at(0.0));
        frames.submit(step, frame_at(0.0));
    }
    EXPECT_EQ(frames.drain().size(), 5U);
    EXPECT_EQ(contacts.drain().size(), 5U);
    EXPECT_NO_THROW(frames.check());
    FrameWriter lost(folder.path("missing"), kContactSeries, {}, thread);
    lost.submit(5, frame_at(0.0));
    EXPECT_THROW(frames.finish(), RunError);
    EXPECT_THROW(frames.check(), RunError);
}

TEST(FrameWriter, SeriesMayBeDestroyedBeforeTheThreadThatWritesIt) {
    const TemporaryFolder folder;
    const auto thread = std::make_shared<WriterThread>();
    for (std::uint64_t step = 0; step < 20; ++step) {
        FrameWriter frames(folder.path(""), kParticleSeries, {}, thread);
        frames.submit(step, frame_at(0.0));
    }
    thread->drain();
    for (std::uint64_t step = 0; step < 20; ++step) {
        EXPECT_TRUE(std::filesystem::exists(folder.path(frame_file_name(step)))) << step;
    }
}

}  // namespace RICOCHET_FILE

}  // namespace ricochet
