#include "bench/load_cases.h"

#include <fmt/format.h>

#include <iterator>
#include <string>

#include "bench/case_setup.h"
#include "bench/cases.h"
#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_writer.h"

namespace ricochet::bench {
namespace {

constexpr std::size_t kFew = 20'000;
constexpr std::size_t kMany = 1'000'000;
constexpr std::size_t kMost = 5'000'000;

// The writer of the library knows PLY in its binary form only.
void write_ascii_ply(const TriangleMesh& mesh, const std::filesystem::path& path) {
    std::string text = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.vertices.size(), mesh.triangles.size());
    for (const Vec3& v : mesh.vertices) fmt::format_to(std::back_inserter(text), "{} {} {}\n", v.x, v.y, v.z);
    for (const Triangle& t : mesh.triangles) fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", t[0], t[1], t[2]);
    write_file(path, text);
}

}  // namespace

std::string_view name_of(FileForm form) {
    switch (form) {
        case FileForm::obj:
            return "OBJ";
        case FileForm::binary_ply:
            return "PLY, binary";
        case FileForm::ascii_ply:
            return "PLY, ASCII";
        case FileForm::binary_stl:
            return "STL, binary";
        case FileForm::off:
            return "OFF";
    }
    throw InputError("a benchmark case names a form of file that does not exist");
}

std::string_view ending_of(FileForm form) {
    switch (form) {
        case FileForm::obj:
            return ".obj";
        case FileForm::binary_ply:
        case FileForm::ascii_ply:
            return ".ply";
        case FileForm::binary_stl:
            return ".stl";
        case FileForm::off:
            return ".off";
    }
    throw InputError("a benchmark case names a form of file that does not exist");
}

const std::vector<LoadCase>& load_cases() {
    static const std::vector<LoadCase> cases = {
        {"obj-20k", FileForm::obj, kFew},
        {"ply-20k", FileForm::binary_ply, kFew},
        {"ascii-ply-20k", FileForm::ascii_ply, kFew},
        {"stl-20k", FileForm::binary_stl, kFew},
        {"off-20k", FileForm::off, kFew},
        {"obj-1M", FileForm::obj, kMany},
        {"ply-1M", FileForm::binary_ply, kMany},
        {"ascii-ply-1M", FileForm::ascii_ply, kMany},
        {"stl-1M", FileForm::binary_stl, kMany},
        {"off-1M", FileForm::off, kMany},
        {"ply-5M", FileForm::binary_ply, kMost},
    };
    return cases;
}

TriangleMesh make_mesh(const LoadCase& c) { return *make_mesh(Case{.triangles = c.triangles}); }

void write_form(const TriangleMesh& mesh, const std::filesystem::path& path, FileForm form) {
    if (form == FileForm::ascii_ply) {
        write_ascii_ply(mesh, path);
    } else {
        write_mesh(mesh, path);
    }
}

}  // namespace ricochet::bench
