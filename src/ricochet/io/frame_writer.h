/// \file
/// Writes the frames and the contact log of a run on a thread beside the workers, so that the simulation goes on
/// meanwhile.
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
#include "ricochet/io/run_folder.h"
#include "ricochet/io/vtk.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// A queue of at most kMostInFlight jobs, done one after the other on one thread; submit() waits while it is full.
/// After a job has thrown no further one is done, and every call throws what it threw. Only one thread may submit jobs.
class WriterThread {
public:
    /// On a thread of its own, or at once in submit(), with the same files.
    enum class Mode { background, synchronous };
    static constexpr std::size_t kMostInFlight = 2;

    explicit WriterThread(Mode mode = Mode::background);
    /// Finishes the job in progress and drops those that wait.
    ~WriterThread();
    WriterThread(const WriterThread&) = delete;
    WriterThread& operator=(const WriterThread&) = delete;

    /// Waits until submit() would not wait.
    void wait_for_room();
    void submit(std::function<void()> job);
    /// Waits until all jobs given so far are done.
    void drain();
    /// Throws what an earlier job threw; never waits.
    void check();

private:
    void work();
    void wait_until_at_most(std::size_t in_flight);

    Mode mode_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> jobs_;  // the first one may be in progress
    std::exception_ptr error_;
    bool closing_ = false;
    std::thread thread_;
};

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
    /// Hands over a frame. Throws what writing an earlier frame threw.
    void submit(std::uint64_t step, VtkPolyData frame);
    /// The same for a frame whose pieces are on disk: only its index is written.
    void submit_index(std::uint64_t step, double time, std::string text);
    /// Throws what writing an earlier frame threw, without waiting.
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

/// The columns of the contact log, one row an entry of Simulation::contact_records() or pair_records().
struct ContactColumns {
    std::vector<Vec3> point;             ///< on the surface, m
    std::vector<double> time;            ///< s
    std::vector<std::int64_t> particle;  ///< id
    std::vector<std::uint32_t> collider;
    std::vector<std::int64_t> triangle;  ///< of the collider's mesh; -1 for planes, balls and cylinders
    std::vector<Vec3> barycentric;       ///< for the triangle's corners; zero where there is no triangle
    std::vector<Vec3> normal;            ///< unit, from the surface to the particle
    std::vector<Vec3> velocity_before;   ///< m/s
    std::vector<Vec3> velocity_after;    ///< m/s
    std::vector<Vec3> impulse;           ///< N s, given to the surface
    std::vector<double> radius;          ///< of the particle, m
    /// Of the surface's own material, m/s; only where materials move.
    std::optional<std::vector<Vec3>> surface_velocity;
    /// Id of the sphere that was met; -1: a surface was. Only where spheres meet each other.
    std::optional<std::vector<std::int64_t>> other;

    [[nodiscard]] std::size_t size() const { return time.size(); }
    void resize(std::size_t rows);
};

/// The rows as points with one array a column, named as the members of ContactColumns.
[[nodiscard]] VtkPolyData contact_frame(ContactColumns columns, double time);

/// Writes contacts_NNNNNN.vtp files and contacts.pvd in the background. Each file holds the rows since the one before,
/// in the order of steps and, within a step, of Simulation::contact_records().
class ContactLog {
public:
    /// Rows (some 100 MB) after which a file is written even between two frames. With the files that are being written,
    /// at most three times as many are in memory, besides those of the step in progress.
    static constexpr std::size_t kMostRows = std::size_t{1} << 19;

    /// The simulation must record its contacts (SimulationOptions::record_contacts); its steps from now on are logged.
    /// earlier: the files of an interrupted run that goes on here. thread: as of FrameWriter.
    ContactLog(const std::filesystem::path& folder, const Simulation& simulation, std::size_t most_rows = kMostRows,
               std::vector<PvdEntry> earlier = {}, std::shared_ptr<WriterThread> thread = nullptr);

    /// Takes the rows of the last step; to be called after every step (again for the same step: no effect). Throws
    /// std::logic_error when a step was left out, and what an earlier file's writing threw.
    void add_step(const Simulation& simulation);
    /// Writes the rows since the file before, even if there are none. Throws like add_step().
    void write(const Simulation& simulation);
    /// Waits until the files so far are on disk; the whole series. Throws what the writing threw.
    [[nodiscard]] std::vector<PvdEntry> drain() { return files_.drain(); }
    /// Waits until everything is on disk. Throws what the writing threw.
    void finish() { files_.finish(); }

private:
    void set_row(std::size_t row, const ContactRecord& record, const Simulation& simulation);
    void set_row(std::size_t row, const PairImpactRecord& record);

    FrameWriter files_;
    std::size_t most_rows_;
    std::vector<bool> has_triangles_;  ///< by collider
    std::uint64_t step_;               ///< the last one added
    std::optional<std::uint64_t> written_;
    ContactColumns columns_;
};

}  // namespace ricochet
