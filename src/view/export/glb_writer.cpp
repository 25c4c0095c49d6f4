#include "view/export/glb_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/box3.h"
#include "ricochet/core/error.h"
#include "view/export/append_bytes.h"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

// Constants of the format, equal to the OpenGL enums.
constexpr int kFloat = 5126;
constexpr int kUint32 = 5125;
constexpr int kVertexBuffer = 34962;
constexpr int kIndexBuffer = 34963;
constexpr int kPoints = 0;

constexpr double kGlassAlpha = 0.25;

Vec3 y_up(const Vec3& p) { return {p.x, p.z, -p.y}; }
Json list_of(const Vec3& v) { return {v.x, v.y, v.z}; }

// Returns the mesh of the unit sphere that represents a particle, with outward triangle normals. The mesh is coarse,
// because programs may draw thousands of copies.
TriangleMesh coarse_ball() {
    constexpr std::uint32_t kSides = 12;
    constexpr std::uint32_t kBelts = 6;
    TriangleMesh ball;
    ball.vertices = {{0, 0, -1}, {0, 0, 1}};
    for (std::uint32_t belt = 1; belt < kBelts; ++belt) {
        const double polar = std::numbers::pi * belt / kBelts;
        for (std::uint32_t side = 0; side < kSides; ++side) {
            const double angle = 2.0 * std::numbers::pi * side / kSides;
            ball.vertices.push_back(
                {std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), -std::cos(polar)});
        }
    }
    const auto at = [](std::uint32_t belt, std::uint32_t side) { return 2 + (belt - 1) * kSides + side % kSides; };
    for (std::uint32_t side = 0; side < kSides; ++side) {
        ball.triangles.push_back({0, at(1, side + 1), at(1, side)});
        for (std::uint32_t belt = 1; belt + 1 < kBelts; ++belt) {
            ball.triangles.push_back({at(belt, side), at(belt, side + 1), at(belt + 1, side + 1)});
            ball.triangles.push_back({at(belt, side), at(belt + 1, side + 1), at(belt + 1, side)});
        }
        ball.triangles.push_back({1, at(kBelts - 1, side), at(kBelts - 1, side + 1)});
    }
    return ball;
}

// Removes vertices that belong to no triangle. The mesh of a cloth has all particles of its frame as vertices. Distant
// particles outside the cloth would shift the centre, and the coordinates relative to it would lose precision.
TriangleMesh without_loose_vertices(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> numbers(mesh.vertices.size(), 0);
    for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) numbers[corner] = 1;
    }
    TriangleMesh kept;
    for (std::size_t v = 0; v < numbers.size(); ++v) {
        if (numbers[v] == 0) continue;
        numbers[v] = static_cast<std::uint32_t>(kept.vertices.size());
        kept.vertices.push_back(mesh.vertices[v]);
    }
    for (const Triangle& triangle : mesh.triangles) {
        kept.triangles.push_back({numbers[triangle[0]], numbers[triangle[1]], numbers[triangle[2]]});
    }
    return kept;
}

// Builds the JSON document and the binary data of a file.
class GlbBuilder {
public:
    explicit GlbBuilder(const std::filesystem::path& path) : path_(path) {
        document_["asset"] = {{"version", "2.0"}, {"generator", "ricochet"}};
        document_["scene"] = 0;
        document_["scenes"] = Json::array({Json::object()});
    }

    void add(const GlbMesh& mesh) {
        if (mesh.mesh.triangles.empty()) return;
        const TriangleMesh shown = without_loose_vertices(mesh.mesh);
        const Vec3 middle = middle_of(shown.vertices);
        Json primitive;
        primitive["attributes"]["POSITION"] = add_points(shown.vertices, middle);
        primitive["indices"] = add_indices(shown.triangles);
        primitive["material"] = add_material(mesh);
        add_node(mesh.name, add_mesh(mesh.name, std::move(primitive)), middle);
    }

    void add_particles(const std::vector<Vec3>& points) {
        if (points.empty()) return;
        const Vec3 middle = middle_of(points);
        Json primitive;
        primitive["attributes"]["POSITION"] = add_points(points, middle);
        primitive["mode"] = kPoints;
        add_node("particles", add_mesh("particles", std::move(primitive)), middle);
    }

    void add_spheres(const std::vector<GlbSphere>& spheres) {
        if (spheres.empty()) return;
        const TriangleMesh ball = coarse_ball();
        Json primitive;
        const std::size_t points = add_points(ball.vertices, {});
        primitive["attributes"]["POSITION"] = points;
        primitive["attributes"]["NORMAL"] = points;  // equal to the positions, because the sphere has unit radius
        primitive["indices"] = add_indices(ball.triangles);
        primitive["material"] = add_material({.name = "particles", .mesh = {}, .color = {}});
        const std::size_t mesh = add_mesh("particle", std::move(primitive));
        for (const GlbSphere& sphere : spheres) {
            add_node("particle", mesh, sphere.center);
            document_["nodes"].back()["scale"] = {sphere.radius, sphere.radius, sphere.radius};
        }
    }

