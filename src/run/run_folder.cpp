#include "run/run_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "run/picture_files.h"

namespace ricochet {

// File names.

namespace {

constexpr std::string_view kFramePrefix = "particles_";
constexpr std::string_view kContactPrefix = "contacts_";
constexpr std::string_view kMovingPrefix = "moving_";
constexpr std::string_view kColliderPrefix = "collider_";
constexpr std::string_view kExtension = ".vtp";
constexpr std::string_view kIndexExtension = ".pvtp";
constexpr std::string_view kPartPrefix = "checkpoint_";
constexpr std::string_view kPartExtension = ".bin";
constexpr std::string_view kPieceMark = "_p";

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_plain(char c) { return is_letter(c) || is_digit(c) || c == '-' || c == '_'; }

// Returns the part of the name between prefix and extension, or nothing if they do not match.
std::optional<std::string_view> stem_after(std::string_view name, std::string_view prefix,
                                           std::string_view extension = kExtension) {
    if (!name.starts_with(prefix) || !name.ends_with(extension)) return std::nullopt;
    if (name.size() < prefix.size() + extension.size()) return std::nullopt;
    return name.substr(prefix.size(), name.size() - prefix.size() - extension.size());
}

std::optional<std::uint64_t> number(std::string_view text) {
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
    return value;
}

// Removes the ending ".PID-N.partial" of an unfinished file.
std::string_view without_partial_ending(std::string_view name) {
    constexpr std::string_view kPartial = ".partial";
    if (!name.ends_with(kPartial)) return name;
    const std::string_view rest = name.substr(0, name.size() - kPartial.size());
    const std::size_t dot = rest.rfind('.');
    if (dot == std::string_view::npos) return name;
    const std::string_view digits = rest.substr(dot + 1);
    const std::size_t dash = digits.find('-');
    if (dash == std::string_view::npos) return name;
    return number(digits.substr(0, dash)) && number(digits.substr(dash + 1)) ? rest.substr(0, dot) : name;
}

bool is_comparison_file(std::string_view name) {
    constexpr std::array kFiles{kComparisonJsonFile,   kComparisonTableFile,  kComparisonScriptFile,
                                kComparisonPointsFile, kComparisonEnergyFile, kComparisonMarkdownFile,
                                kComparisonHtmlFile};
    return std::find(kFiles.begin(), kFiles.end(), name) != kFiles.end() ||
           std::find(kComparisonPictures.begin(), kComparisonPictures.end(), name) != kComparisonPictures.end();
}

// Parses the step N and the process K from N_pK.
std::optional<std::pair<std::uint64_t, std::uint64_t>> numbers_of_part(std::optional<std::string_view> stem) {
    const std::size_t mark = stem ? stem->find(kPieceMark) : std::string_view::npos;
    if (mark == std::string_view::npos) return std::nullopt;
    const auto first = number(stem->substr(0, mark));
    const auto second = number(stem->substr(mark + kPieceMark.size()));
    return first && second ? std::optional(std::pair(*first, *second)) : std::nullopt;
}

std::string file_of_step(std::string_view prefix, std::uint64_t step) {
    return fmt::format("{}{:06}{}", prefix, step, kExtension);
}

std::optional<std::uint64_t> step_of_file(std::string_view prefix, std::string_view name) {
    const auto stem = stem_after(name, prefix);
    if (!stem) return std::nullopt;
    const auto step = number(*stem);
    return step && file_of_step(prefix, *step) == name ? step : std::nullopt;
}

}  // namespace

std::string frame_file_name(std::uint64_t step) { return file_of_step(kFramePrefix, step); }
std::optional<std::uint64_t> step_of_frame_file(std::string_view name) { return step_of_file(kFramePrefix, name); }
std::string frame_index_name(std::uint64_t step) {
    return fmt::format("{}{:06}{}", kFramePrefix, step, kIndexExtension);
}
std::optional<std::uint64_t> step_of_frame_index(std::string_view name) {
    const auto stem = stem_after(name, kFramePrefix, kIndexExtension);
    const auto step = stem ? number(*stem) : std::nullopt;
    return step && frame_index_name(*step) == name ? step : std::nullopt;
}

std::string piece_file_name(std::uint64_t step, std::size_t piece) {
    return fmt::format("{}{:06}{}{}{}", kFramePrefix, step, kPieceMark, piece, kExtension);
}
std::optional<std::uint64_t> step_of_piece_file(std::string_view name) {
    const auto numbers = numbers_of_part(stem_after(name, kFramePrefix));
    return numbers && piece_file_name(numbers->first, numbers->second) == name ? std::optional(numbers->first)
                                                                               : std::nullopt;
}

std::string checkpoint_part_name(unsigned set, std::size_t part) {
    return fmt::format("{}{}{}{}{}", kPartPrefix, set, kPieceMark, part, kPartExtension);
}
std::optional<unsigned> set_of_checkpoint_part(std::string_view name) {
    const auto numbers = numbers_of_part(stem_after(name, kPartPrefix, kPartExtension));
    if (!numbers || numbers->first > 1) return std::nullopt;
    const auto set = static_cast<unsigned>(numbers->first);
    return checkpoint_part_name(set, numbers->second) == name ? std::optional(set) : std::nullopt;
}

std::string contact_file_name(std::uint64_t step) { return file_of_step(kContactPrefix, step); }
std::optional<std::uint64_t> step_of_contact_file(std::string_view name) { return step_of_file(kContactPrefix, name); }

std::string moving_file_name(std::uint64_t step) { return file_of_step(kMovingPrefix, step); }
std::optional<std::uint64_t> step_of_moving_file(std::string_view name) { return step_of_file(kMovingPrefix, name); }

std::string plain_file_name(std::string_view name) {
    std::string plain(name.substr(0, 80));
    std::replace_if(
        plain.begin(), plain.end(), [](char c) { return !is_plain(c); }, '_');
    return plain;
}

std::string collider_file_name(std::size_t index, std::string_view name) {
    const std::string plain = plain_file_name(name);
    return fmt::format("{}{:02}{}{}{}", kColliderPrefix, index, plain.empty() ? "" : "_", plain, kExtension);
}

std::optional<std::size_t> index_of_collider_file(std::string_view name) {
    const auto stem = stem_after(name, kColliderPrefix);
    if (!stem || !std::all_of(stem->begin(), stem->end(), is_plain)) return std::nullopt;
    const std::size_t end = stem->find_first_of("_");
    const auto index = number(stem->substr(0, end));
    const std::string_view rest = end == std::string_view::npos ? "" : stem->substr(end + 1);
    return index && collider_file_name(*index, rest) == name ? index : std::nullopt;
}

bool is_run_file(std::string_view name) {
    const std::string_view finished = without_partial_ending(name);
    if (is_comparison_file(finished)) return true;
    return finished == kRunInfoFile || finished == kSummaryFile || finished == kCheckpointFile ||
           finished == kExtensionFile || finished == kParticleSeriesFile || finished == kColliderSeriesFile ||
           finished == kContactSeriesFile || finished == kMovingSeriesFile || finished == kColliderTableFile ||
           finished == kBodyTableFile || finished == kCounterTableFile || finished == kHistogramTableFile ||
           is_picture_file(finished, kParticleSpriteFile) || is_picture_file(finished, kParticleMeshFile) ||
           step_of_frame_file(finished) || step_of_frame_index(finished) || step_of_piece_file(finished) ||
           set_of_checkpoint_part(finished) || step_of_contact_file(finished) || step_of_moving_file(finished) ||
           index_of_collider_file(finished);
}

// Lock and marker of the folder while a run writes.

namespace {

constexpr std::string_view kMarkerText = "ricochet run: a later run into this folder replaces the files of this one\n";

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, const std::string& reason) {
    throw RunError(fmt::format("{}: cannot {} ({})", path.string(), what, reason));
}

void make_folder(const std::filesystem::path& path) {
    std::error_code error;
    if (path.empty()) throw InputError("--output: found an empty name, expected the name of a folder");
    if (std::filesystem::exists(path, error) && !std::filesystem::is_directory(path)) {
        throw InputError(fmt::format(
            "{}: is not a folder; give --output a folder that is new, empty or an earlier run's", path.string()));
    }
    std::filesystem::create_directories(path, error);
    if (error) fail(path, "create the output folder", error.message());
}

bool is_empty_folder(const std::filesystem::path& path) {
    std::error_code error;
    const bool empty = std::filesystem::is_empty(path, error);
    if (error) fail(path, "list the output folder", error.message());
    return empty;
}

int open_marker(const std::filesystem::path& folder) {
    const std::filesystem::path marker = folder / kRunMarkerFile;
    constexpr int kFlags = O_RDWR | O_CLOEXEC | O_NOFOLLOW;
    int descriptor = ::open(marker.c_str(), kFlags);
    if (descriptor < 0 && errno == ENOENT) {
        // The folder may be non-empty only because another run has just created its marker. The marker is therefore
        // opened again.
        descriptor = ::open(marker.c_str(), is_empty_folder(folder) ? kFlags | O_CREAT : kFlags, 0644);
        if (descriptor < 0 && errno == ENOENT) {
            throw InputError(fmt::format(
                "{}: the folder is not empty and no earlier run's; choose a new or empty folder", folder.string()));
        }
    }
    if (descriptor < 0) fail(marker, "open the run's marker", std::strerror(errno));
    return descriptor;
}

bool has_foreign_text(int descriptor) {
    std::array<char, kMarkerText.size()> start{};
    const ssize_t count = ::pread(descriptor, start.data(), start.size(), 0);
    if (count <= 0) return count < 0;  // an empty marker is accepted, because another process may still be writing it
    const std::string_view read{start.data(), static_cast<std::size_t>(count)};
    return !kMarkerText.starts_with(read);
}

void write_marker(int descriptor, const std::filesystem::path& marker) {
    std::size_t done = 0;
    while (done < kMarkerText.size()) {
        const ssize_t count =
            ::pwrite(descriptor, kMarkerText.data() + done, kMarkerText.size() - done, static_cast<off_t>(done));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(marker, "write the run's marker", std::strerror(errno));
        done += static_cast<std::size_t>(count);
    }
}

void lock_marker(int descriptor, const std::filesystem::path& folder, int how) {
    if (::flock(descriptor, how | LOCK_NB) == 0) return;
    if (errno != EWOULDBLOCK) fail(folder / kRunMarkerFile, "lock the output folder", std::strerror(errno));
    throw RunError(fmt::format("{}: another run is writing into this folder", folder.string()));
}

void claim_marker(int descriptor, const std::filesystem::path& folder) {
    const std::filesystem::path marker = folder / kRunMarkerFile;
    lock_marker(descriptor, folder, LOCK_EX);
    if (has_foreign_text(descriptor)) {
        throw InputError(
            fmt::format("{}: not a marker that ricochet wrote; choose another output folder", marker.string()));
    }
    write_marker(descriptor, marker);
}

template <class Wanted>
void remove_files(const std::filesystem::path& folder, Wanted&& is_wanted) {
    std::error_code error;
    std::vector<std::filesystem::path> files;
    for (auto entry = std::filesystem::directory_iterator(folder, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::filesystem::file_type type = entry->symlink_status().type();
        const bool file = type == std::filesystem::file_type::regular || type == std::filesystem::file_type::symlink;
        if (file && is_wanted(entry->path().filename().string())) files.push_back(entry->path());
    }
    if (error) fail(folder, "list the output folder", error.message());
    for (const std::filesystem::path& file : files) {
        std::filesystem::remove(file, error);
        if (error) fail(file, "remove the earlier run's file", error.message());
    }
}

}  // namespace

OutputDirectory::OutputDirectory(std::filesystem::path path, Earlier earlier) : path_(std::move(path)) {
    std::error_code ignored;
    if (earlier == Earlier::keep && !std::filesystem::exists(path_ / kRunMarkerFile, ignored)) {
        throw InputError(fmt::format("{}: no run was here that could be resumed; leave --resume out", path_.string()));
    }
    make_folder(path_);
    marker_ = open_marker(path_);
    try {
        earlier == Earlier::join ? lock_marker(marker_, path_, LOCK_SH) : claim_marker(marker_, path_);
        if (earlier == Earlier::remove) remove_files(path_, [](const std::string& name) { return is_run_file(name); });
    } catch (...) {
        ::close(marker_);
        throw;
    }
}

void OutputDirectory::share() const { lock_marker(marker_, path_, LOCK_SH); }

void OutputDirectory::remove_checkpoint_parts(const std::vector<std::string>& kept) const {
    remove_files(path_, [&](const std::string& name) {
        return set_of_checkpoint_part(name) && std::find(kept.begin(), kept.end(), name) == kept.end();
    });
}

void OutputDirectory::remove_after(std::uint64_t step) const {
    remove_files(path_, [&](const std::string& name) {
        auto frame = step_of_frame_file(name);
        if (!frame) frame = step_of_frame_index(name);
        if (!frame) frame = step_of_piece_file(name);
        const auto contacts = step_of_contact_file(name);
        const auto moving = step_of_moving_file(name);
        const bool is_unfinished = without_partial_ending(name) != name && is_run_file(name);
        return is_unfinished || (frame && *frame > step) || (contacts && *contacts > step) ||
               (moving && *moving > step);
    });
}

OutputDirectory::~OutputDirectory() { ::close(marker_); }

void require_own_file(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path real = std::filesystem::canonical(file, error);
    if (error) return;  // the caller's attempt to open the file reports the error
    if (!std::filesystem::is_regular_file(real, error)) {
        throw InputError(fmt::format("{}: is not a regular file, expected a file of a run", file.string()));
    }
    const std::filesystem::path folder = file.parent_path().empty() ? "." : file.parent_path();
    if (real.parent_path() == std::filesystem::canonical(folder, error)) return;
    throw InputError(fmt::format("{}: leads to {} outside of the run's folder, expected a file in it", file.string(),
                                 real.string()));
}

namespace {

/// Calls require_own_file() for the picture files in run.json and for all frames, contact files and collider files.
void require_own_files(const std::filesystem::path& path, const RunFolder& folder) {
    std::vector<ParticleDrawingDescription> drawings = folder.info.drawings;
    if (folder.info.picture) drawings.push_back(*folder.info.picture);
    for (const ParticleDrawingDescription& drawing : drawings) {
        if (!drawing.sprite.empty()) require_own_file(path / drawing.sprite);
        if (!drawing.mesh.empty()) require_own_file(path / drawing.mesh);
    }
    for (const std::vector<FrameFile>* files : {&folder.frames, &folder.contacts}) {
        for (const FrameFile& file : *files) {
            require_own_file(file.path);
            if (!file.moving.empty()) require_own_file(file.moving);
        }
    }
    for (const std::filesystem::path& file : folder.colliders) require_own_file(file);
}

}  // namespace

RunFolder open_run_folder(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_directory(path, error)) {
        const char* const fault = std::filesystem::exists(path, error) ? "is a file" : "no such folder";
        throw InputError(fmt::format("{}: {}; give the --output folder of a ricochet run", path.string(), fault));
    }
    RunFolder folder;
    std::map<std::size_t, std::filesystem::path> colliders;
    std::map<std::uint64_t, std::filesystem::path> moving;
    for (auto entry = std::filesystem::directory_iterator(path, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        auto frame = step_of_frame_file(name);
        if (!frame) frame = step_of_frame_index(name);
        if (frame) folder.frames.push_back({*frame, entry->path()});
        if (const auto step = step_of_contact_file(name)) folder.contacts.push_back({*step, entry->path()});
        if (const auto step = step_of_moving_file(name)) moving.emplace(*step, entry->path());
        if (const auto index = index_of_collider_file(name)) colliders.emplace(*index, entry->path());
        if (name == kRunInfoFile) {
            require_own_file(entry->path());
            folder.info = read_run_info(entry->path());
        }
    }
    if (error) throw InputError(fmt::format("{}: cannot be read ({})", path.string(), error.message()));
    if (folder.frames.empty()) {
        throw InputError(fmt::format(
            "{}: holds no frames (particles_NNNNNN.vtp or .pvtp); give the --output folder of a run", path.string()));
    }
    for (std::vector<FrameFile>* files : {&folder.frames, &folder.contacts}) {
        std::sort(files->begin(), files->end(), [](const FrameFile& a, const FrameFile& b) { return a.step < b.step; });
    }
    for (FrameFile& frame : folder.frames) {
        if (const auto found = moving.find(frame.step); found != moving.end()) frame.moving = found->second;
    }
    for (const auto& [index, file] : colliders) folder.colliders.push_back(file);
    require_own_files(path, folder);
    return folder;
}

bool has_incomplete_totals(const RunFolder& folder, double time) {
    if (folder.frames.empty() || folder.frames.back().step == 0) return false;
    // The last step of a run can be shorter than the time step.
    const auto steps = static_cast<double>(folder.frames.back().step - 1);
    // Local, because it bounds only the rounding error of the product of steps and time step.
    constexpr double kRounding = 1e-9;
    return time < (1.0 - kRounding) * steps * folder.info.time_step;
}

}  // namespace ricochet
