/// \file
/// Writes the frames of a run in the background, so that the simulation goes on meanwhile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "ricochet/io/run_files.h"
#include "ricochet/io/vtk.h"
#include "ricochet/io/writer_thread.h"

namespace ricochet {

/// Writes frames in the order they are given and keeps the series file up to date, so that a run that is cut off at any
/// moment can still be opened. The frames of all series that share a thread are bounded together: at most
/// WriterThread::kMostInFlight are in memory; then submit() and blank_frame() wait.
class FrameWriter {
public:
    /// earlier: the frames of an interrupted run that goes on here. thread: that of another series to be shared; null
    /// for one of its own.
    explicit FrameWriter(std::filesystem::path folder, FileSeries files = kParticleSeries,
                         std::vector<PvdEntry> earlier = {}, std::shared_ptr<WriterThread> thread = nullptr);

    /// A frame to be filled, once there is room for it: with the memory of one that has been written, whatever it
    /// holds, or empty. Making the frame only now is what keeps no more than two in memory. Throws like submit().
    [[nodiscard]] VtkPolyData blank_frame();
    /// Hands over a frame. Throws what an earlier frame's writing threw.
    void submit(std::uint64_t step, VtkPolyData frame);
    /// Throws what an earlier frame's writing threw, without waiting.
    void check() { thread_->check(); }
    /// Waits until everything handed over so far is on disk; the whole series. Throws what the writing threw.
    [[nodiscard]] std::vector<PvdEntry> drain();
    /// Waits until everything is on disk. Throws what the writing threw.
    void finish() { (void)drain(); }
    /// Frames handed over so far.
    [[nodiscard]] std::uint64_t submitted() const { return submitted_; }

private:
    class Series;

    std::shared_ptr<Series> series_;  // of the jobs too, which may outlive this object
    std::uint64_t submitted_ = 0;
    std::shared_ptr<WriterThread> thread_;
};

}  // namespace ricochet