    // Returns the header with the JSON chunk, and the data of the binary chunk.
    [[nodiscard]] std::array<std::string, 2> finish() {
        if (!body_.empty()) document_["buffers"] = Json::array({{{"byteLength", body_.size()}}});
        std::string json = document_.dump(-1, ' ', false, Json::error_handler_t::replace);
        json.resize((json.size() + 3) / 4 * 4, ' ');
        const std::size_t total = 12 + 8 + json.size() + (body_.empty() ? 0 : 8 + body_.size());
        if (total > std::numeric_limits<std::uint32_t>::max()) {
            throw InputError(fmt::format("{}: {} bytes do not fit a glTF file, expected less than 4 GB: export as PLY",
                                         path_.string(), total));
        }
        std::string head = "glTF";
        append_bytes(head, std::uint32_t{2});
        append_bytes(head, static_cast<std::uint32_t>(total));
        append_bytes(head, static_cast<std::uint32_t>(json.size()));
        head += "JSON" + json;
        if (!body_.empty()) {
            append_bytes(head, static_cast<std::uint32_t>(body_.size()));
            head += std::string("BIN\0", 4);
        }
        return {std::move(head), std::move(body_)};
    }

private:
    static Vec3 middle_of(const std::vector<Vec3>& points) {
        Box3 box;
        for (const Vec3& point : points) box.include(point);
        return box.center();
    }

    std::size_t add_view(std::size_t begin, int target) {
        Json& views = document_["bufferViews"];
        views.push_back(
            {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", body_.size() - begin}, {"target", target}});
        return views.size() - 1;
    }

    std::size_t add_points(const std::vector<Vec3>& points, const Vec3& middle) {
        constexpr double kMost = std::numeric_limits<float>::max();
        const std::size_t begin = body_.size();
        Box3 box;
        for (const Vec3& point : points) {
            const Vec3 p = y_up(point - middle);
            if (!is_finite(p) || max_abs(p) > kMost) {
                throw InputError(fmt::format("{}: the point ({}, {}, {}) does not fit the single precision of glTF",
                                             path_.string(), point.x, point.y, point.z));
            }
            const std::array<float, 3> narrow{static_cast<float>(p.x), static_cast<float>(p.y),
                                              static_cast<float>(p.z)};
            append_bytes(body_, narrow);
            box.include({narrow[0], narrow[1], narrow[2]});
        }
        const std::size_t view = add_view(begin, kVertexBuffer);
        document_["accessors"].push_back({{"bufferView", view},
                                          {"componentType", kFloat},
                                          {"count", points.size()},
                                          {"type", "VEC3"},
                                          {"min", list_of(box.lower)},
                                          {"max", list_of(box.upper)}});
        return document_["accessors"].size() - 1;
    }

    std::size_t add_indices(const std::vector<Triangle>& triangles) {
        const std::size_t begin = body_.size();
        for (const Triangle& triangle : triangles) append_bytes(body_, triangle);
        const std::size_t view = add_view(begin, kIndexBuffer);
        document_["accessors"].push_back(
            {{"bufferView", view}, {"componentType", kUint32}, {"count", 3 * triangles.size()}, {"type", "SCALAR"}});
        return document_["accessors"].size() - 1;
    }

    // Sets a non-metallic, two-sided material, because the format's defaults are metallic and one-sided.
    std::size_t add_material(const GlbMesh& mesh) {
        Json surface = {{"metallicFactor", 0.0}, {"roughnessFactor", mesh.roughness}};
        if (mesh.color || mesh.glass) {
            const Vec3 color = mesh.color.value_or(Vec3{1, 1, 1});
            surface["baseColorFactor"] = {std::clamp(color.x, 0.0, 1.0), std::clamp(color.y, 0.0, 1.0),
                                          std::clamp(color.z, 0.0, 1.0), mesh.glass ? kGlassAlpha : 1.0};
        }
        Json material = {{"name", mesh.name}, {"pbrMetallicRoughness", surface}, {"doubleSided", true}};
        if (mesh.glass) material["alphaMode"] = "BLEND";
        document_["materials"].push_back(std::move(material));
        return document_["materials"].size() - 1;
    }

    std::size_t add_mesh(const std::string& name, Json primitive) {
        document_["meshes"].push_back({{"name", name}, {"primitives", Json::array({std::move(primitive)})}});
        return document_["meshes"].size() - 1;
    }

    void add_node(const std::string& name, std::size_t mesh, const Vec3& placement) {
        Json& nodes = document_["nodes"];
        document_["scenes"][0]["nodes"].push_back(nodes.size());
        nodes.push_back({{"name", name}, {"mesh", mesh}, {"translation", list_of(y_up(placement))}});
    }

    std::filesystem::path path_;
    Json document_;
    std::string body_;
};

}  // namespace

std::uint64_t write_glb(const std::filesystem::path& path, const GlbScene& scene) {
    AtomicFile file(path);
    GlbBuilder builder(path);
    for (const GlbMesh& mesh : scene.meshes) builder.add(mesh);
    builder.add_particles(scene.points);
    builder.add_spheres(scene.spheres);
    const auto [head, body] = builder.finish();
    file.write(head);
    file.write(body);
    file.commit();
    return head.size() + body.size();
}

}  // namespace ricochet
