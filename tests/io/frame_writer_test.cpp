#include "ricochet/io/frame_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "geometry/temporary_folder.h"
#include "io/example_frames.h"
#include "ricochet/core/error.h"
#include "ricochet/io/frames.h"
#include "ricochet/io/run_files.h"
#include "ricochet/io/vtk_reader.h"

namespace ricochet {
namespace {

using test::TemporaryFolder;

VtkPolyData frame_at(double time) { return particle_frame(test::example_particles(20), time); }

std::size_t listed_frames(const TemporaryFolder& folder) {
    const std::string text = folder.read(kParticleSeriesFile);
    std::size_t count = 0;
    for (std::size_t at = text.find("<DataSet"); at != std::string::npos; at = text.find("<DataSet", at + 1)) ++count;
    return count;
}

TEST(FrameWriter, WritesEveryFrameAndListsItWithItsTime) {
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

TEST(FrameWriter, ARunThatEndsWithoutFinishingLeavesOnlyCompleteFilesThatAreListed) {
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

TEST(FrameWriter, LongSeriesAreListedInFullAtTheEnd) {
    const TemporaryFolder folder;
    FrameWriter writer(folder.path(""));
    for (std::uint64_t step = 0; step < 1100; ++step) writer.submit(step, particle_frame(Particles{}, 0.0));
    writer.finish();
    EXPECT_EQ(listed_frames(folder), 1100U);
}

TEST(FrameWriter, AnErrorInTheBackgroundComesOutInTheRun) {
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

}  // namespace
}  // namespace ricochet
