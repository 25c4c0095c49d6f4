#include "view/export/moving_meshes.h"

#include <fmt/format.h>

#include <variant>
#include <vector>

#include "ricochet/core/error.h"
#include "run/vtp_reader.h"

namespace ricochet {

std::map<std::uint32_t, TriangleMesh> read_moving_meshes(const FrameFile& file) {
    const VtkPolyData data = read_vtp(file.moving);
    const VtkArray* const numbers = find_array(data.cell_arrays, "collider");
    const auto* const of = numbers == nullptr ? nullptr : std::get_if<std::vector<std::uint32_t>>(&numbers->values);
    if (of == nullptr) throw InputError(fmt::format("{}: has no array collider", file.moving.string()));
    std::map<std::uint32_t, TriangleMesh> meshes;
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> renamed;
    for (std::size_t t = 0; t < data.triangles.size(); ++t) {
        TriangleMesh& mesh = meshes[(*of)[t]];
        auto& names = renamed[(*of)[t]];
        Triangle triangle{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t v = data.triangles[t][corner];
            const auto [name, is_new] = names.emplace(v, static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new) mesh.vertices.push_back(data.points[v]);
            triangle[corner] = name->second;
        }
        mesh.triangles.push_back(triangle);
    }
    return meshes;
}

}  // namespace ricochet
