/// \file
/// Builds one mesh from all meshes that a tree of nodes places. Private to the readers of files with nodes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/face_group_table.h"
#include "ricochet/geometry/mesh/mesh_source.h"
#include "ricochet/geometry/mesh/vertex_welder.h"

namespace ricochet {

/// Returns the map x -> outer(inner(x)).
[[nodiscard]] AffineMap joined(const AffineMap& outer, const AffineMap& inner);

/// Formats a message about a point that PlacedMeshBuilder::add_corner() refuses.
[[nodiscard]] std::string misplaced_point(std::size_t number, const Vec3& placed);

/// Collects placed faces in a world with y up and returns them with z up. Corners of one placed mesh are joined if
/// their coordinates are equal. This is necessary, because programs duplicate a vertex for corners with different
/// normals or textures.
class PlacedMeshBuilder {
public:
    PlacedMeshBuilder() { mesh_.face_offsets.push_back(0); }
    PlacedMeshBuilder(const PlacedMeshBuilder&) = delete;
    PlacedMeshBuilder& operator=(const PlacedMeshBuilder&) = delete;

    void reserve(std::size_t corners);
    /// Starts a placed mesh for the next faces. `world` maps mesh coordinates to the file's world.
    void begin(const AffineMap& world, const std::string& object, const std::string& group);
    /// Sets the material of the next faces.
    void set_material(const std::string& name) { names_.names().material = name; }
    /// Adds a corner to the current face. Returns nullopt, or the placed position if it is not finite or out of range.
    [[nodiscard]] std::optional<Vec3> add_corner(const Vec3& local);
    /// Ends the face. A mirroring placement reverses the face's winding, so that its outside stays outside.
    void end_face();
    /// Ends the mesh that begin() started.
    void end();
    [[nodiscard]] ImportedMesh finish(std::string format);

private:
    PolygonMesh mesh_;
    FaceGroupTable names_;
    AffineMap world_;
    bool mirrors_ = false;
    std::vector<Vec3> points_;  ///< points of the current mesh
    std::optional<VertexWelder> welder_;
};

}  // namespace ricochet
