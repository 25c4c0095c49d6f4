#include "python/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "python/arrays.h"
#include "python/gil.h"
#include "python/merged_vertices.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/queries/mesh_queries.h"

namespace ricochet::python {
namespace {

/// Returns the text of an object on one line, cut after 60 characters.
std::string one_line(const py::object& object) {
    constexpr std::size_t kMost = 60;
    std::string text;
    for (const char letter : std::string(py::repr(object))) {
        if (letter == '\n') continue;
        if (text.size() == kMost) return text + "...";
        text += letter;
    }
    return text;
}

/// Returns true for a list that contains True or False, because NumPy would convert them to numbers.
bool has_flag(const py::object& list) {
    if (!py::isinstance<py::sequence>(list)) return false;
    return std::any_of(list.begin(), list.end(),
                       [](const py::handle& entry) { return PyBool_Check(entry.ptr()) != 0; });
}

/// Returns the scale factors along x, y and z. As in scenes, `scale` is one number or three numbers, and a negative
/// factor mirrors.
Vec3 factors_of(const py::object& scale) {
    constexpr const char* kExpected = "expected a finite number other than 0, such as 0.001 for mm, or three";
    std::optional<Vec3> factors;
    try {
        const py::array array = py::module_::import("numpy").attr("asarray")(scale);
        const bool holds_numbers =
            array.dtype().kind() == 'f' || array.dtype().kind() == 'i' || array.dtype().kind() == 'u';
        if (holds_numbers && !has_flag(scale) && array.ndim() <= 1) {
            const Doubles numbers = py::cast<Doubles>(array);
            const std::span<const double> list = values(numbers);
            if (array.ndim() == 0) factors = Vec3{list[0], list[0], list[0]};
            if (array.ndim() == 1 && list.size() == 3) factors = Vec3{list[0], list[1], list[2]};
        }
    } catch (const py::error_already_set&) {
        factors.reset();  // the nested lists have different lengths
    }
    const bool is_good = factors && is_finite(*factors) && factors->x != 0.0 && factors->y != 0.0 && factors->z != 0.0;
    if (!is_good) throw InputError(fmt::format("scale: found {}, {}", one_line(scale), kExpected));
    return *factors;
}

/// Returns the distance within which vertices are joined, in m, or nothing for None.
std::optional<double> distance_of(const py::object& merge) {
    if (merge.is_none()) return std::nullopt;
    const bool is_number = !PyBool_Check(merge.ptr()) && PyNumber_Check(merge.ptr()) != 0;
    const double distance = is_number ? PyFloat_AsDouble(merge.ptr()) : -1.0;
    if (PyErr_Occurred() != nullptr) PyErr_Clear();
    if (!(distance >= 0.0)) {
        throw InputError(
            fmt::format("merge: found {}, expected a distance of at least 0 in m, or None", one_line(merge)));
    }
    return distance;
}

/// Rotates the up axis first and then scales, as scenes do.
void place(ImportedMesh& imported, const std::optional<std::string>& up, const Vec3& scale) {
    const bool turns_up = up == "y" && !imported.y_up;
    const bool turns_back = up == "z" && imported.y_up;
    for (Vec3& vertex : imported.mesh.vertices) {
        if (turns_up) vertex = y_up_as_z_up(vertex);
        if (turns_back) vertex = z_up_as_y_up(vertex);
        vertex = {scale.x * vertex.x, scale.y * vertex.y, scale.z * vertex.z};
    }
    const bool mirrors = (scale.x < 0.0) != ((scale.y < 0.0) != (scale.z < 0.0));
    for (Triangle& triangle : imported.mesh.triangles) {
        if (mirrors) std::swap(triangle[1], triangle[2]);
    }
}

/// Returns, for each triangle, the index of its combination of names in PolygonMesh::groups. Returns an empty list if
/// the file has no names.
std::vector<std::uint32_t> group_numbers(const ImportedMesh& imported) {
    std::vector<std::uint32_t> numbers;
    if (imported.polygons.face_groups.empty()) return numbers;
    numbers.reserve(imported.triangle_face.size());
    for (const std::uint32_t face : imported.triangle_face) numbers.push_back(imported.polygons.face_groups[face]);
    return numbers;
}

/// Sets the names of a mesh's triangles from the names of faces in its file.
void take_names(const py::object& mesh, const PolygonMesh& polygons, std::vector<std::uint32_t>&& numbers) {
    if (numbers.empty()) return;
    const auto text = [&](std::uint32_t name) {
        const std::string& bytes = polygons.group_names[name];
        return py::reinterpret_steal<py::object>(
            PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "surrogateescape"));
    };
    py::list materials;
    py::list groups;
    py::list objects;
    for (const FaceGroup& names : polygons.groups) {
        materials.append(text(names.material));
        groups.append(text(names.group));
        objects.append(text(names.object));
    }
    py::module_::import("ricochet._mesh")
        .attr("_take_names")(mesh, given(std::move(numbers)), materials, groups, objects);
}

}  // namespace

MeshObject read_named_mesh(const std::filesystem::path& file, const std::optional<std::string>& up,
                           const py::object& scale, const py::object& merge) {
    if (up && *up != "y" && *up != "z") {
        throw InputError(fmt::format("up: found \"{}\", expected \"y\", \"z\" or None (as the format says)", *up));
    }
    const Vec3 factors = factors_of(scale);
    const std::optional<double> within = distance_of(merge);
    ImportedMesh imported;
    std::optional<MeshQueries> queries;
    {
        const Unlocked unlocked;
        imported = read_mesh(file.string());
        place(imported, up, factors);
        if (within) imported.mesh = merged_within(imported.mesh, *within);
        queries.emplace(std::move(imported.mesh));
    }
    const py::object mesh = py::cast(std::move(*queries));
    take_names(mesh, imported.polygons, group_numbers(imported));
    return mesh;
}

}  // namespace ricochet::python
