/// \file
/// Private to the library: colliders of a finished run, prepared for export.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "run/run_folder.h"

namespace ricochet {

struct ExportCollider {
    std::string name;          ///< name in the scene
    std::uint32_t number = 0;  ///< index in the run
    bool moves = false;        ///< moves or deforms
    ColliderLooks looks{};
    /// Mesh in world coordinates, in m. The mesh of a moving collider has its position in the first frame. A plane is
    /// represented by a square.
    TriangleMesh mesh;
};

/// Colliders of a run, and the frames that contain all moving colliders. If a run was killed, its last frame can lack
/// the moving colliders.
class ExportColliders {
public:
    /// Reads the colliders. Throws InputError if files contradict each other, or if no frame contains the moving
    /// colliders.
    explicit ExportColliders(const RunFolder& folder);

    [[nodiscard]] const std::vector<ExportCollider>& all() const { return colliders_; }
    [[nodiscard]] bool any_moves() const { return any_moves_; }
    /// Returns the frames that contain all moving colliders. There is at least one such frame.
    [[nodiscard]] const std::vector<FrameFile>& frames() const { return frames_; }
    /// Returns the meshes of the moving colliders in a frame, by collider index, in world coordinates. Throws
    /// InputError if a collider is missing or its triangles differ from the first frame.
    [[nodiscard]] std::map<std::uint32_t, TriangleMesh> moving(const FrameFile& frame) const;

private:
    std::vector<ExportCollider> colliders_;
    std::vector<FrameFile> frames_;
    bool any_moves_ = false;
};

/// Generator of file names that are unique even on file systems that ignore case.
class ExportNames {
public:
    /// Returns the stem of the file names for `name`: plain_file_name(name), with a number appended if a file name is
    /// already used. `endings` lists the endings of all files that share the stem.
    [[nodiscard]] std::string take(const std::string& name, const std::vector<std::string>& endings);
    /// Returns all file names generated so far, in order.
    [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

private:
    std::set<std::string> used_;  // lower-case names
    std::vector<std::string> files_;
};

}  // namespace ricochet
