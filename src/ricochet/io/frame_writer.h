/// \file
/// Writes the frames of a run in the background, so that the simulation goes on meanwhile.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include "ricochet/io/run_files.h"
#include "ricochet/io/vtk.h"

namespace ricochet {

/// One thread that writes frames in the order they are given and keeps the series file up to date, so that a run that
/// is cut off at any moment can still be opened. At most two frames wait; then submit() waits too.
class FrameWriter {
public:
    static constexpr std::size_t kQueueLength = 2;

    /// earlier: the frames of an interrupted run that goes on here.
    explicit FrameWriter(std::filesystem::path folder, FileSeries files = kParticleSeries,
                         std::vector<PvdEntry> earlier = {});
    /// Gives up what is not yet written.
    ~FrameWriter();
    FrameWriter(const FrameWriter&) = delete;
    FrameWriter& operator=(const FrameWriter&) = delete;

    /// Hands over a frame. Throws what an earlier frame's writing threw.
    void submit(std::uint64_t step, VtkPolyData frame);
    /// Waits until everything handed over so far is on disk; the whole series. Throws what the writing threw.
    [[nodiscard]] std::vector<PvdEntry> drain();
    /// Waits until everything is on disk. Throws what the writing threw. No submit() after it.
    void finish();
    /// Frames handed over so far.
    [[nodiscard]] std::uint64_t submitted() const { return submitted_; }

private:
    struct Frame {
        std::uint64_t step;
        VtkPolyData data;
    };

    void work();
    void write_one(const Frame& frame);
    void write_series();
    void stop();

    std::filesystem::path folder_;
    FileSeries files_;
    std::vector<PvdEntry> series_;
    std::uint64_t bytes_since_series_ = 0;
    std::size_t listed_ = 0;  // entries of series_ that are in the series file
    std::uint64_t submitted_ = 0;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Frame> queue_;
    std::exception_ptr error_;
    bool closing_ = false;
    bool abandoned_ = false;
    std::thread thread_;
};

}  // namespace ricochet
