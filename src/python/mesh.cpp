// ricochet.Mesh: exact queries on a mesh.
#include <fmt/format.h>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "python/arrays.h"
#include "python/ctrl_c.h"
#include "python/gil.h"
#include "python/help_texts.h"
#include "python/made_objects.h"
#include "python/mesh_file.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/mesh/triangulation.h"
#include "ricochet/queries/mesh_queries.h"
#include "ricochet/queries/placed_mesh.h"

namespace ricochet::python {
namespace {

TriangleMesh mesh_of(const py::handle& vertices, const py::handle& faces) {
    const Doubles positions = numbers(vertices, "vertices", 3);
    const auto corners = whole_numbers(faces, "faces", 3);
    TriangleMesh mesh;
    mesh.vertices.assign(points(positions).begin(), points(positions).end());
    mesh.triangles.resize(corners.size() / 3);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        mesh.triangles[k / 3][k % 3] = static_cast<std::uint32_t>(corners[k]);
    }
    return mesh;
}

AffineMap map_of(const py::object& transform) {
    const auto is_matrix = [&] {
        try {
            const py::tuple shape = py::module_::import("numpy").attr("shape")(transform);
            return shape.equal(py::make_tuple(4, 4));
        } catch (const py::error_already_set&) {
            return false;  // the rows have different lengths
        }
    };
    if (!is_matrix()) throw InputError("transform: expected a matrix of shape (4, 4)");
    const Doubles m = numbers(transform, "transform", 4);
    const std::span<const double> rows = values(m);
    if (rows.size() != 16 || rows[12] != 0.0 || rows[13] != 0.0 || rows[14] != 0.0 || rows[15] != 1.0) {
        throw InputError("transform: expected a matrix of shape (4, 4) whose last row is 0, 0, 0, 1");
    }
    return {{rows[0], rows[1], rows[2]},
            {rows[4], rows[5], rows[6]},
            {rows[8], rows[9], rows[10]},
            {rows[3], rows[7], rows[11]}};
}

/// Stores names of triangles in the object's dictionary. names: one name for each triangle, or None. Throws InputError
/// for other values.
void set_names(const py::object& mesh, const char* kind, const py::object& names) {
    const auto count = py::cast<const MeshQueries&>(mesh).mesh().triangles.size();
    py::module_::import("ricochet._mesh").attr("_set_names")(mesh, count, kind, names);
}

py::object names_of(const py::object& mesh, const char* kind) {
    require_made(mesh);
    return mesh.attr("__dict__").attr("get")(kind);
}

template <class Type>
void bind_names(Type& type, const char* kind, const char* text) {
    type.def_property(
        kind, [kind](const py::object& mesh) { return names_of(mesh, kind); },
        [kind](const py::object& mesh, const py::object& names) { set_names(mesh, kind, names); }, text);
}

/// Cuts polygons into triangles. The corners of face i are at the indices offsets[i] to offsets[i + 1] of `corners`,
/// without the last.
py::array triangulated(const py::object& vertices, const py::object& offsets, const py::object& corners) {
    const Doubles positions = numbers(vertices, "points", 3);
    const auto narrow = [](const std::vector<std::uint64_t>& list) {
        return std::vector<std::uint32_t>(list.begin(), list.end());
    };
    PolygonMesh polygons;
    polygons.vertices.assign(points(positions).begin(), points(positions).end());
    polygons.face_offsets = narrow(whole_numbers(offsets, "offsets", 0));
    polygons.corners = narrow(whole_numbers(corners, "corners", 0));
    for (const std::uint32_t corner : polygons.corners) require_index(corner, polygons.vertices.size(), "cells");
    const auto cut = std::make_shared<Triangulation>(CtrlC().run(false, [&] { return triangulate(polygons); }));
    const auto& triangles = cut->triangles;
    return array_over(reinterpret_cast<const std::uint32_t*>(triangles.data()), 3 * triangles.size(), cut)
        .attr("reshape")(-1, 3);
}

/// Largest number of queries that run as a single block on one thread.
constexpr py::ssize_t kFewQueries = 256;

/// Makes `count` queries while other Python threads run. Ctrl-C ends the queries. Uses a copy of the mesh, so that
/// another thread may call set_vertices() meanwhile. transform: placement of the mesh, or None.
template <class Query>
auto run_queries(const MeshQueries& mesh, py::ssize_t count, const py::object& transform, const Query& query) {
    const auto run = [&](const auto& queries) {
        return CtrlC().run(count <= kFewQueries, [&] { return query(queries); });
    };
    return transform.is_none() ? run(MeshQueries(mesh)) : run(PlacedMesh(mesh, map_of(transform)));
}

py::object result(const char* name) { return py::module_::import("ricochet._results").attr(name); }

HitsObject hits_of(MeshHits&& hits) {
    return result("Hits")(given(std::move(hits.triangle)), given(std::move(hits.distance)),
                          given(std::move(hits.point)));
}

/// Rays from Python arguments.
struct Rays {
    Doubles origins;
    Doubles directions;
    Doubles most;

