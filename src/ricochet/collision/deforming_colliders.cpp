#include "ricochet/collision/deforming_colliders.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {

DeformingColliders::DeformingColliders(const std::shared_ptr<ColliderList>& colliders)
    : colliders_(colliders), mesh_of_(colliders->all().size(), kNone) {
    for (std::size_t number = 0; number < mesh_of_.size(); ++number) {
        const ColliderDescription& collider = colliders->all()[number];
        if (!is_deforming(collider)) continue;
        mesh_of_[number] = static_cast<std::uint32_t>(meshes_.size());
        meshes_.emplace_back(collider, number, colliders->first_surface_of(number));
        colliders->replace_motion(number, meshes_.back().motion());
    }
}

double DeformingColliders::next_key(double time) const {
    double first = std::numeric_limits<double>::infinity();
    for (const DeformingMesh& mesh : meshes_) first = std::min(first, mesh.motion()->next_key(time));
    return first;
}

void DeformingColliders::begin_step(double begin, double end) {
    begin_ = begin;
    end_ = end;
    for (DeformingMesh& mesh : meshes_) mesh.begin_step(begin, end, boxes_);
}

void DeformingColliders::near(const Box3& box, std::vector<SurfaceId>& out) const {
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    for (const DeformingMesh& mesh : meshes_) {
        mesh.tree().near(box, [&](std::uint32_t k) { out.push_back(mesh.solid_surface(k)); });
    }
    std::sort(out.begin() + first, out.end());
}

bool DeformingColliders::stay_out(const Box3& box) const {
    return std::ranges::none_of(meshes_, [&](const DeformingMesh& mesh) { return mesh.tree().has_near(box); });
}

double DeformingColliders::offset_in(const Box3& box) const {
    double offset = 0.0;
    for (const DeformingMesh& mesh : meshes_) {
        if (overlap(mesh.tree().bounds(), box)) offset = std::max(offset, mesh.offset());
    }
    return offset;
}

bool DeformingColliders::is_segment_free(const StoredPosition& from, const StoredPosition& to, double radius) const {
    std::vector<SurfaceId> all;
    if (begin_ <= from.time && to.time <= end_) {
        near(box_of(from, to, radius), all);
    } else {  // the segment of a stalled particle starts before the step, and the boxes do not cover it
        for (const DeformingMesh& mesh : meshes_) {
            for (std::size_t k = 0; k < mesh.solid_count(); ++k) all.push_back(mesh.solid_surface(k));
        }
    }
    const double tolerance = sphere_tolerance(radius, std::max(max_abs(from.position), max_abs(to.position)));
    return std::ranges::all_of(all, [&](SurfaceId surface) {
        const DeformingMesh& mesh = mesh_with(surface);
        if (radius == 0.0) return mesh.is_free(surface, from, to, 0.0);
        // The ends must keep more distance than the certificate requires, because losses in successive segments add up.
        const double distance = mesh.triangle_at(surface, from.time).nearest(from.position).distance;
        const double least = distance >= radius - tolerance
                                 ? std::min(radius - kUsedSphereTolerance * tolerance, kNearerStill * distance)
                                 : distance - kOverlapRounding * tolerance;
        if (mesh.triangle_at(surface, to.time).nearest(to.position).distance < least) return false;
        return mesh.is_free(surface, from, to,
                            std::max(0.0, std::min(radius - tolerance, distance - 0.25 * tolerance)));
    });
}

bool DeformingColliders::is_late_segment_free(const StoredPosition& from, const StoredPosition& to,
                                              double radius) const {
    return std::ranges::all_of(meshes_,
                               [&](const DeformingMesh& mesh) { return mesh.is_late_segment_free(from, to, radius); });
}

void DeformingColliders::nearest_to(const Vec3& p, double time, std::size_t most, std::vector<SurfaceId>& out) const {
    std::vector<std::pair<double, SurfaceId>> all;
    for (const DeformingMesh& mesh : meshes_) {
        for (std::size_t k = 0; k < mesh.solid_count(); ++k) {
            const SurfaceId surface = mesh.solid_surface(k);
            const auto [a, b, c] = mesh.triangle_at(surface, time);
            all.emplace_back(closest_point_on_triangle(p, a, b, c).distance_squared, surface);
        }
    }
    const std::size_t count = std::min(most, all.size());
    std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
    for (std::size_t k = 0; k < count; ++k) out.push_back(all[k].second);
}

}  // namespace ricochet
