/// \file
/// Background writer of a run's frames and contact log, so that the simulation continues during output.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/io/vtk.h"
#include "ricochet/simulation.h"
#include "run/run_folder.h"

namespace ricochet {

/// A queue of at most kMostInFlight jobs that one thread runs in order; submit() waits while the queue is full.
/// After a job has thrown, no further job runs, and every call rethrows its exception. Only one thread may submit
/// jobs.
class WriterThread {
public:
    /// Jobs run on a separate thread, or immediately in submit(). Both modes write the same files.
    enum class Mode { background, synchronous };
    static constexpr std::size_t kMostInFlight = 2;

    explicit WriterThread(Mode mode = Mode::background);
    /// Finishes the job in progress and drops all waiting jobs.
    ~WriterThread();
    WriterThread(const WriterThread&) = delete;
    WriterThread& operator=(const WriterThread&) = delete;

    /// Waits until the queue has space for another job.
    void wait_for_room();
    void submit(std::function<void()> job);
    /// Waits until all submitted jobs are done.
    void drain();
    /// Rethrows the exception of an earlier job; never waits.
    void check();

private:
    void work();
    void wait_until_at_most(std::size_t in_flight);

    Mode mode_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> jobs_;  // the first job may be in progress
    std::exception_ptr error_;
    bool closing_ = false;
    std::thread thread_;
};

/// Writes frames in the given order and keeps the series file up to date. The output of a run can therefore be opened
/// even if the run is killed.
/// The limit on frames in memory applies to all series that share a thread. At most WriterThread::kMostInFlight frames
/// are in memory; submit() and blank_frame() wait when the limit is reached.
class FrameWriter {
public:
    /// earlier: frames of the interrupted run that continues here.
    /// thread: writer thread to share with another series; null creates a new thread.
    explicit FrameWriter(std::filesystem::path folder, FileSeries files = kParticleSeries,
                         std::vector<PvdEntry> earlier = {}, std::shared_ptr<WriterThread> thread = nullptr);

    /// Returns a frame to be filled, as soon as the queue has space for it. The frame may reuse the memory of a written
    /// frame and still contain its data. Otherwise it is empty. The function waits before the frame is filled, so that
    /// at most two frames are in memory. Throws like submit().
    [[nodiscard]] VtkPolyData blank_frame();
    /// Submits a frame. Rethrows the exception of an earlier write.
    void submit(std::uint64_t step, VtkPolyData frame);
    /// Submits a frame whose pieces are already on disk; only the index is written.
    void submit_index(std::uint64_t step, double time, std::string text);
    /// Rethrows the exception of an earlier write, without waiting.
    void check() { thread_->check(); }
    /// Waits until all submitted frames are on disk, and returns the whole series. Rethrows the exception of a failed
    /// write.
    [[nodiscard]] std::vector<PvdEntry> drain();
    /// Waits until all submitted frames are on disk. Rethrows the exception of a failed write.
    void finish() { (void)drain(); }
    /// Returns the number of frames submitted so far.
    [[nodiscard]] std::uint64_t submitted() const { return submitted_; }

private:
    class Series;

    std::shared_ptr<Series> series_;  // shared with the jobs, which may outlive this object
    std::uint64_t submitted_ = 0;
    std::shared_ptr<WriterThread> thread_;
};

/// Columns of the contact log, with one row for each entry of Simulation::contact_records() or pair_records().
struct ContactColumns {
    std::vector<Vec3> point;             ///< on the surface, m
    std::vector<double> time;            ///< s
    std::vector<std::int64_t> particle;  ///< id
    std::vector<std::uint32_t> collider;
    std::vector<std::int64_t> triangle;  ///< index in the collider's mesh; -1 for shapes without triangles
    std::vector<Vec3> barycentric;       ///< weights of the triangle's corners; zero if there is no triangle
    std::vector<Vec3> normal;            ///< unit, from the surface to the particle
    std::vector<Vec3> velocity_before;   ///< m/s
    std::vector<Vec3> velocity_after;    ///< m/s
    std::vector<Vec3> impulse;           ///< on the surface, in N s
    std::vector<double> radius;          ///< of the particle, m
    /// Velocity of the surface's own material, such as a conveyor belt, in m/s; only if materials move.
    std::optional<std::vector<Vec3>> surface_velocity;
    /// Id of the other sphere, or -1 for an impact on a surface; only if spheres collide with each other.
    std::optional<std::vector<std::int64_t>> other;

    [[nodiscard]] std::size_t size() const { return time.size(); }
    void resize(std::size_t rows);
};

/// Returns the rows as points with one array for each column, named like the members of ContactColumns.
[[nodiscard]] VtkPolyData contact_frame(ContactColumns columns, double time);

/// Writes contacts_NNNNNN.vtp files and contacts.pvd in the background.
/// Each file contains the rows since the previous file, ordered by step. Rows of one step keep the order of
/// Simulation::contact_records().
class ContactLog {
public:
    /// Number of rows (about 100 MB) at which a file is written even between two frames.
    /// Memory contains at most three times this number of rows, including files being written, plus the rows of the
    /// current step.
    static constexpr std::size_t kMostRows = std::size_t{1} << 19;

    /// Logs the steps after this call. The simulation must record its contacts (SimulationOptions::record_contacts).
    /// earlier: files of the interrupted run that continues here. thread: see FrameWriter.
    ContactLog(const std::filesystem::path& folder, const Simulation& simulation, std::size_t most_rows = kMostRows,
               std::vector<PvdEntry> earlier = {}, std::shared_ptr<WriterThread> thread = nullptr);

    /// Appends the rows of the last step. Call it after every step; a second call for one step has no effect. Throws
    /// std::logic_error if a step was left out, and rethrows the exception of an earlier write.
    void add_step(const Simulation& simulation);
    /// Writes a file with the rows since the previous file, even if there are none. Throws like add_step().
    void write(const Simulation& simulation);
    /// Waits until all files so far are on disk, and returns the whole series. Rethrows the exception of a failed
    /// write.
    [[nodiscard]] std::vector<PvdEntry> drain() { return files_.drain(); }
    /// Waits until all files are on disk. Rethrows the exception of a failed write.
    void finish() { files_.finish(); }

private:
    void set_row(std::size_t row, const ContactRecord& record, const Simulation& simulation);
    void set_row(std::size_t row, const PairImpactRecord& record);

    FrameWriter files_;
    std::size_t most_rows_;
    std::vector<bool> has_triangles_;  ///< by collider index
    std::uint64_t step_;               ///< last step that was added
    std::optional<std::uint64_t> written_;
    ContactColumns columns_;
};

}  // namespace ricochet
