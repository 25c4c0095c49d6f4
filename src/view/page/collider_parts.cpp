#include "view/page/collider_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/mesh/winding_number.h"
#include "run/vtp_reader.h"
#include "view/export/frame_reader.h"
#include "view/export/moving_meshes.h"

namespace ricochet {
namespace {

/// Largest distance of a vertex from its rigidly transformed position in a rigid collider, relative to the mesh's size.
/// Reason: deformations below the tolerance are invisible. Frames contain doubles, so rounding moves a rotated vertex
/// by only about 1e-15. With a smaller tolerance, rigid bodies far from the origin would count as deforming. With a
/// larger tolerance, small waves would be lost.
constexpr double kRigidTolerance = 1e-7;

/// Largest number of particles that are tested for being inside a collider, and the least winding number of a particle
/// inside. Particles in an open drum count as inside. Particles above a ground mesh do not.
constexpr std::size_t kProbes = 24;
constexpr double kInside = 0.75;

// Maps totals to levels. The scale is log(1 + total / unit), because totals span orders of magnitude. The unit is 1 for
// counts, and 1/999 of the largest total for impulses.
PartMap part_map(const VtkPolyData& data, const char* array, bool is_count) {
    const VtkArray* const totals = find_array(data.cell_arrays, array);
    PartMap map;
    if (totals == nullptr) return map;
    const std::vector<double> values = scalar_values(*totals);
    for (const double value : values) map.largest = std::max(map.largest, std::isfinite(value) ? value : 0.0);
    const double unit = is_count ? 1.0 : map.largest / 999.0;
    const double top = std::log1p(map.largest / unit);
    for (const double value : values) {
        const bool is_seen = map.largest > 0.0 && std::isfinite(value);
        map.levels.push_back(is_seen ? static_cast<std::uint16_t>(std::lround(255.0 * std::log1p(value / unit) / top))
                                     : std::uint16_t{0});
    }
    return map;
}

// Three vertices of a mesh that define a right-handed frame of unit vectors.
struct Tripod {
    std::array<std::uint32_t, 3> corners{};

    // Chooses vertices that are far apart, so that rounding rotates the frame as little as possible.
    explicit Tripod(const std::vector<Vec3>& points) {
        const auto farthest = [&](const auto& distance) {
            std::uint32_t best = 0;
            for (std::uint32_t i = 1; i < points.size(); ++i) {
                if (distance(points[i]) > distance(points[best])) best = i;
            }
            return best;
        };
        const Vec3 a = points.front();
        corners[1] = farthest([&](const Vec3& p) { return length_squared(p - a); });
        const Vec3 along = points[corners[1]] - a;
        corners[2] = farthest([&](const Vec3& p) { return length_squared(cross(p - a, along)); });
    }

    [[nodiscard]] std::array<Vec3, 3> axes(const std::vector<Vec3>& points) const {
        const Vec3 a = points[corners[0]];
        const Vec3 x = normalized(points[corners[1]] - a);
        const Vec3 z = normalized(cross(x, points[corners[2]] - a));
        return {x, cross(z, x), z};
    }
};

// Returns the rotation and translation that move the tripod's corners from one list of points to the other.
AffineMap pose_between(const Tripod& tripod, const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
    const std::array<Vec3, 3> a = tripod.axes(from);
    const std::array<Vec3, 3> b = tripod.axes(to);
    AffineMap map;
    map.row_x = b[0].x * a[0] + b[1].x * a[1] + b[2].x * a[2];
    map.row_y = b[0].y * a[0] + b[1].y * a[1] + b[2].y * a[2];
    map.row_z = b[0].z * a[0] + b[1].z * a[1] + b[2].z * a[2];
    map.translation = to[tripod.corners[0]] - map.direction(from[tripod.corners[0]]);
    return map;
}

Box3 box_of(const std::vector<Vec3>& points) {
    Box3 box;
    for (const Vec3& point : points) {
        if (is_finite(point)) box.include(point);
    }
    return box;
}

bool is_carried(const AffineMap& pose, const std::vector<Vec3>& from, const std::vector<Vec3>& to, double tolerance) {
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (!(length(pose.point(from[i]) - to[i]) <= tolerance)) return false;
    }
    return true;
}

const TriangleMesh& mesh_of(const std::map<std::uint32_t, TriangleMesh>& meshes, const ColliderPart& part,
                            const FrameFile& file) {
    const auto found = meshes.find(part.number);
    if (found == meshes.end() || found->second.triangles != part.mesh.triangles ||
        found->second.vertices.size() != part.mesh.vertices.size()) {
        throw InputError(fmt::format("{}: the collider {} has other triangles than in the run's first frame",
                                     file.moving.string(), part.name));
    }
    return found->second;
}

}  // namespace

