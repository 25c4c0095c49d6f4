#include "ricochet/io/scene/body_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/collision_queries.h"
#include "ricochet/core/box3.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/mesh/mesh_openings.h"

namespace ricochet::detail {
namespace {

/// Largest product of the numbers of triangles and test points. Local: it limits the cost of a warning.
constexpr double kMostSolidAngles = 1e7;
constexpr double kMostPoints = 4096;
constexpr double kLeastPoints = 64;

/// Largest share of points in overlaps, among all points inside, that is not reported. Local, because it affects only a
/// warning.
constexpr double kNegligibleShare = 0.01;

/// One closed collider in the coordinates of its frame.
class ClosedPart {
public:
    explicit ClosedPart(const ColliderDescription& collider) : name_(collider.name) {
        if (const auto* mesh = std::get_if<MeshShape>(&collider.shape)) {
            mesh_ = transformed(counted_surface(*mesh->mesh), mesh->placement);
            box_ = bounds(mesh_);
            return;
        }
        ColliderDescription own = collider;
        own.frame.clear();
        queries_ = std::make_unique<CollisionQueries>(std::vector{std::move(own)});
        std::visit([&](const auto& shape) { include(shape); }, collider.shape);
    }

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const Box3& box() const { return box_; }
    [[nodiscard]] std::size_t triangles() const { return mesh_.triangles.size(); }
    /// Returns the number of times that the collider encloses a point.
    [[nodiscard]] int count(const Vec3& p) const {
        if (!box_.contains(p)) return 0;
        if (queries_) return queries_->is_inside(p) ? 1 : 0;
        return static_cast<int>(std::lround(std::fabs(winding_number(mesh_, p))));
    }

private:
    void include(const PlaneShape& /*plane*/) {}
    void include(const MeshShape& /*mesh*/) {}
    void include(const CuboidShape& cuboid) {
        for (const Vec3& corner : transformed(cuboid_mesh(cuboid.size), cuboid.placement).vertices) {
            box_.include(corner);
        }
    }
    template <class Round>
    void include(const Round& shape) {
        const TriangleMesh cube = cuboid_mesh({2, 2, 2});
        for (const Vec3& corner : cube.vertices) box_.include(world_from_unit(shape).point(corner));
    }

    std::string name_;
    TriangleMesh mesh_;
    std::unique_ptr<CollisionQueries> queries_;
    Box3 box_;
};

/// Counts of the test points, and the first overlap found.
struct Shares {
    std::size_t inside = 0;  ///< number of points inside at least one collider
    std::size_t again = 0;   ///< number of points that colliders enclose more than once
    std::string first;       ///< name of a collider around the first point that is enclosed more than once
    /// Name of another collider around this point; empty if `first` alone encloses the point several times.
    std::string second;
};

void look_at(const Vec3& p, const std::vector<ClosedPart>& parts, Shares& shares) {
    int all = 0;
    std::vector<const ClosedPart*> within;
    for (const ClosedPart& part : parts) {
        const int count = part.count(p);
        all += count;
        if (count > 0) within.push_back(&part);
    }
    shares.inside += all > 0 ? 1 : 0;
    if (all < 2 || shares.again++ > 0) return;
    shares.first = within[0]->name();
    if (within.size() > 1) shares.second = within[1]->name();
}

}  // namespace

std::optional<std::string> doubly_filled(const SimulationSetup& setup, const std::string& frame) {
    std::vector<ClosedPart> parts;
    Box3 box;
    std::size_t triangles = 1;
    for (const ColliderDescription& collider : setup.colliders) {
        if (collider.frame != frame) continue;
        parts.emplace_back(collider);
        box.include(parts.back().box());
        triangles += parts.back().triangles();
    }
    const auto points =
        static_cast<int>(std::clamp(kMostSolidAngles / static_cast<double>(triangles), kLeastPoints, kMostPoints));
    RandomSequence random(0, 0, 0);
    Shares shares;
    for (int k = 0; k < points; ++k) {
        const Vec3 size = box.size();
        const double x = random.uniform();
        const double y = random.uniform();
        const double z = random.uniform();
        look_at(box.lower + Vec3{x * size.x, y * size.y, z * size.z}, parts, shares);
    }
    const double share =
        static_cast<double>(shares.again) / static_cast<double>(std::max<std::size_t>(1, shares.inside));
    if (share < kNegligibleShare) return std::nullopt;
    const std::string where =
        shares.second.empty()
            ? fmt::format("the mesh \"{}\" crosses itself, or nests shells that are wound alike", shares.first)
            : fmt::format("the colliders \"{}\" and \"{}\" overlap", shares.first, shares.second);
    return fmt::format(
        "{}: about {:.2g} % of the inside of the body's colliders is included more than once in its mass, centre "
        "and inertia; "
        "let them touch only, reverse the inner shell of a cavity, or give \"mass\", \"center\" and \"inertia\"",
        where, 100.0 * share);
}

}  // namespace ricochet::detail