    Rays(const py::handle& from, const py::handle& along, const py::handle& reach)
        : origins(vectors(from, "origins")),
          directions(vectors(along, "directions")),
          most(numbers_or_one(reach, "most")) {
        repeat_one(origins, directions, "origins");
        repeat_one(directions, origins, "directions");
    }
    [[nodiscard]] py::ssize_t count() const { return origins.shape(0); }
    [[nodiscard]] RayBatch batch() const { return {points(origins), points(directions), values(most)}; }
};

HitsObject first_hits(const MeshQueries& mesh, const py::object& origins, const py::object& directions,
                      const py::object& most, const py::object& transform) {
    const Rays rays(origins, directions, most);
    const RayBatch batch = rays.batch();
    return hits_of(run_queries(mesh, rays.count(), transform, [&](const auto& m) { return m.first_hits(batch); }));
}

/// Returns AllHits, and one flag for each hit. The flag is true if the ray lies in the plane of every triangle that it
/// hits at this point.
py::tuple all_hits_and_planes(const MeshQueries& mesh, const py::object& origins, const py::object& directions,
                              const py::object& most, const py::object& transform) {
    const Rays rays(origins, directions, most);
    const RayBatch batch = rays.batch();
    std::vector<std::int64_t> ray;
    AllMeshHits all = run_queries(mesh, rays.count(), transform, [&](const auto& m) {
        AllMeshHits found = m.all_hits(batch);
        ray.reserve(found.first.back());
        for (std::size_t i = 0; i + 1 < found.first.size(); ++i) {
            ray.insert(ray.end(), found.first[i + 1] - found.first[i], static_cast<std::int64_t>(i));
        }
        return found;
    });
    const py::object hits = result("AllHits")(given(std::move(ray)), given(std::move(all.hits.triangle)),
                                              given(std::move(all.hits.distance)), given(std::move(all.hits.point)),
                                              given(std::move(all.crossing)), given(std::move(all.first)));
    return py::make_tuple(hits, given_flags(std::move(all.in_plane)));
}

AllHitsObject all_hits(const MeshQueries& mesh, const py::object& origins, const py::object& directions,
                       const py::object& most, const py::object& transform) {
    return py::object(all_hits_and_planes(mesh, origins, directions, most, transform)[0]);
}

py::array count_hits(const MeshQueries& mesh, const py::object& origins, const py::object& directions,
                     const py::object& most, const py::object& transform) {
    const Rays rays(origins, directions, most);
    const RayBatch batch = rays.batch();
    return given(run_queries(mesh, rays.count(), transform, [&](const auto& m) { return m.count_hits(batch); }));
}

py::array occluded(const MeshQueries& mesh, const py::object& origins, const py::object& directions,
                   const py::object& most, const py::object& transform) {
    const Rays rays(origins, directions, most);
    const RayBatch batch = rays.batch();
    return given_flags(run_queries(mesh, rays.count(), transform, [&](const auto& m) { return m.occluded(batch); }));
}

InsideRule rule_named(const std::string& name) {
    if (name == "parity") return InsideRule::parity;
    if (name == "winding") return InsideRule::winding;
    throw InputError(fmt::format("rule: found \"{}\", expected \"parity\" or \"winding\"", name));
}

py::array inside(const MeshQueries& mesh, const py::object& where, const std::string& rule,
                 const py::object& transform) {
    const Doubles places = numbers(where, "points", 3);
    const InsideRule chosen = rule_named(rule);
    return given_flags(
        run_queries(mesh, places.shape(0), transform, [&](const auto& m) { return m.inside(points(places), chosen); }));
}

py::array winding_numbers(const MeshQueries& mesh, const py::object& where, const py::object& transform) {
    const Doubles places = numbers(where, "points", 3);
    return given(run_queries(mesh, places.shape(0), transform,
                             [&](const auto& m) { return m.winding_numbers(points(places)); }));
}

HitsObject closest_points(const MeshQueries& mesh, const py::object& where, double within,
                          const py::object& transform) {
    const Doubles places = numbers(where, "points", 3);
    NearestPoints found = run_queries(mesh, places.shape(0), transform,
                                      [&](const auto& m) { return m.closest_points(points(places), within); });
    return result("Hits")(given(std::move(found.triangle)), given(std::move(found.distance)),
                          given(std::move(found.point)));
}

py::array signed_distances(const MeshQueries& mesh, const py::object& where, const std::string& rule,
                           const py::object& transform) {
    const Doubles places = numbers(where, "points", 3);
    const InsideRule chosen = rule_named(rule);
    return given(run_queries(mesh, places.shape(0), transform,
                             [&](const auto& m) { return m.signed_distances(points(places), chosen); }));
}

HitsObject sweep(const MeshQueries& mesh, const py::object& from, const py::object& to, const py::object& radius,
                 const py::object& vertices_after, const py::object& transform) {
    Doubles starts = vectors(from, "from_points");
    Doubles ends = vectors(to, "to_points");
    repeat_one(starts, ends, "from_points");
    repeat_one(ends, starts, "to_points");
    const Doubles radii = numbers_or_one(radius, "radius");
    if (vertices_after.is_none()) {
        return hits_of(run_queries(mesh, starts.shape(0), transform, [&](const auto& m) {
            return m.sweep(points(starts), points(ends), values(radii));
        }));
    }
    const Doubles after = numbers(vertices_after, "vertices_after", 3);
    return hits_of(run_queries(mesh, starts.shape(0), transform, [&](const auto& m) {
        return m.sweep_moving(points(starts), points(ends), values(radii), points(after));
    }));
}

void set_vertices(MeshQueries& mesh, const py::object& vertices) {
    const Doubles positions = numbers(vertices, "vertices", 3);
    const MeshQueries before = mesh;
    mesh = CtrlC().run(false, [&] {
        MeshQueries moved = before;
        moved.set_vertices(points(positions));
        return moved;
    });
}

py::array vertices_of(const MeshQueries& mesh) {
    const auto keeper = std::make_shared<const MeshQueries>(mesh);
    const auto& vertices = keeper->mesh().vertices;
    return lent(vertices.data(), vertices.size(), keeper);
}

py::array faces_of(const MeshQueries& mesh) {
    const auto keeper = std::make_shared<const MeshQueries>(mesh);
    const auto& triangles = keeper->mesh().triangles;
    const py::array flat = lent(reinterpret_cast<const std::uint32_t*>(triangles.data()), 3 * triangles.size(), keeper);
    py::array faces = flat.attr("reshape")(-1, 3);
    return faces;
}

py::array bounds_of(const MeshQueries& mesh) {
    const Box3 box = bounds(mesh.mesh());
    return given(std::vector<Vec3>{box.lower, box.upper});
}

constexpr const char* kMeshText = R"(A mesh of triangles, with exact queries.

vertices: numbers of shape (n, 3), in metres. faces: whole numbers of shape (m, 3).

Hits and first hits are decided exactly for the given doubles, also at edges and vertices, and far from the origin.
Results have the same bits for any number of threads and any order of queries. Queries use all threads and let other
Python threads run. A wrong argument raises ricochet.InputError, a ValueError.

transform: a matrix of shape (4, 4) that places the mesh for one query: a rotation or reflection times one scale, and a
translation. The query is mapped and rounded, and nothing is copied.)";

