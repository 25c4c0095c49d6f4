/// \file
/// What a run writes while it goes on, also where several processes share it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "ricochet/core/ranks.h"
#include "ricochet/io/piece_writer.h"
#include "ricochet/io/run_folder.h"
#include "ricochet/io/run_writer.h"

namespace ricochet::cli {

/// All processes of a run make the same calls.
class RunOutput {
public:
    RunOutput() = default;
    /// writer: of the first process; nothing on the others. folder: of all processes where there are pieces, else of
    /// the first. resumed: the run goes on from there.
    struct Parts {
        std::shared_ptr<Ranks> ranks{};  ///< null for one process
        OutputDirectory* folder = nullptr;
        RunWriter* writer = nullptr;
        std::unique_ptr<PieceWriter> pieces{};  ///< with output.pieces
        std::optional<std::uint64_t> resumed_step{};
        std::uint64_t fingerprint = 0;  ///< of the scene
    };
    explicit RunOutput(Parts parts) : parts_(std::move(parts)), last_frame_(parts_.resumed_step) {}

    /// Logs the step's contacts.
    void add_step(Simulation& simulation);
    /// Writes the present state as a frame, where it is none yet.
    void write_frame(Simulation& simulation);
    /// All pieces of the last frame are on disk, and listed.
    void complete_frame();
    /// Writes a checkpoint of the present state, which is a frame already. seconds: spent so far.
    void write_checkpoint(Simulation& simulation, double seconds);
    /// s that this process has spent on output or waiting for it; 0 where it is not the first.
    [[nodiscard]] double seconds() const { return parts_.writer == nullptr ? 0.0 : parts_.writer->output_seconds(); }

private:
    void list_pieces();

    Parts parts_{};
    std::optional<std::uint64_t> last_frame_;
};

}  // namespace ricochet::cli
