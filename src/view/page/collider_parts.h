/// \file
/// Colliders of a run for a page: at rest, rigid or deforming.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/transform.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "run/run_folder.h"
#include "view/page/levels.h"

namespace ricochet {

enum class PartMotion {
    still,
    rigid,      ///< rotated and translated, to kRigidTolerance of its size
    deforming,  ///< any other motion; all vertices are stored in every frame
};

/// Totals of the triangles: 8-bit levels on a logarithmic scale.
struct PartMap {
    double largest = 0.0;
    Levels levels;  ///< one per triangle; empty if the run has no totals
};

struct ColliderPart {
    std::string name;
    std::uint32_t number = 0;  ///< number in the run
    std::uint32_t material = 0;
    PartMotion motion = PartMotion::still;
    bool is_glass = false;      ///< from its appearance settings, or because it has particles inside: transparent
    bool is_hidden = false;     ///< from its appearance settings: initially invisible
    double roughness = 1.0;     ///< from its appearance settings: 0 (a mirror's gloss) .. 1 (matt)
    bool has_pattern = true;    ///< from its appearance settings: a plane's lines
    std::optional<Vec3> color;  ///< from its appearance settings, in linear light
    /// World coordinates in m. For a moving collider, coordinates in the first frame. A plane is a square.
    TriangleMesh mesh;
    std::optional<Vec3> plane_normal;  ///< for a plane at rest
    PartMap hits;
    PartMap impulse;  ///< in N s
    Box3 reach;       ///< bounding box of all its vertices over all frames
};

/// State of the moving colliders in a frame, in the order of the parts.
struct MovingFrame {
    std::vector<AffineMap> poses;           ///< of the rigid colliders, relative to their mesh
    std::vector<std::vector<Vec3>> points;  ///< of the deforming colliders
};

class ColliderParts {
public:
    /// Reads the files of all colliders, and the motion of the moving colliders over the frames. Throws InputError if
    /// files do not match each other.
    ColliderParts(const RunFolder& folder, const std::vector<FrameFile>& frames);

    [[nodiscard]] const std::vector<ColliderPart>& parts() const { return parts_; }
    /// Returns the bounding box of all colliders except planes, over all frames. It is empty if there are none.
    [[nodiscard]] Box3 box() const;
    /// Returns the state of the moving colliders in a frame. Safe to call from several threads.
    [[nodiscard]] MovingFrame moving_frame(const FrameFile& file) const;

private:
    void add_moving(const FrameFile& first);
    void survey_motion(const std::vector<FrameFile>& frames);
    void find_glass(const FrameFile& probe);

    std::vector<ColliderPart> parts_;
    std::vector<std::size_t> moving_;  // indices of the moving colliders
};

}  // namespace ricochet
