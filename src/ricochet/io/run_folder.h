/// \file
/// The folder that a run writes into: the names of its files, its lock while a run writes, and what it holds.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ricochet/io/run_report.h"

namespace ricochet {

inline constexpr const char* kRunMarkerFile = ".ricochet-run";    ///< says that the folder is a run's own
inline constexpr const char* kRunInfoFile = "run.json";           ///< what is being run; written at the start
inline constexpr const char* kSummaryFile = "summary.json";       ///< what came out; written at the end
inline constexpr const char* kCheckpointFile = "checkpoint.bin";  ///< of an interrupted run, to go on from
inline constexpr const char* kExtensionFile = "extension.bin";    ///< of a finished run, to go on to a later time
inline constexpr const char* kParticleSeriesFile = "particles.pvd";
inline constexpr const char* kColliderSeriesFile = "colliders.pvd";
inline constexpr const char* kContactSeriesFile = "contacts.pvd";
inline constexpr const char* kMovingSeriesFile = "moving.pvd";
inline constexpr const char* kColliderTableFile = "colliders.csv";  ///< what was done to colliders that move
inline constexpr const char* kBodyTableFile = "bodies.csv";         ///< how bodies have moved

inline constexpr const char* kComparisonJsonFile = "compare.json";          ///< everything that a comparison found
inline constexpr const char* kComparisonTableFile = "compare.csv";          ///< one line a response and time step
inline constexpr const char* kComparisonScriptFile = "compare.gp";          ///< draws the pictures with gnuplot
inline constexpr const char* kComparisonPointsFile = "compare.dat";         ///< the rows for the script
inline constexpr const char* kComparisonEnergyFile = "compare_energy.dat";  ///< energy errors over time for the script
inline constexpr const char* kComparisonMarkdownFile = "report.md";
inline constexpr const char* kComparisonHtmlFile = "report.html";
/// The pictures that the script draws.
inline constexpr std::array<const char*, 6> kComparisonPictures{
    "cost.png", "error_position.png", "error_impact.png", "energy_time.png", "penetration.png", "tunnelled.png"};

/// particles_NNNNNN.vtp; the number is the step.
[[nodiscard]] std::string frame_file_name(std::uint64_t step);
/// The step of a frame file's name; nothing when it is not one.
[[nodiscard]] std::optional<std::uint64_t> step_of_frame_file(std::string_view name);

/// particles_NNNNNN.pvtp: the index over the pieces of a frame that several processes have written.
[[nodiscard]] std::string frame_index_name(std::uint64_t step);
/// The step of an index's name; nothing when it is not one.
[[nodiscard]] std::optional<std::uint64_t> step_of_frame_index(std::string_view name);
/// particles_NNNNNN_pK.vtp: what process K had of it.
[[nodiscard]] std::string piece_file_name(std::uint64_t step, std::size_t piece);
/// The step of a piece's name; nothing when it is not one.
[[nodiscard]] std::optional<std::uint64_t> step_of_piece_file(std::string_view name);
/// checkpoint_S_pK.bin: the particles that process K had. Sets 0 and 1 take turns, so that one is always whole.
[[nodiscard]] std::string checkpoint_part_name(unsigned set, std::size_t part);
/// The set of such a name; nothing when it is not one.
[[nodiscard]] std::optional<unsigned> set_of_checkpoint_part(std::string_view name);

/// contacts_NNNNNN.vtp; the number is the step after which it was written.
[[nodiscard]] std::string contact_file_name(std::uint64_t step);
/// The step of a contact file's name; nothing when it is not one.
[[nodiscard]] std::optional<std::uint64_t> step_of_contact_file(std::string_view name);

/// moving_NNNNNN.vtp: the colliders that move, where they are after a step.
[[nodiscard]] std::string moving_file_name(std::uint64_t step);
/// The step of such a file's name; nothing when it is not one.
[[nodiscard]] std::optional<std::uint64_t> step_of_moving_file(std::string_view name);

/// Files that follow each other in time, and the file that lists them.
struct FileSeries {
    std::string (*file_name)(std::uint64_t step);
    const char* list;
};
inline constexpr FileSeries kParticleSeries{&frame_file_name, kParticleSeriesFile};
inline constexpr FileSeries kContactSeries{&contact_file_name, kContactSeriesFile};
inline constexpr FileSeries kMovingSeries{&moving_file_name, kMovingSeriesFile};

/// At most 80 characters of a name that a file may have in any program: others than letters, digits, '-' and '_' become
/// '_'.
[[nodiscard]] std::string plain_file_name(std::string_view name);

/// collider_NN_name.vtp, the name as plain_file_name() makes it.
[[nodiscard]] std::string collider_file_name(std::size_t index, std::string_view name);
/// The index in a collider file's name; nothing when it is not one.
[[nodiscard]] std::optional<std::size_t> index_of_collider_file(std::string_view name);

/// True for every name that a run or a comparison may give to a file in its folder, unfinished ones included; not for
/// the marker.
[[nodiscard]] bool is_run_file(std::string_view name);

/// Takes a folder for one run. The folder must be new, empty, or carry an earlier run's marker; of an earlier run only
/// the files that a run writes are removed (is_run_file()), everything else stays. The folder is locked while this
/// object lives; the lock goes with the process, however that ends.
class OutputDirectory {
public:
    /// Creates the folder (and its parents) where missing, marks and locks it, and removes an earlier run's files.
    /// Throws InputError when the folder holds anything else or the path is not a folder; RunError when it is in use by
    /// another run or the system refuses.
    explicit OutputDirectory(std::filesystem::path path) : OutputDirectory(std::move(path), Earlier::remove) {}
    /// What is to become of an earlier run's files. Kept ones must be there: InputError where the folder is no run's.
    /// join: this process writes into the folder of a run that another one has begun and shares: see share().
    enum class Earlier { remove, keep, join };
    OutputDirectory(std::filesystem::path path, Earlier earlier);
    ~OutputDirectory();
    OutputDirectory(const OutputDirectory&) = delete;
    OutputDirectory& operator=(const OutputDirectory&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// From now on other processes may join, and the folder is locked while any of them lives. Throws RunError where
    /// another run has taken it that very moment.
    void share() const;
    /// Removes the parts of checkpoints, but those of these names.
    void remove_checkpoint_parts(const std::vector<std::string>& kept = {}) const;
    /// Removes frames and contact files of steps after this one, and what was never finished: an interrupted run goes
    /// on there.
    void remove_after(std::uint64_t step) const;

private:
    std::filesystem::path path_;
    int marker_ = -1;  // file descriptor that holds the lock
};

/// One frame of a run.
struct FrameFile {
    std::uint64_t step = 0;
    std::filesystem::path path;
    std::filesystem::path moving{};  ///< of the colliders that move; empty where none do
};

/// What a run has written so far.
struct RunFolder {
    RunInfo info;                                  ///< defaults where the folder has no run.json
    std::vector<FrameFile> frames;                 ///< by step
    std::vector<std::filesystem::path> colliders;  ///< by index
    std::vector<FrameFile> contacts{};             ///< of the contact log, by step
};

/// Throws InputError unless a file that a run's folder names, or lists, is a regular file in that folder. A folder may
/// come from a stranger, with links that lead elsewhere and pipes that are waited for. Passes where there is no such
/// file.
void require_own_file(const std::filesystem::path& file);

/// Lists a run's folder; the run may still be writing, or have been interrupted. Throws InputError when there is no
/// such folder, when it holds no frame, and when one of its files leads out of it (require_own_file()).
[[nodiscard]] RunFolder open_run_folder(const std::filesystem::path& path);

/// Returns true if a collider's totals, which hold until `time` (s), are older than the last frame: the run was killed.
[[nodiscard]] bool are_behind(const RunFolder& folder, double time);

}  // namespace ricochet
