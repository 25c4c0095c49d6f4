/// \file
/// Writer of a run's output folder, from the first step to the summary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/simulation.h"
#include "run/checkpoint.h"
#include "run/counter_tables.h"
#include "run/frame_writer.h"
#include "run/run_report.h"

namespace ricochet {

/// Returns the bounding box of the initial particles, the emitters and the scene's bounds. Pictures of a scene without
/// meshes should show this box.
[[nodiscard]] Box3 particle_region(const SimulationSetup& setup);

/// Returns the bounding box of all colliders except planes, at their current positions.
[[nodiscard]] Box3 collider_region(const Simulation& simulation);

/// Rewrites the series files of a resumed run. They then list only the files that the run keeps. Call it before the
/// other files are removed.
void list_kept_files(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// Fills a frame of the run with the simulation's particles, the springs between them, and a moving camera.
void fill_run_frame(VtkPolyData& frame, const RunInfo& info, const Simulation& simulation);

/// Content of the index file of a frame whose pieces are on disk; see PieceWriter.
struct PieceIndex {
    std::uint64_t step = 0;
    VtkPolyData shape{};               ///< time and arrays, without values
    std::vector<std::string> files{};  ///< names of the pieces
};

/// Writer of a run. It writes first run.json and the colliders, then frames, finally the summary and the colliders with
/// their totals.
/// The files on disk can be opened at any moment, even if the run is killed. A separate thread writes frames and
/// contact files. At most two of these files are in memory; the simulation waits at this limit. The next call rethrows
/// an exception of that thread.
class RunWriter {
public:
    /// folder: path of an OutputDirectory, which must outlive the writer.
    /// region: box that planes must cover, in addition to the meshes.
    /// resumed: checkpoint of the interrupted run that the simulation continues.
    /// mode: both modes write the same files.
    /// Fills in info.colliders. Throws RunError if writing fails.
    RunWriter(std::filesystem::path folder, RunInfo info, const Simulation& simulation, const Box3& region,
              const std::optional<Checkpoint>& resumed = std::nullopt,
              WriterThread::Mode mode = WriterThread::Mode::background);
    /// Excludes particles from write_frame(), because PieceWriter writes them in pieces. Call list() to write the index
    /// of such a frame.
    void leave_particles_out() { writes_particles_ = false; }
    /// Writes the index of a frame whose pieces are all on disk.
    void list(const PieceIndex& index);

    /// Logs the contacts of a step if the simulation records them. Call it after every step.
    /// Throws like ContactLog::add_step(). Rethrows the exception of an earlier write, so that a run ends soon after
    /// the disk is full.
    void add_step(const Simulation& simulation);
    /// Submits the current state as a frame, with the contacts since the previous frame if the simulation records
    /// them. Rethrows the exception of an earlier write.
    void write_frame(const Simulation& simulation);
    /// Writes a checkpoint of the current state and waits until all files that it refers to are on disk. Call
    /// write_frame() for the same state before.
    /// scene: fingerprint of the scene. wall_seconds: time spent so far. parts: files of the particles, if the
    /// simulation's state does not contain the particles.
    /// Throws like write_frame().
    void write_checkpoint(const Simulation& simulation, std::uint64_t scene, double wall_seconds,
                          std::vector<CheckpointPart> parts = {});
    /// Renames the last checkpoint, if any, to the file from which a finished run can be extended. Throws RunError if
    /// renaming fails.
    void keep_checkpoint_for_extension() const;
    /// Writes the current state if it is not yet a frame, waits for all frames, and writes the colliders' totals.
    /// Returns the summary without version, scene, threads, seconds and interrupted, which only the caller knows.
    [[nodiscard]] RunSummary finish(const Simulation& simulation);
    /// Finishes a run that has diverged inside a step; the frames end before that step.
    [[nodiscard]] RunSummary finish_diverged(const Simulation& simulation, const std::string& message);
    void write_summary(const RunSummary& summary) const;
    /// Returns the time, in s, that the simulation's thread has spent in this class, including waits for the disk. A
    /// resumed run continues the count.
    [[nodiscard]] double output_seconds() const { return output_seconds_; }
    /// Adds time, in s, spent on output outside of this class.
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
    CounterTables counters_;
    std::optional<FrameWriter> moving_;  ///< writer of the moving colliders; empty if none move
};

}  // namespace ricochet
