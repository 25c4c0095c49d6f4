/// \file
/// The contact log: every impact of a run as a row of a point file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/io/frame_writer.h"
#include "ricochet/io/vtk.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// The columns of the contact log, one row an entry of Simulation::contact_records().
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

    [[nodiscard]] std::size_t size() const { return time.size(); }
    void resize(std::size_t rows);
};

/// The rows as points with one array a column, named as the members of ContactColumns.
[[nodiscard]] VtkPolyData contact_frame(ContactColumns columns, double time);

/// Writes contacts_NNNNNN.vtp files and contacts.pvd in the background. Each file holds the rows since the one before,
/// in the order of steps and, within a step, of Simulation::contact_records().
class ContactLog {
public:
    /// As many rows are written out at once, even between frames: some 100 MB. With those on their way to the disk at
    /// most three times as much is in memory, besides the rows of the step in work.
    static constexpr std::size_t kMostRows = std::size_t{1} << 19;

    /// The simulation must record its contacts (SimulationOptions::record_contacts); its steps from now on are logged.
    /// earlier: the files of an interrupted run that goes on here. thread: as of FrameWriter.
    ContactLog(const std::filesystem::path& folder, const Simulation& simulation, std::size_t most_rows = kMostRows,
               std::vector<PvdEntry> earlier = {}, std::shared_ptr<WriterThread> thread = nullptr);

    /// Takes the rows of the last step; to be called after every step (again for the same step: no effect). Throws
    /// std::logic_error when a step was left out, and what an earlier file's writing threw.
    void add_step(const Simulation& simulation);
    /// Writes what has come since the file before, if only to say that nothing has. Throws like add_step().
    void write(const Simulation& simulation);
    /// Waits until the files so far are on disk; the whole series. Throws what the writing threw.
    [[nodiscard]] std::vector<PvdEntry> drain() { return files_.drain(); }
    /// Waits until everything is on disk. Throws what the writing threw.
    void finish() { files_.finish(); }

private:
    void set_row(std::size_t row, const ContactRecord& record, const Simulation& simulation);

    FrameWriter files_;
    std::size_t most_rows_;
    std::vector<bool> has_triangles_;  ///< by collider
    std::uint64_t step_;               ///< the last one added
    std::optional<std::uint64_t> written_;
    ContactColumns columns_;
};

}  // namespace ricochet
