/// \file
/// Everything that a run leaves in its output folder, from its first step to its summary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/io/checkpoint.h"
#include "ricochet/io/frame_writer.h"
#include "ricochet/io/run_report.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// Where particles are at the start, are born, and are kept: what a picture of a scene without meshes should show.
[[nodiscard]] Box3 particle_region(const SimulationSetup& setup);

/// Returns the region of the colliders that are not planes, where they are now.
[[nodiscard]] Box3 collider_region(const Simulation& simulation);

/// Lists the files that a run to be resumed keeps, in place of all that it had: to be called before others are removed.
void list_kept_files(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// Fills in what a frame of the run holds: the particles that the simulation has, springs between them, the camera's
/// place.
void fill_run_frame(VtkPolyData& frame, const RunInfo& info, const Simulation& simulation);

/// A frame whose pieces are on disk, see PieceWriter.
struct PieceIndex {
    std::uint64_t step = 0;
    VtkPolyData shape{};               ///< time and arrays, without values
    std::vector<std::string> files{};  ///< of the pieces
};

/// Writes a run: first run.json and the colliders, then frames, at the end the colliders with their totals and the
/// summary. What is on disk at any moment can be opened, however the run ends. Frames and contact files are written by
/// a thread of their own; at most two of them are in memory, then the simulation waits. The next call throws what that
/// thread threw.
class RunWriter {
public:
    /// folder: an OutputDirectory's, which must outlive the writer. region: what a plane has to be large enough for,
    /// besides the meshes. Fills in info.colliders. Throws RunError when the disk does not take it.
    /// resumed: of the interrupted run that the simulation goes on with. mode: the files are the same in both.
    RunWriter(std::filesystem::path folder, RunInfo info, const Simulation& simulation, const Box3& region,
              const std::optional<Checkpoint>& resumed = std::nullopt,
              WriterThread::Mode mode = WriterThread::Mode::background);
    /// Particles are written in pieces, by others: write_frame() leaves them out, and list() lists them.
    void leave_particles_out() { writes_particles_ = false; }
    /// Writes the index over a frame's pieces, which are all on disk.
    void list(const PieceIndex& index);

    /// To be called after every step. Logs its contacts where the simulation records them. Throws like
    /// ContactLog::add_step(), and what writing an earlier frame threw, so that a run that cannot write ends soon.
    void add_step(const Simulation& simulation);
    /// Hands the present state over as a frame, with the contacts since the one before where the simulation records
    /// them. Throws what writing an earlier frame threw.
    void write_frame(const Simulation& simulation);
    /// Writes a checkpoint of the present state, which must be a frame already (write_frame()), and waits until all
    /// that it names is on disk. scene: the scene's fingerprint; wall_seconds: spent so far; parts: of the particles,
    /// where the simulation shows all but them. Throws like write_frame().
    void write_checkpoint(const Simulation& simulation, std::uint64_t scene, double wall_seconds,
                          std::vector<CheckpointPart> parts = {});
    /// Makes the last checkpoint, if there is one, that from which a finished run can be extended. Throws RunError
    /// where the system refuses.
    void keep_checkpoint_for_extension() const;
    /// Writes the present state where it is not yet a frame, waits for all frames, and writes the colliders' totals.
    /// Returns the summary, without what only the caller knows: version, scene, threads, seconds, interrupted.
    [[nodiscard]] RunSummary finish(const Simulation& simulation);
    /// The same for a run that has diverged inside a step: the frames end before it.
    [[nodiscard]] RunSummary finish_diverged(const Simulation& simulation, const std::string& message);
    void write_summary(const RunSummary& summary) const;
    /// s that the simulation's thread has spent in calls of this class, waiting for the disk included; a resumed run
    /// counts on.
    [[nodiscard]] double output_seconds() const { return output_seconds_; }
    /// What it has spent on output beside this class.
    void add_output_seconds(double seconds) { output_seconds_ += seconds; }

private:
    [[nodiscard]] RunSummary close(const Simulation& simulation);
    void write_colliders(const Simulation& simulation) const;

    std::filesystem::path folder_;
    RunInfo info_;
    Box3 region_;
    std::optional<std::uint64_t> last_frame_;
    bool writes_particles_ = true;
    double output_seconds_ = 0.0;
    std::shared_ptr<WriterThread> thread_;
    FrameWriter frames_;
    std::optional<ContactLog> contacts_;
    LoadTables loads_;
    std::optional<FrameWriter> moving_;  ///< of the colliders that move, where some do
};

}  // namespace ricochet
