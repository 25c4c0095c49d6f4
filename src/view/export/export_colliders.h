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
    bool moves = false;        ///< true also if it deforms
    ColliderLooks looks{};
    /// Mesh in world coordinates, in m; of a moving collider as it is in the first frame. A plane is a square.
    TriangleMesh mesh;
};

/// Reads the colliders, and lists the frames that contain all moving colliders. The last frame of a killed run can
/// lack them.
class ExportColliders {
public:
    /// Throws InputError if files contradict each other, or if no frame contains the moving colliders.
    explicit ExportColliders(const RunFolder& folder);

    [[nodiscard]] const std::vector<ExportCollider>& all() const { return colliders_; }
    [[nodiscard]] bool any_moves() const { return any_moves_; }
    /// Returns the frames that contain all colliders; there is at least one.
    [[nodiscard]] const std::vector<FrameFile>& frames() const { return frames_; }
    /// Returns the moving colliders at a frame, by their indices, in world coordinates. Throws InputError if one is
    /// missing or has other triangles than in the first frame.
    [[nodiscard]] std::map<std::uint32_t, TriangleMesh> moving(const FrameFile& frame) const;

private:
    std::vector<ExportCollider> colliders_;
    std::vector<FrameFile> frames_;
    bool any_moves_ = false;
};

/// A generator of file names that are unique even on file systems that ignore case.
class ExportNames {
public:
    /// Returns the stem for a name: plain_file_name(), with a number if one of its files would reuse a name.
    /// endings: endings of all files that share the stem.
    [[nodiscard]] std::string take(const std::string& name, const std::vector<std::string>& endings);
    /// Returns all file names generated so far, in order.
    [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

private:
    std::set<std::string> used_;  // lower-case names
    std::vector<std::string> files_;
};

}  // namespace ricochet
