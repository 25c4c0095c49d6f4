#include "ricochet/io/detail/scene_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/io/detail/suggestion.h"

namespace ricochet::detail {
namespace {

namespace fs = std::filesystem;

std::string nearest_file(const fs::path& path) {
    constexpr std::size_t kMostNames = 10000;
    std::error_code error;
    std::vector<std::string> names;
    for (fs::directory_iterator it(path.parent_path().empty() ? "." : path.parent_path(), error), end;
         !error && it != end && names.size() < kMostNames; it.increment(error)) {
        names.push_back(it->path().filename().string());
    }
    const std::vector<std::string_view> views(names.begin(), names.end());
    std::vector<std::string_view> nearest = nearest_names(path.filename().string(), views);
    std::sort(nearest.begin(), nearest.end());
    if (nearest.size() > 3) nearest.resize(3);
    return did_you_mean(nearest);
}

}  // namespace

std::optional<std::string> file_problem(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) {
        const std::string help = nearest_file(path);
        return fmt::format("there is no file {}{}{}", path.string(), help.empty() ? "" : ", ", help);
    }
    if (error) return fmt::format("{} cannot be reached ({})", path.string(), error.message());
    if (fs::is_directory(status)) return fmt::format("{} is a folder, expected a file", path.string());
    if (!fs::is_regular_file(status)) return fmt::format("{} is not a regular file", path.string());
    if (!std::ifstream(path)) return fmt::format("{} cannot be opened ({})", path.string(), std::strerror(errno));
    return std::nullopt;
}

std::string read_bytes(const fs::path& path, std::uint64_t largest) {
    if (const auto problem = file_problem(path)) throw InputError(*problem);
    const std::uintmax_t size = fs::file_size(path);
    if (size > largest) {
        throw InputError(fmt::format("{} has {} bytes, expected at most {}", path.string(), size, largest));
    }
    std::ifstream file(path, std::ios::binary);
    std::string bytes(size, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    if (file.gcount() != static_cast<std::streamsize>(size)) {
        throw InputError(fmt::format("{} cannot be read to its end", path.string()));
    }
    return bytes;
}

const MeshLibrary::Entry& MeshLibrary::entry(const fs::path& path) {
    std::error_code ignored;
    const auto [place, is_new] = entries_.try_emplace(fs::weakly_canonical(path, ignored));
    Entry& entry = place->second;
    if (is_new) {
        try {
            if (const auto problem = file_problem(path)) throw InputError(*problem);
            ImportedMesh imported = read_mesh(path, MeshContent::triangles);
            entry.groups = groups_of(imported);
            entry.mesh = std::make_shared<const TriangleMesh>(std::move(imported.mesh));
        } catch (const InputError& error) {
            entry.error = error.what();
        }
    }
    if (!entry.mesh) throw InputError(entry.error);
    return entry;
}

std::shared_ptr<const TriangleMesh> MeshLibrary::load(const fs::path& path) { return entry(path).mesh; }

const MeshGroups& MeshLibrary::groups(const fs::path& path) { return entry(path).groups; }

}  // namespace ricochet::detail
