/// \file
/// Output of one process of a shared run: its piece of each frame and its part of each checkpoint.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/core/ranks.h"
#include "ricochet/simulation.h"
#include "run/frame_writer.h"
#include "run/run_report.h"
#include "run/run_writer.h"

namespace ricochet {

/// Writer of pieces on a separate thread. The next call rethrows an exception of that thread.
/// All processes of a run must make the same calls.
class PieceWriter {
public:
    /// ranks: null for a single process, which writes the only piece. resumed: checkpoint of the run that continues.
    PieceWriter(std::filesystem::path folder, RunInfo info, std::shared_ptr<Ranks> ranks,
                const std::optional<Checkpoint>& resumed);

    /// Submits the particles of this process as a piece of a frame. The previous frame must be complete().
    void write(const Simulation& simulation);
    /// Waits until the pieces of all processes are on disk. Returns the content of the frame's index file, which the
    /// first process writes. Returns nothing if complete() was already called since the last write().
    [[nodiscard]] std::optional<PieceIndex> complete();
    /// Writes the particles of this process as a part of a checkpoint. The parts of the previous checkpoint stay
    /// intact. Returns the parts of all processes on the first process. Only for runs with several processes.
    [[nodiscard]] std::vector<CheckpointPart> write_checkpoint_part(const Simulation& simulation);

private:
    std::filesystem::path folder_;
    RunInfo info_;
    std::shared_ptr<Ranks> ranks_;
    std::size_t rank_;
    std::size_t size_;
    std::optional<PieceIndex> open_;
    unsigned set_ = 0;
    WriterThread thread_;
};

}  // namespace ricochet
