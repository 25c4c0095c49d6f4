/// \file
/// Output folder of a run: names of its files, its lock while a run writes, and its contents.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "run/run_report.h"

namespace ricochet {

inline constexpr const char* kRunMarkerFile = ".ricochet-run";    ///< marks the folder as the output folder of a run
inline constexpr const char* kRunInfoFile = "run.json";           ///< description of the run, written at the start
inline constexpr const char* kSummaryFile = "summary.json";       ///< results, written at the end
inline constexpr const char* kCheckpointFile = "checkpoint.bin";  ///< state from which --resume continues an
                                                                  ///< interrupted run
inline constexpr const char* kExtensionFile =
    "extension.bin";  ///< state of a finished run, from which it can continue to a later time
inline constexpr const char* kParticleSeriesFile = "particles.pvd";
inline constexpr const char* kColliderSeriesFile = "colliders.pvd";
inline constexpr const char* kContactSeriesFile = "contacts.pvd";
inline constexpr const char* kMovingSeriesFile = "moving.pvd";
inline constexpr const char* kColliderTableFile = "colliders.csv";            ///< loads on moving colliders
inline constexpr const char* kBodyTableFile = "bodies.csv";                   ///< motion of dynamic bodies
inline constexpr const char* kCounterTableFile = "counters.csv";              ///< passages of counters over time
inline constexpr const char* kHistogramTableFile = "counter_histograms.csv";  ///< histograms of passages

inline constexpr const char* kComparisonJsonFile = "compare.json";   ///< all results of a comparison
inline constexpr const char* kComparisonTableFile = "compare.csv";   ///< one line for each response and time step
inline constexpr const char* kComparisonScriptFile = "compare.gp";   ///< gnuplot script that draws the pictures
inline constexpr const char* kComparisonPointsFile = "compare.dat";  ///< data that the script plots
inline constexpr const char* kComparisonEnergyFile = "compare_energy.dat";  ///< energy errors over time that the script
                                                                            ///< plots
inline constexpr const char* kComparisonMarkdownFile = "report.md";
inline constexpr const char* kComparisonHtmlFile = "report.html";
/// Pictures drawn by the script.
inline constexpr std::array<const char*, 6> kComparisonPictures{
    "cost.png", "error_position.png", "error_impact.png", "energy_time.png", "penetration.png", "tunnelled.png"};

/// Returns particles_NNNNNN.vtp for a step number.
[[nodiscard]] std::string frame_file_name(std::uint64_t step);
/// Returns the step in the name of a frame file, or nothing for other names.
[[nodiscard]] std::optional<std::uint64_t> step_of_frame_file(std::string_view name);

/// Returns particles_NNNNNN.pvtp, the index of a frame whose pieces several processes wrote.
[[nodiscard]] std::string frame_index_name(std::uint64_t step);
/// Returns the step in the name of an index, or nothing for other names.
[[nodiscard]] std::optional<std::uint64_t> step_of_frame_index(std::string_view name);
/// Returns particles_NNNNNN_pK.vtp, the piece of process K.
[[nodiscard]] std::string piece_file_name(std::uint64_t step, std::size_t piece);
/// Returns the step in the name of a piece, or nothing for other names.
[[nodiscard]] std::optional<std::uint64_t> step_of_piece_file(std::string_view name);
/// Returns checkpoint_S_pK.bin, the particles of process K. Sets 0 and 1 alternate, so that one set is always
/// complete.
[[nodiscard]] std::string checkpoint_part_name(unsigned set, std::size_t part);
/// Returns the set in the name of a checkpoint part, or nothing for other names.
[[nodiscard]] std::optional<unsigned> set_of_checkpoint_part(std::string_view name);

/// Returns contacts_NNNNNN.vtp. The number is the step after which the file was written.
[[nodiscard]] std::string contact_file_name(std::uint64_t step);
/// Returns the step in the name of a contact file, or nothing for other names.
[[nodiscard]] std::optional<std::uint64_t> step_of_contact_file(std::string_view name);

/// Returns moving_NNNNNN.vtp, the moving colliders after a step.
[[nodiscard]] std::string moving_file_name(std::uint64_t step);
/// Returns the step in the name of a file of moving colliders, or nothing for other names.
[[nodiscard]] std::optional<std::uint64_t> step_of_moving_file(std::string_view name);

/// Names of a series of files, one file per output time, and the name of the file that lists them.
struct FileSeries {
    std::string (*file_name)(std::uint64_t step);
    const char* list;
};
inline constexpr FileSeries kParticleSeries{&frame_file_name, kParticleSeriesFile};
inline constexpr FileSeries kContactSeries{&contact_file_name, kContactSeriesFile};
inline constexpr FileSeries kMovingSeries{&moving_file_name, kMovingSeriesFile};

/// Returns at most 80 characters of a name, with '_' instead of characters other than letters, digits, '-' and '_'.
/// The result is a valid file name on all systems.
[[nodiscard]] std::string plain_file_name(std::string_view name);

/// Returns collider_NN_name.vtp, with the name converted by plain_file_name().
[[nodiscard]] std::string collider_file_name(std::size_t index, std::string_view name);
/// Returns the index in the name of a collider file, or nothing for other names.
[[nodiscard]] std::optional<std::size_t> index_of_collider_file(std::string_view name);

/// Returns true for every file name that a run or a comparison may use, including unfinished files. Returns false for
/// the marker.
[[nodiscard]] bool is_run_file(std::string_view name);

/// Output folder of one run, locked against other runs.
/// The folder must be new, empty, or carry the marker of an earlier run. Only files of that earlier run are removed
/// (is_run_file()). The folder is locked for the lifetime of this object. If the process is killed, the system releases
/// the lock.
class OutputDirectory {
public:
    /// Creates the folder and missing parents, marks and locks it, and removes the files of an earlier run.
    /// Throws InputError if the folder contains other files or the path is not a folder. Throws RunError if another run
    /// uses the folder or the operating system refuses.
    explicit OutputDirectory(std::filesystem::path path) : OutputDirectory(std::move(path), Earlier::remove) {}
    /// Treatment of an earlier run's files.
    /// - remove: deletes them.
    /// - keep: continues that run; throws InputError if the folder does not belong to a run.
    /// - join: shares the folder of a run that another process has started; see share().
    enum class Earlier { remove, keep, join };
    OutputDirectory(std::filesystem::path path, Earlier earlier);
    ~OutputDirectory();
    OutputDirectory(const OutputDirectory&) = delete;
    OutputDirectory& operator=(const OutputDirectory&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Allows other processes to join. The folder stays locked while any of these processes lives. Throws RunError if
    /// another run locks the folder at the same moment.
    void share() const;
    /// Removes all parts of checkpoints except the given names.
    void remove_checkpoint_parts(const std::vector<std::string>& kept = {}) const;
    /// Removes unfinished files, and frames and contact files of later steps. An interrupted run then continues at this
    /// step.
    void remove_after(std::uint64_t step) const;

private:
    std::filesystem::path path_;
    int marker_ = -1;  // file descriptor with the lock
};

/// One frame of a run.
struct FrameFile {
    std::uint64_t step = 0;
    std::filesystem::path path;
    std::filesystem::path moving{};  ///< file of the moving colliders; empty if none move
};

/// Files that a run has written so far.
struct RunFolder {
    RunInfo info;                                  ///< defaults if the folder has no run.json
    std::vector<FrameFile> frames;                 ///< ordered by step
    std::vector<std::filesystem::path> colliders;  ///< ordered by index
    std::vector<FrameFile> contacts{};             ///< files of the contact log, ordered by step
};

/// Throws InputError if a file of a run's folder is not a regular file, or is a link to another folder. Accepts missing
/// files.
/// Reason: a folder from an untrusted source can contain links to other folders, and pipes that block.
void require_own_file(const std::filesystem::path& file);

/// Lists the files in a run's folder. The run can be in progress or interrupted. Throws InputError if the folder is
/// missing or has no frame, or if require_own_file() refuses a file.
[[nodiscard]] RunFolder open_run_folder(const std::filesystem::path& path);

/// Returns true if a collider's totals end before the last frame, as happens if the run was killed.
/// time: end of the totals, in s.
[[nodiscard]] bool has_incomplete_totals(const RunFolder& folder, double time);

}  // namespace ricochet