void bind_rays(py::class_<MeshQueries>& type) {
    using py::arg;
    type.def("first_hits", &first_hits, arg("origins"), arg("directions"), arg("most") = py::none(),
             arg("transform") = py::none(),
             "Returns the first hit of each ray. Directions have any length above 0. All rays may share one origin or "
             "one "
             "direction. most: range of rays in metres, one number or one each.")
        .def("all_hits", &all_hits, arg("origins"), arg("directions"), arg("most") = py::none(),
             arg("transform") = py::none(),
             "Returns every hit of every ray once. An edge or a vertex that triangles share is one hit. A path along "
             "the surface is one hit, at its begin.")
        .def("_all_hits_and_planes", &all_hits_and_planes, arg("origins"), arg("directions"), arg("most") = py::none(),
             arg("transform") = py::none())
        .def("count_hits", &count_hits, arg("origins"), arg("directions"), arg("most") = py::none(),
             arg("transform") = py::none(), "Returns the number of hits that all_hits() finds for each ray.")
        .def("occluded", &occluded, arg("origins"), arg("directions"), arg("most") = py::none(),
             arg("transform") = py::none(), "Returns whether each ray hits anything. It is cheaper than first_hits().");
}

void bind_points(py::class_<MeshQueries>& type) {
    using py::arg;
    type.def("inside", &inside, arg("points"), arg("rule") = "parity", arg("transform") = py::none(),
             "Returns whether each point is inside, exactly; points on the surface are not. The mesh must be closed. "
             "rule: \"parity\" (an odd number of shells encloses the point) or \"winding\" (its winding number is not "
             "0, so overlapping shells are joined).")
        .def("winding_numbers", &winding_numbers, arg("points"), arg("transform") = py::none(),
             "Returns the winding number of the mesh around each point: 1 inside a closed mesh wound outward, 0 "
             "outside. Overlapping shells and repeated triangles add up. In an open mesh it is a fraction, and above "
             "1/2 if the surface covers more than half of all directions from the point.")
        .def("closest_points", &closest_points, arg("points"), arg("within") = std::numeric_limits<double>::infinity(),
             arg("transform") = py::none(),
             "Returns the point of the mesh nearest to each point, if there is one within that distance.")
        .def("signed_distances", &signed_distances, arg("points"), arg("rule") = "parity",
             arg("transform") = py::none(),
             "Returns the distance of each point from the surface, negative inside by the rule of inside(). The mesh "
             "must be closed.")
        .def("sweep", &sweep, arg("from_points"), arg("to_points"), arg("radius") = 0.0,
             arg("vertices_after") = py::none(), arg("transform") = py::none(),
             "Returns the first contact of points, or spheres of a radius (one number or one each), on straight paths. "
             "vertices_after: positions to which the mesh's vertices move meanwhile. The distance is the fraction of "
             "the path.");
}

