/// \file
/// Small glTF files for tests.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/mesh_files.h"
#include "ricochet/core/vec3.h"

namespace ricochet::test {

using Json = nlohmann::json;

/// A glTF document and the bytes of its only buffer.
struct GltfFile {
    Json document;
    std::string binary;
};

/// Adds an accessor for these bytes, with a separate buffer view. Returns the index of the accessor.
inline std::size_t add_accessor(GltfFile& file, const std::string& bytes, int component_type, std::size_t count,
                                const std::string& type) {
    Json& document = file.document;
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", file.binary.size()}, {"byteLength", bytes.size()}});
    document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                     {"componentType", component_type},
                                     {"count", count},
                                     {"type", type}});
    file.binary += bytes;
    document["buffers"] = Json::array({{{"byteLength", file.binary.size()}}});
    return document["accessors"].size() - 1;
}

inline std::string float_bytes(const std::vector<Vec3>& points) {
    BinaryText bytes;
    for (const Vec3& p : points) {
        bytes.add<float>({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    return bytes.bytes();
}

template <typename Index>
std::string index_bytes(const std::vector<std::uint32_t>& indices) {
    BinaryText bytes;
    for (const std::uint32_t i : indices) bytes.add<Index>({static_cast<Index>(i)});
    return bytes.bytes();
}

/// Returns a file with one node, whose mesh has these points and 16-bit indices.
inline GltfFile gltf_of(const std::vector<Vec3>& points, const std::vector<std::uint32_t>& indices) {
    GltfFile file;
    file.document = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {}}]}]})");
    Json& primitive = file.document["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = add_accessor(file, float_bytes(points), 5126, points.size(), "VEC3");
    primitive["indices"] = add_accessor(file, index_bytes<std::uint16_t>(indices), 5123, indices.size(), "SCALAR");
    return file;
}

/// Corners of a cube with edge length 1 centred at the origin. The triangles in kCubeTriangles are wound outward.
inline const std::array<Vec3, 8> kCubeCorners = {Vec3{-0.5, -0.5, -0.5}, Vec3{0.5, -0.5, -0.5}, Vec3{-0.5, 0.5, -0.5},
                                                 Vec3{0.5, 0.5, -0.5},   Vec3{-0.5, -0.5, 0.5}, Vec3{0.5, -0.5, 0.5},
                                                 Vec3{-0.5, 0.5, 0.5},   Vec3{0.5, 0.5, 0.5}};
inline constexpr std::array<std::array<std::uint32_t, 3>, 12> kCubeTriangles = {{{0, 2, 3},
                                                                                 {0, 3, 1},
                                                                                 {4, 5, 7},
                                                                                 {4, 7, 6},
                                                                                 {0, 1, 5},
                                                                                 {0, 5, 4},
                                                                                 {2, 6, 7},
                                                                                 {2, 7, 3},
                                                                                 {0, 4, 6},
                                                                                 {0, 6, 2},
                                                                                 {1, 3, 7},
                                                                                 {1, 7, 5}}};

/// Returns a file of the cube. As in files of common exporters, every triangle has separate points. Two nested nodes
/// scale the mesh by (2, 1, 4), rotate it by a quarter turn about z and move it by (1, 2, 3).
inline GltfFile gltf_cube() {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> indices;
    for (const auto& triangle : kCubeTriangles) {
        for (const std::uint32_t corner : triangle) {
            indices.push_back(static_cast<std::uint32_t>(points.size()));
            points.push_back(kCubeCorners[corner]);
        }
    }
    GltfFile file = gltf_of(points, indices);
    file.document["nodes"] = Json::parse(R"([
        {"name": "crate", "translation": [1, 2, 3], "rotation": [0, 0, 0.70710677, 0.70710677], "children": [1]},
        {"scale": [2, 1, 4], "mesh": 0}])");
    file.document["meshes"][0]["name"] = "cube mesh";
    file.document["materials"] = Json::array({{{"name", "steel"}}});
    file.document["meshes"][0]["primitives"][0]["material"] = 0;
    return file;
}

/// Returns the position of a corner of gltf_cube(), with z up.
inline Vec3 corner_of_gltf_cube(std::uint32_t corner) {
    const Vec3 p = kCubeCorners[corner];
    const Vec3 placed{-p.y + 1.0, 2.0 * p.x + 2.0, 4.0 * p.z + 3.0};
    return {placed.x, -placed.z, placed.y};
}

/// Returns the bytes of a GLB file.
inline std::string glb_of(const GltfFile& file) {
    std::string json = file.document.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string binary = file.binary;
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    BinaryText bytes("glTF");
    bytes.add<std::uint32_t>({2, static_cast<std::uint32_t>(28 + json.size() + binary.size()),
                              static_cast<std::uint32_t>(json.size()), 0x4e4f534a});
    const std::string head = bytes.bytes() + json;
    BinaryText chunk;
    chunk.add<std::uint32_t>({static_cast<std::uint32_t>(binary.size()), 0x004e4942});
    return head + chunk.bytes() + binary;
}

inline std::string base64_of(const std::string& bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits = bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63U];
    }
    return text;
}

/// Returns the text of a .gltf file with an embedded buffer.
inline std::string gltf_text(GltfFile file) {
    file.document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64_of(file.binary);
    return file.document.dump();
}

/// Returns the text of a .gltf file whose buffer is the file with the given name.
inline std::string gltf_text(GltfFile file, const std::string& buffer) {
    file.document["buffers"][0]["uri"] = buffer;
    return file.document.dump();
}

}  // namespace ricochet::test
