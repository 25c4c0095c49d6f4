/// \file
/// Colliders of a run for a page, each either at rest, rigid or deforming.
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
    rigid,      ///< rotated and translated, within kRigidTolerance of the mesh's size
    deforming,  ///< any other motion; all vertices are stored in every frame
};

/// Totals (hits or impulses) of the triangles, as 8-bit levels on a logarithmic scale.
struct PartMap {
    double largest = 0.0;
    Levels levels;  ///< one per triangle; empty if the run has no totals
};

struct ColliderPart {
    std::string name;
    std::uint32_t number = 0;  ///< index in the run
    std::uint32_t material = 0;
    PartMotion motion = PartMotion::still;
    /// Transparent; set by the collider's appearance settings, or because the collider contains particles.
    bool is_glass = false;
    bool is_hidden = false;     ///< initially invisible; set by the collider's appearance settings
    double roughness = 1.0;     ///< 0 (mirror) to 1 (matt); set by the collider's appearance settings
    bool has_pattern = true;    ///< a plane shows lines; set by the collider's appearance settings
    std::optional<Vec3> color;  ///< in linear light; set by the collider's appearance settings
    /// Mesh in world coordinates, in m. The mesh of a moving collider has its position in the first frame. A plane is
    /// represented by a square.
    TriangleMesh mesh;
    std::optional<Vec3> plane_normal;  ///< set only for a plane at rest
    PartMap hits;
    PartMap impulse;  ///< in N s
    Box3 reach;       ///< bounding box of all its vertices over all frames
};

/// State of the moving colliders in a frame, in the order of the parts.
struct MovingFrame {
    /// Rotation and translation of each rigid collider, relative to ColliderPart::mesh.
    std::vector<AffineMap> poses;
    std::vector<std::vector<Vec3>> points;  ///< vertices of each deforming collider
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
