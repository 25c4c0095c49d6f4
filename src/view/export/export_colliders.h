/// \file
/// Private to the library: the colliders of a finished run as other programs get them.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/run_folder.h"

namespace ricochet {

struct ExportCollider {
    std::string name;          ///< the scene's
    std::uint32_t number = 0;  ///< in the run
    bool moves = false;        ///< or deforms
    ColliderLooks looks{};
    /// In world coordinates, m; of one that moves as it stands in the first frame. A plane is a square.
    TriangleMesh mesh;
};

/// Reads the colliders, and the frames of the run that hold all of them that move: one that was being written when the
/// run was killed may not.
class ExportColliders {
public:
    /// Throws InputError on files that do not fit each other, and where no frame holds the colliders that move.
    explicit ExportColliders(const RunFolder& folder);

    [[nodiscard]] const std::vector<ExportCollider>& all() const { return colliders_; }
    [[nodiscard]] bool any_moves() const { return any_moves_; }
    /// The frames that hold all colliders; never none.
    [[nodiscard]] const std::vector<FrameFile>& frames() const { return frames_; }
    /// The colliders that move as they stand in a frame, by their numbers. Throws InputError where one is missing or
    /// has other triangles than in the first frame.
    [[nodiscard]] std::map<std::uint32_t, TriangleMesh> moving(const FrameFile& frame) const;

private:
    std::vector<ExportCollider> colliders_;
    std::vector<FrameFile> frames_;
    bool any_moves_ = false;
};

/// Names of files, each once, also where capital letters do not count.
class ExportNames {
public:
    /// The stem that belongs to a name: plain_file_name(), with a number where one of its files has its name already.
    /// endings: of all files that are to begin with the stem.
    [[nodiscard]] std::string take(const std::string& name, const std::vector<std::string>& endings);
    /// All names that were given, in their order.
    [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

private:
    std::set<std::string> used_;  // in small letters
    std::vector<std::string> files_;
};

}  // namespace ricochet
