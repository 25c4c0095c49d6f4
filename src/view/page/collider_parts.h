/// \file
/// The colliders of a run as a page shows them: at rest, carried along as they are, or deforming.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/transform.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/run_folder.h"
#include "view/page/levels.h"

namespace ricochet {

enum class PartMotion {
    still,
    rigid,      ///< turned and shifted, to kRigidTolerance of its size
    deforming,  ///< anything else; every vertex is told in every frame
};

/// A total of the triangles: 8-bit levels on a logarithmic scale.
struct PartMap {
    double largest = 0.0;
    Levels levels;  ///< one a triangle; empty where the run has none
};

struct ColliderPart {
    std::string name;
    std::uint32_t number = 0;  ///< in the run
    std::uint32_t material = 0;
    PartMotion motion = PartMotion::still;
    bool is_glass = false;      ///< of its own looks, or has particles inside: to be seen through
    bool is_hidden = false;     ///< of its own looks: not shown at first
    double roughness = 1.0;     ///< of its own looks: 0 (a mirror's gloss) .. 1 (matt)
    bool has_pattern = true;    ///< of its own looks: a plane's lines
    std::optional<Vec3> color;  ///< of its own looks, linear light
    /// World coordinates, of one that moves those in the first frame, m. A plane is a square.
    TriangleMesh mesh;
    std::optional<Vec3> plane_normal;  ///< of a plane at rest
    PartMap hits;
    PartMap impulse;  ///< N s
    Box3 reach;       ///< of all its vertices over all frames
};

/// How the colliders that move stand in a frame, in the order of the parts.
struct MovingFrame {
    std::vector<AffineMap> poses;           ///< of the rigid ones, from their mesh
    std::vector<std::vector<Vec3>> points;  ///< of the deforming ones
};

class ColliderParts {
public:
    /// Reads all colliders' files, and how those that move stand in the frames. Throws InputError on files that do not
    /// fit each other.
    ColliderParts(const RunFolder& folder, const std::vector<FrameFile>& frames);

    [[nodiscard]] const std::vector<ColliderPart>& parts() const { return parts_; }
    /// Of all of them but planes, over all frames; empty without any.
    [[nodiscard]] Box3 box() const;
    /// May be called from several threads.
    [[nodiscard]] MovingFrame moving_frame(const FrameFile& file) const;

private:
    void add_moving(const FrameFile& first);
    void survey_motion(const std::vector<FrameFile>& frames);
    void find_glass(const FrameFile& probe);

    std::vector<ColliderPart> parts_;
    std::vector<std::size_t> moving_;  // indices of those that move
};

}  // namespace ricochet
