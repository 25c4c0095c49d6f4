/// \file
/// The names of the files that a run or a comparison writes into its output folder.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ricochet {

inline constexpr const char* kRunMarkerFile = ".ricochet-run";    ///< says that the folder is a run's own
inline constexpr const char* kRunInfoFile = "run.json";           ///< what is being run; written at the start
inline constexpr const char* kSummaryFile = "summary.json";       ///< what came out; written at the end
inline constexpr const char* kCheckpointFile = "checkpoint.bin";  ///< of an interrupted run, to go on from
inline constexpr const char* kParticleSeriesFile = "particles.pvd";
inline constexpr const char* kColliderSeriesFile = "colliders.pvd";
inline constexpr const char* kContactSeriesFile = "contacts.pvd";

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

/// contacts_NNNNNN.vtp; the number is the step after which it was written.
[[nodiscard]] std::string contact_file_name(std::uint64_t step);
/// The step of a contact file's name; nothing when it is not one.
[[nodiscard]] std::optional<std::uint64_t> step_of_contact_file(std::string_view name);

/// Files that follow each other in time, and the file that lists them.
struct FileSeries {
    std::string (*file_name)(std::uint64_t step);
    const char* list;
};
inline constexpr FileSeries kParticleSeries{&frame_file_name, kParticleSeriesFile};
inline constexpr FileSeries kContactSeries{&contact_file_name, kContactSeriesFile};

/// collider_NN_name.vtp; characters other than letters, digits, '-' and '_' become '_'.
[[nodiscard]] std::string collider_file_name(std::size_t index, std::string_view name);
/// The index in a collider file's name; nothing when it is not one.
[[nodiscard]] std::optional<std::size_t> index_of_collider_file(std::string_view name);

/// True for every name that a run or a comparison may give to a file in its folder, unfinished ones included; not for
/// the marker.
[[nodiscard]] bool is_run_file(std::string_view name);

}  // namespace ricochet
