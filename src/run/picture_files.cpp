#include "run/picture_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "ricochet/core/atomic_file.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/io/scene/files.h"

namespace ricochet {
namespace {

/// Largest PNG file of a sprite, in bytes.
constexpr std::uint64_t kLargestSpriteFile = std::uint64_t{64} << 20;

std::string obj_text(const TriangleMesh& mesh) {
    std::string text = "# Mesh of a drawn particle, written by ricochet.\n";
    for (const Vec3& v : mesh.vertices) {
        fmt::format_to(std::back_inserter(text), "v {:.17g} {:.17g} {:.17g}\n", v.x, v.y, v.z);
    }
    for (const Triangle& t : mesh.triangles) {
        fmt::format_to(std::back_inserter(text), "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    return text;
}

}  // namespace

bool is_picture_file(std::string_view name, const std::filesystem::path& file) {
    const std::string start = file.stem().string();
    const std::string end = file.extension().string();
    if (!name.starts_with(start) || !name.ends_with(end) || name.size() < start.size() + end.size()) return false;
    const std::string_view middle = name.substr(start.size(), name.size() - start.size() - end.size());
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    return middle.empty() ||
           (middle.size() > 1 && middle[0] == '_' && std::all_of(middle.begin() + 1, middle.end(), is_digit));
}

void keep_picture_files(const std::filesystem::path& folder, ParticleDrawingDescription& drawing, std::size_t number) {
    const auto named = [&](const std::filesystem::path& file) {
        if (number == 0) return file.string();
        return fmt::format("{}_{}{}", file.stem().string(), number, file.extension().string());
    };
    if (!drawing.sprite.empty()) {
        const std::string name = named(kParticleSpriteFile);
        write_file(folder / name, detail::read_bytes(drawing.sprite, kLargestSpriteFile));
        drawing.sprite = name;
    }
    if (!drawing.mesh.empty()) {
        const std::string name = named(kParticleMeshFile);
        write_file(folder / name, obj_text(read_mesh(drawing.mesh, MeshContent::triangles).mesh));
        drawing.mesh = name;
    }
}

}  // namespace ricochet