void bind_pickling(py::class_<MeshQueries>& type) {
    // Without __reduce__, the old protocols of pickle fail, because they look for a base class that can be copied.
    type.def("__reduce__",
             [](const py::object& mesh) {
                 return py::make_tuple(py::module_::import("copyreg").attr("__newobj__"),
                                       py::make_tuple(py::type::of(mesh)), mesh.attr("__getstate__")());
             })
        .def(py::pickle(
            [](const py::object& mesh) {
                const auto& m = py::cast<const MeshQueries&>(mesh);
                return py::make_tuple(vertices_of(m), faces_of(m), mesh.attr("__dict__"));
            },
            [](const py::tuple& state) {
                if (state.size() != 3) throw InputError("Mesh: the pickled state is not one of a Mesh");
                return std::pair(MeshQueries(mesh_of(state[0], state[1])), py::dict(state[2]));
            }));
}

}  // namespace

void bind_mesh(py::module_& module) {
    using py::arg;
    py::class_<MeshQueries> type(module, "Mesh", kMeshText, py::dynamic_attr());
    type.def(py::init([](const py::object& vertices, const py::object& faces) {
                 TriangleMesh mesh = mesh_of(vertices, faces);
                 const Unlocked unlocked;
                 return MeshQueries(std::move(mesh));
             }),
             arg("vertices"), arg("faces"))
        .def_static(
            "read", &read_named_mesh, arg("file"), arg("up") = py::none(), arg("scale") = 1.0,
            arg("merge") = py::none(),
            "Reads a mesh from an OBJ, PLY, STL, OFF or glTF file, in doubles. up: the axis of the file that points "
            "up, \"y\" or \"z\" (None: y for glTF files, else z). scale: the file's unit in metres, or a factor "
            "for each "
            "axis; negative factors mirror. merge: joins vertices within that distance, m (0: equal "
            "positions); no vertex "
            "moves farther. The names that the file gives to faces are in `materials`, `groups` and `objects`.")
        .def_property_readonly("vertices", &vertices_of, "Shape (n, 3), read-only.")
        .def_property_readonly("faces", &faces_of, "Shape (m, 3), read-only.")
        .def_property_readonly("bounds", &bounds_of, "Lower and upper corner of the bounding box.")
        .def_property_readonly(
            "area", [](const MeshQueries& m) { return surface_area(m.mesh()); }, "Surface area, in m^2.")
        .def_property_readonly(
            "volume", [](const MeshQueries& m) { return signed_volume(counted_surface(m.mesh())); },
            "Volume of a closed mesh, in m^3; above 0 if it is wound outward; meaningless for an open one. Repeated "
            "triangles count once, and "
            "nested shells "
            "of equal winding add up.")
        .def_property_readonly(
            "is_closed", &MeshQueries::is_closed,
            "True if the mesh has an inside: every edge has an even number of triangles. Vertices at equal "
            "positions count as one, and repeated triangles once. The winding has no influence.")
        .def("set_vertices", &set_vertices, arg("vertices"),
             "Moves the vertices. It is cheaper than a new mesh, with the same results.")
        .def("__len__", [](const MeshQueries& m) { return m.mesh().triangles.size(); })
        .def("__repr__", [](const MeshQueries& m) {
            return fmt::format("<ricochet.Mesh of {} triangles and {} vertices>", m.mesh().triangles.size(),
                               m.mesh().vertices.size());
        });
    bind_pickling(type);
    bind_names(type, "groups",
               "The group of each triangle, like an OBJ file's `g`, or None. Set it to names or numbers, one "
               "each: a collider's `group_materials` gives them materials.");
    bind_names(type, "objects", "The object of each triangle, like an OBJ file's `o`, or None. Use it like `groups`.");
    bind_names(
        type, "materials",
        "The material of each triangle, like an OBJ file's `usemtl`, or None. Set it to names or numbers, one each. In "
        "a scene these are names of its `materials`, unless the collider's `group_materials` lists them. Names that "
        "read() has taken from a file mean nothing until `group_materials` lists them.");
    module.def("_triangulate", &triangulated, arg("points"), arg("offsets"), arg("corners"));
    bind_rays(type);
    bind_points(type);
}

}  // namespace ricochet::python
