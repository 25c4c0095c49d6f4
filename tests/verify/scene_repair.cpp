#include <algorithm>
#include <cctype>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "support/simple_meshes.h"
#include "verify/schema_scene.h"

namespace ricochet::test {
namespace {

using Json = nlohmann::json;

/// Splits a path such as `colliders[0].scale` or `materials["a b"].friction` into keys and indices.
std::vector<std::string> parts_of(const std::string& path) {
    std::vector<std::string> parts(1);
    for (const char c : path) {
        if (c == '.' || c == '[') parts.emplace_back();
        if (c != '.' && c != '[' && c != ']' && c != '"') parts.back() += c;
    }
    std::erase(parts, "");
    return parts;
}

/// Removes the value at a path, or its nearest existing ancestor. Returns false for the scene itself.
bool remove(Json& scene, const std::vector<std::string>& parts) {
    Json* parent = nullptr;
    Json* at = &scene;
    std::string last;
    for (const std::string& part : parts) {
        Json* next = nullptr;
        if (at->is_object() && at->contains(part)) next = &(*at)[part];
        const bool is_index = !part.empty() && std::isdigit(static_cast<unsigned char>(part[0])) != 0;
        if (at->is_array() && is_index && std::stoul(part) < at->size()) next = &(*at)[std::stoul(part)];
        if (next == nullptr) break;
        parent = at;
        at = next;
        last = part;
    }
    if (parent == nullptr) return false;
    // A list that is refused as a whole loses its last item in each round.
    if (at->is_array() && at->size() > 1 && (*at)[0].is_object()) {
        at->erase(at->size() - 1);
        return true;
    }
    if (parent->is_array()) {
        parent->erase(std::stoul(last));
    } else {
        parent->erase(last);
    }
    return true;
}

/// Returns the path in a message "FILE:LINE:COLUMN: PATH: reason". For a missing value it is the owner's path.
std::string path_in(const std::string& message) {
    const std::size_t file = message.find("scene.json");
    const std::size_t begin = message.find(": ", file);
    const std::size_t end = begin == std::string::npos ? begin : message.find(": ", begin + 2);
    if (end == std::string::npos) return {};
    return message.substr(begin + 2, end - begin - 2);
}

void write_text(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }

void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh) {
    std::ofstream out(file);
    out.precision(17);
    for (const Vec3& v : mesh.vertices) out << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
    out << "usemtl side\n";
    for (const Triangle& t : mesh.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
}

/// Returns a sheet from -1 to 1 of cells^2 squares. Its corners are lifted by a fixed pattern of heights up to
/// `height`.
TriangleMesh sheet(std::uint32_t cells, double height) {
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= cells; ++j) {
        for (std::uint32_t i = 0; i <= cells; ++i) {
            const double lift = height * (static_cast<double>((7 * i + 5 * j + i * j) % 9) / 4.0 - 1.0);
            mesh.vertices.push_back({2.0 * i / cells - 1.0, 2.0 * j / cells - 1.0, lift});
        }
    }
    for (std::uint32_t j = 0; j < cells; ++j) {
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = j * (cells + 1) + i;
            mesh.triangles.push_back({a, a + 1, a + cells + 2});
            mesh.triangles.push_back({a, a + cells + 2, a + cells + 1});
        }
    }
    return mesh;
}

/// Writes the corners of a cube at three times, as a point cache of version 1.
void write_cache(const std::filesystem::path& file, const TriangleMesh& cube) {
    std::string bytes("POINTCACHE2\0", 12);
    const auto add = [&](auto value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        bytes.append(raw, sizeof value);
    };
    add(std::int32_t{1});
    add(static_cast<std::int32_t>(cube.vertices.size()));
    add(0.0F);
    add(1.0F);
    add(std::int32_t{3});
    for (int k = 0; k < 3; ++k) {
        for (const Vec3& v : cube.vertices) {
            for (int axis = 0; axis < 3; ++axis) add(static_cast<float>((1.0 + 0.1 * k * v.x) * v[axis]));
        }
    }
    std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace

std::optional<SceneDescription> accepted(Json& scene, const std::filesystem::path& folder) {
    constexpr int kMostRounds = 40;
    for (int round = 0; round < kMostRounds; ++round) {
        try {
            return parse_scene(scene.dump(), folder / "scene.json");
        } catch (const SceneError& error) {
            // Last paths are removed first, so that indices stay valid.
            std::set<std::string> paths;
            for (const std::string& message : error.messages()) paths.insert(path_in(message));
            bool helped = false;
            for (auto path = paths.rbegin(); path != paths.rend(); ++path) {
                const std::vector<std::string> parts = parts_of(*path);
                helped = (!parts.empty() && remove(scene, parts)) || helped;
            }
            if (!helped) return std::nullopt;
        }
    }
    return std::nullopt;
}

void write_scene_files(const std::filesystem::path& folder) {
    const TriangleMesh cube = testing::box_mesh({-1, -1, -1}, {1, 1, 1});
    const TriangleMesh ball = testing::sphere_mesh({0, 0, 0}, 1.0, 1);
    write_mesh(folder / "cube.obj", cube);
    write_mesh(folder / "ball.obj", ball);
    write_mesh(folder / "sheet.obj", sheet(2, 0.0));
    for (int k = 0; k < 3; ++k) {
        TriangleMesh bent = cube;
        for (Vec3& v : bent.vertices) v += 0.15 * k * Vec3{v.y * v.z, 0.5 * v.x, v.x * v.y};
        write_mesh(folder / ("cube_" + std::to_string(k) + ".obj"), bent);
    }
    write_cache(folder / "cube.pc2", cube);
    const TriangleMesh meshes[] = {
        cube,          ball,          testing::flipped(testing::sphere_mesh({0, 0, 0}, 1.0, 2)),
        sheet(4, 0.3), sheet(6, 0.0), testing::merged(cube, testing::moved(ball, {1.5, 0.25, 0}))};
    for (std::size_t k = 0; k < std::size(meshes); ++k) {
        write_mesh(folder / ("mesh_" + std::to_string(k) + ".obj"), meshes[k]);
    }
    write_text(folder / "particles.csv",
               "x,y,z,vx,vy,vz,mass,radius\n0,0,1.2,0.5,0,-2,1,0.1\n0.6,-0.3,0.4,0,1,-1,2,0\n");
    write_text(folder / "wind.vti",
               R"(<?xml version="1.0"?>
<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<ImageData WholeExtent="0 1 0 1 0 1" Origin="-2 -2 -2" Spacing="4 4 4"><Piece Extent="0 1 0 1 0 1">
<PointData Vectors="velocity"><DataArray type="Float64" Name="velocity" NumberOfComponents="3" format="ascii">
0 0 1 0.5 -1 1 1 -2 1 1.5 -1 1 2 0 1 1 -1 0.5 0 -3 1 -1 1 0</DataArray></PointData></Piece></ImageData></VTKFile>
)");
}

}  // namespace ricochet::test
