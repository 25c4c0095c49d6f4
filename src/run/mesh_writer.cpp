#include "run/mesh_writer.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string_view>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_reader.h"

namespace ricochet {
namespace {

static_assert(std::endian::native == std::endian::little, "the binary writers copy little-endian memory");

template <typename... Values>
void text(AtomicFile& out, fmt::format_string<const Values&...> form, const Values&... values) {
    fmt::memory_buffer piece;
    fmt::format_to(std::back_inserter(piece), form, values...);
    out.write({piece.data(), piece.size()});
}

template <typename Value>
void binary(AtomicFile& out, const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    out.write({reinterpret_cast<const char*>(&value), sizeof value});
}

void write_obj(const TriangleMesh& mesh, AtomicFile& out) {
    for (const Vec3& v : mesh.vertices) text(out, "v {} {} {}\n", v.x, v.y, v.z);
    for (const Triangle& t : mesh.triangles) text(out, "f {} {} {}\n", t[0] + 1ULL, t[1] + 1ULL, t[2] + 1ULL);
}

void write_off(const TriangleMesh& mesh, AtomicFile& out) {
    text(out, "OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
    for (const Vec3& v : mesh.vertices) text(out, "{} {} {}\n", v.x, v.y, v.z);
    for (const Triangle& t : mesh.triangles) text(out, "3 {} {} {}\n", t[0], t[1], t[2]);
}

void write_ply(const TriangleMesh& mesh, AtomicFile& out) {
    text(out,
         "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
         "property double z\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
         mesh.vertices.size(), mesh.triangles.size());
    for (const Vec3& v : mesh.vertices) {
        for (int axis = 0; axis < 3; ++axis) binary(out, v[axis]);
    }
    for (const Triangle& t : mesh.triangles) {
        binary(out, std::uint8_t{3});
        binary(out, t);
    }
}

void write_stl_vector(const Vec3& v, const std::filesystem::path& path, AtomicFile& out) {
    if (!(max_abs(v) <= static_cast<double>(std::numeric_limits<float>::max()))) {
        throw InputError(fmt::format("{}: coordinate {} does not fit STL's single precision, write OBJ or PLY instead",
                                     path.string(), max_abs(v)));
    }
    for (int axis = 0; axis < 3; ++axis) binary(out, static_cast<float>(v[axis]));
}

void write_stl(const TriangleMesh& mesh, const std::filesystem::path& path, AtomicFile& out) {
    if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
        throw InputError(fmt::format("{}: more than 4294967295 triangles do not fit an STL file", path.string()));
    }
    std::array<char, 80> title{};
    constexpr std::string_view kTitle = "binary STL written by ricochet";
    kTitle.copy(title.data(), kTitle.size());
    binary(out, title);
    binary(out, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        const Vec3& b = mesh.vertices[t[1]];
        const Vec3& c = mesh.vertices[t[2]];
        const Vec3 area = cross(b - a, c - a);
        const double size = length(area);
        write_stl_vector(size > 0.0 && std::isfinite(size) ? area / size : Vec3{}, path, out);
        for (const Vec3* corner : {&a, &b, &c}) write_stl_vector(*corner, path, out);
        binary(out, std::uint16_t{0});
    }
}

}  // namespace

void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& path) {
    const std::optional<MeshFormat> format = mesh_format_of(path);
    if (!format) {
        throw InputError(
            fmt::format("{}: unknown mesh format, the name must end in .obj, .ply, .stl or .off", path.string()));
    }
    if (format == MeshFormat::kGltf || format == MeshFormat::kForeign) {
        throw InputError(
            fmt::format("{}: files of this format are read only, expected a name that ends in .obj, .ply, .stl or .off",
                        path.string()));
    }
    AtomicFile out(path);
    if (format == MeshFormat::kObj) write_obj(mesh, out);
    if (format == MeshFormat::kPly) write_ply(mesh, out);
    if (format == MeshFormat::kStl) write_stl(mesh, path, out);
    if (format == MeshFormat::kOff) write_off(mesh, out);
    out.commit();
}

}  // namespace ricochet
