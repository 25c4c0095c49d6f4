/// \file
/// Output of a run in progress. Several processes can share the run.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "ricochet/core/ranks.h"
#include "run/piece_writer.h"
#include "run/run_folder.h"
#include "run/run_writer.h"

namespace ricochet::cli {

/// Output of a run. All processes of a run make the same calls.
class RunOutput {
public:
    RunOutput() = default;
    /// Parts of the output. The writer exists only on the first process. The folder is open on all processes if they
    /// write pieces, otherwise only on the first process. resumed_step is set if the run is resumed.
    struct Parts {
        std::shared_ptr<Ranks> ranks{};  ///< null for one process
        OutputDirectory* folder = nullptr;
        RunWriter* writer = nullptr;
        std::unique_ptr<PieceWriter> pieces{};  ///< set if output.pieces is true
        std::optional<std::uint64_t> resumed_step{};
        std::uint64_t fingerprint = 0;  ///< fingerprint of the scene
    };
    explicit RunOutput(Parts parts) : parts_(std::move(parts)), last_frame_(parts_.resumed_step) {}

    /// Logs the contacts of the step.
    void add_step(Simulation& simulation);
    /// Writes the current state as a frame, unless this state has been written already.
    void write_frame(Simulation& simulation);
    /// Waits until all pieces of the last frame are on disk, and writes their index.
    void complete_frame();
    /// Writes a checkpoint of the current state, which must already be a frame. `seconds` is the elapsed wall time.
    void write_checkpoint(Simulation& simulation, double seconds);
    /// Returns the time that this process has spent on output or waiting for it, in s. Returns 0 on all processes
    /// except the first.
    [[nodiscard]] double seconds() const { return parts_.writer == nullptr ? 0.0 : parts_.writer->output_seconds(); }

private:
    void list_pieces();

    Parts parts_{};
    std::optional<std::uint64_t> last_frame_;
};

}  // namespace ricochet::cli