ColliderParts::ColliderParts(const RunFolder& folder, const std::vector<FrameFile>& frames) {
    for (const std::filesystem::path& file : folder.colliders) {
        VtkPolyData data = read_vtp(file);
        const ColliderInfo* const info = folder.info.find(file.filename().string());
        ColliderPart part;
        part.name = info == nullptr ? file.stem().string() : info->name;
        part.material = info == nullptr ? 0 : info->material;
        part.number = static_cast<std::uint32_t>(index_of_collider_file(file.filename().string()).value_or(0));
        if (info != nullptr) {
            part.is_glass = info->looks.glass;
            part.is_hidden = info->looks.hidden;
            part.roughness = info->looks.roughness;
            part.has_pattern = info->looks.pattern;
            part.color = info->looks.color;
        }
        part.hits = part_map(data, "hits", true);
        part.impulse = part_map(data, "impulse", false);
        const std::vector<double>* const normal = find_field(data, "plane_normal");
        const bool is_plane = normal != nullptr && normal->size() == 3;
        part.mesh = {std::move(data.points), std::move(data.triangles)};
        part.reach = box_of(part.mesh.vertices);
        if (info != nullptr && info->moves) {
            part.motion = PartMotion::rigid;
            moving_.push_back(parts_.size());
        } else if (is_plane) {
            part.plane_normal = Vec3{normal->at(0), normal->at(1), normal->at(2)};
        }
        parts_.push_back(std::move(part));
    }
    if (!moving_.empty()) add_moving(frames.front());
    survey_motion(frames);
    find_glass(frames[frames.size() / 2]);
}

Box3 ColliderParts::box() const {
    Box3 box;
    for (const ColliderPart& part : parts_) {
        if (!part.plane_normal && !part.reach.empty()) box.include(part.reach);
    }
    return box;
}

// Replaces the meshes of moving colliders by their meshes in the first frame, because the files of moving colliders use
// local coordinates.
void ColliderParts::add_moving(const FrameFile& first) {
    std::map<std::uint32_t, TriangleMesh> meshes = read_moving_meshes(first);
    for (const std::size_t index : moving_) {
        ColliderPart& part = parts_[index];
        const auto found = meshes.find(part.number);
        if (found == meshes.end()) {
            throw InputError(fmt::format("{}: lacks the collider {}", first.moving.string(), part.name));
        }
        part.mesh = std::move(found->second);
        part.reach = box_of(part.mesh.vertices);
        for (PartMap* const map : {&part.hits, &part.impulse}) {
            if (map->levels.size() != part.mesh.triangles.size()) *map = {};
        }
    }
}

void ColliderParts::survey_motion(const std::vector<FrameFile>& frames) {
    if (moving_.empty()) return;
    struct Fact {
        bool is_rigid = true;
        Box3 box;
    };
    std::vector<std::vector<Fact>> facts(frames.size(), std::vector<Fact>(moving_.size()));
    parallel_for_blocks(frames.size(), 1, [&](std::size_t f, std::size_t, std::size_t) {
        const auto meshes = read_moving_meshes(frames[f]);
        for (std::size_t m = 0; m < moving_.size(); ++m) {
            const ColliderPart& part = parts_[moving_[m]];
            const std::vector<Vec3>& from = part.mesh.vertices;
            const std::vector<Vec3>& to = mesh_of(meshes, part, frames[f]).vertices;
            const AffineMap pose = pose_between(Tripod(from), from, to);
            facts[f][m] = {is_carried(pose, from, to, kRigidTolerance * part.reach.diagonal()), box_of(to)};
        }
    });
    for (const std::vector<Fact>& frame : facts) {
        for (std::size_t m = 0; m < moving_.size(); ++m) {
            ColliderPart& part = parts_[moving_[m]];
            if (!frame[m].is_rigid) part.motion = PartMotion::deforming;
            if (!frame[m].box.empty()) part.reach.include(frame[m].box);
        }
    }
}

// Makes a collider transparent if most particles are inside it, because an opaque collider would hide them.
void ColliderParts::find_glass(const FrameFile& probe) {
    const VtkPolyData frame = read_frame(probe.path);
    std::vector<Vec3> points;
    const std::size_t stride = frame.points.size() / kProbes + 1;
    for (std::size_t i = 0; i < frame.points.size(); i += stride) points.push_back(frame.points[i]);
    if (points.empty()) return;
    std::map<std::uint32_t, TriangleMesh> meshes;
    if (!moving_.empty()) meshes = read_moving_meshes(probe);
    for (ColliderPart& part : parts_) {
        if (part.plane_normal) continue;
        const TriangleMesh& mesh = part.motion == PartMotion::still ? part.mesh : mesh_of(meshes, part, probe);
        std::vector<std::uint8_t> is_inside(points.size(), 0);
        parallel_for_blocks(points.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
            is_inside[i] = std::fabs(winding_number(mesh, points[i])) > kInside ? 1 : 0;
        });
        const auto inside = std::accumulate(is_inside.begin(), is_inside.end(), std::size_t{0});
        part.is_glass = part.is_glass || 2 * inside > points.size();
    }
}

MovingFrame ColliderParts::moving_frame(const FrameFile& file) const {
    MovingFrame frame;
    if (moving_.empty()) return frame;
    const auto meshes = read_moving_meshes(file);
    for (const std::size_t index : moving_) {
        const ColliderPart& part = parts_[index];
        const TriangleMesh& mesh = mesh_of(meshes, part, file);
        if (part.motion == PartMotion::rigid) {
            frame.poses.push_back(pose_between(Tripod(part.mesh.vertices), part.mesh.vertices, mesh.vertices));
        } else {
            frame.points.push_back(mesh.vertices);
        }
    }
    return frame;
}

}  // namespace ricochet
