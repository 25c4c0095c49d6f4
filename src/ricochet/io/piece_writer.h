/// \file
/// What a process of a shared run writes by itself: its piece of each frame, its part of each checkpoint.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/core/ranks.h"
#include "ricochet/io/frame_writer.h"
#include "ricochet/io/run_report.h"
#include "ricochet/io/run_writer.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// All processes of a run make the same calls. Pieces are written by a thread of their own; what it throws comes with
/// the next call.
class PieceWriter {
public:
    /// ranks: null for one process, which writes the only piece. resumed: the checkpoint that the run goes on from.
    PieceWriter(std::filesystem::path folder, RunInfo info, std::shared_ptr<Ranks> ranks,
                const std::optional<Checkpoint>& resumed);

    /// Hands the particles that the simulation has here over as a piece of a frame; the one before must be complete().
    void write(const Simulation& simulation);
    /// Waits until the pieces of all processes are on disk: what the first one is to list. Nothing where that has been
    /// asked since the last write().
    [[nodiscard]] std::optional<PieceIndex> complete();
    /// Writes the particles that the simulation has here as a part of a checkpoint, beside the one that was made last,
    /// which stays whole: the parts of all, on the first process. Several processes only.
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
