/// \file
/// Private to the readers of files that put meshes into a tree of nodes: one mesh of all that is placed.
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

/// x -> outer(inner(x)).
[[nodiscard]] AffineMap joined(const AffineMap& outer, const AffineMap& inner);

/// A point that PlacedMeshBuilder::add_corner() refuses, for a message.
[[nodiscard]] std::string misplaced_point(std::size_t number, const Vec3& placed);

/// Collects faces where nodes put them, in a world with y up, and gives them with z up. Corners of one placed mesh are
/// joined where their coordinates are equal: programs give every corner a vertex of its own where its normal or its
/// texture differs.
class PlacedMeshBuilder {
public:
    PlacedMeshBuilder() { mesh_.face_offsets.push_back(0); }
    PlacedMeshBuilder(const PlacedMeshBuilder&) = delete;
    PlacedMeshBuilder& operator=(const PlacedMeshBuilder&) = delete;

    void reserve(std::size_t corners);
    /// The faces that follow are a mesh's, placed. world: of the file, from the mesh.
    void begin(const AffineMap& world, const std::string& object, const std::string& group);
    /// Of the faces that follow.
    void set_material(const std::string& name) { names_.names().material = name; }
    /// A corner of the next face. Nothing, or where it would be when that is not finite or out of range.
    [[nodiscard]] std::optional<Vec3> add_corner(const Vec3& local);
    /// Ends that face. A placement that mirrors turns it, so that its outside stays outside.
    void end_face();
    /// What was collected since begin() is complete.
    void end();
    [[nodiscard]] ParsedMesh finish(std::string format);

private:
    PolygonMesh mesh_;
    FaceGroupTable names_;
    AffineMap world_;
    bool mirrors_ = false;
    std::vector<Vec3> points_;  ///< of what is being placed
    std::optional<VertexWelder> welder_;
};

}  // namespace ricochet
