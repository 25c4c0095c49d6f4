#include "claims/hard_meshes.h"

#include <utility>

#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "support/shared_meshes.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace {

TriangleMesh placed(TriangleMesh mesh, const Placement& placement) {
    const AffineMap map = world_from_local(placement);
    for (Vec3& v : mesh.vertices) v = map.point(v);
    return mesh;
}

/// Returns the rotated mesh. Its edges and faces are then not aligned with the axes.
TriangleMesh turned(TriangleMesh mesh) { return placed(std::move(mesh), {{}, {1, 2, 3}, 40.0, {1, 1, 1}}); }

/// Returns a star-shaped body with deep, sharp valleys.
TriangleMesh star_mesh() {
    TriangleMesh mesh = sphere_mesh({}, 1.0, 3);
    RandomSequence random(1, 0, 0);
    for (Vec3& v : mesh.vertices) v *= 0.2 + 0.8 * random.uniform();
    return mesh;
}

/// Returns a prism over the triangle (0, 0), (1, 0), (1, 0.01).
TriangleMesh wedge_mesh() {
    return {{{0, 0, 0}, {1, 0, 0}, {1, 0.01, 0}, {0, 0, 0.5}, {1, 0, 0.5}, {1, 0.01, 0.5}},
            {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}}};
}

}  // namespace

std::vector<NamedMesh> made_meshes() {
    return {{"box", turned(box_mesh({0, 0, 0}, {1, 2, 3}))},
            {"sphere", sphere_mesh({0.1, 0.2, 0.3}, 1.0, 3)},
            {"flat", turned(placed(sphere_mesh({}, 1.0, 4), {{}, {0, 0, 1}, 0.0, {1.0, 1.0, 1e-4}}))},
            {"star", star_mesh()},
            {"shell", merged(sphere_mesh({}, 1.0, 2), flipped(sphere_mesh({0.01, 0, 0}, 0.95, 3)))},
            {"wedge", turned(wedge_mesh())}};
}

std::optional<NamedMesh> mesh_by_name(const std::string& name) {
    for (NamedMesh& made : made_meshes()) {
        if (made.name == name) return std::move(made);
    }
    const auto path = shared_mesh(name);
    if (!path) return std::nullopt;
    return NamedMesh{name, read_mesh(*path).mesh};
}

std::vector<HardPlacement> hard_placements(const TriangleMesh& mesh) {
    const Vec3 diagonal = bounds(mesh).diagonal() * Vec3{1.0, -0.7, 0.4};
    const auto scaled = [](double factor) { return Placement{{}, {0, 0, 1}, 0.0, {factor, factor, factor}}; };
    return {{"as it is", {}},
            {"moved by 1e3 diagonals", {1e3 * diagonal}},
            {"moved by 1e6 diagonals", {1e6 * diagonal}},
            {"scaled by 2^-40", scaled(0x1p-40)},
            {"scaled by 2^40", scaled(0x1p40)}};
}

}  // namespace ricochet::testing
