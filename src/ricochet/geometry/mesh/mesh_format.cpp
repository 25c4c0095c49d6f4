#include "ricochet/geometry/mesh/mesh_format.h"

#include <string>

namespace ricochet {
namespace {

// Locale-free on purpose: file formats are ASCII.
std::string ascii_lower(std::string text) {
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return text;
}

}  // namespace

const char* mesh_format_name(MeshFormat format) {
    switch (format) {
        case MeshFormat::kObj:
            return "OBJ";
        case MeshFormat::kPly:
            return "PLY";
        case MeshFormat::kStl:
            return "STL";
        case MeshFormat::kOff:
            break;
    }
    return "OFF";
}

std::optional<MeshFormat> mesh_format_of(const std::filesystem::path& path) {
    const std::string extension = ascii_lower(path.extension().string());
    if (extension == ".obj") return MeshFormat::kObj;
    if (extension == ".ply") return MeshFormat::kPly;
    if (extension == ".stl") return MeshFormat::kStl;
    if (extension == ".off") return MeshFormat::kOff;
    return std::nullopt;
}

}  // namespace ricochet
