#include "ricochet/collision/contact_query.h"

#include <cmath>

#include "ricochet/collision/surfaces_in_other_frames.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Returns true if the path hits a candidate. Otherwise the path passes all candidates, and the broad phase has to find
/// the triangles near it.
bool is_candidate_hit(const ContactCandidates& candidates, NarrowPhase& narrow_phase, ContactScratch& scratch) {
    for (const std::uint32_t triangle : candidates.triangles()) (void)narrow_phase.test_triangle(triangle);
    if (!narrow_phase.has_hit()) scratch.triangles.clear();
    return narrow_phase.has_hit();
}

/// Tests the triangles near the path and looks ahead if nothing is hit. Planes and shapes must have been tested.
LookAheadOutcome test_triangles(const CollisionWorld& world, const QueryMargins& margins, const ContactQuery& query,
                                NarrowPhase& narrow_phase, ContactScratch& scratch) {
    if (query.candidates.is_known() && is_candidate_hit(query.candidates, narrow_phase, scratch)) {
        return {{}, CandidateSet::near};
    }
    if (query.look_ahead != nullptr && !narrow_phase.has_hit()) {
        const LookAheadOutcome ahead =
            test_triangles_and_look_ahead(world, margins, query.path, *query.look_ahead, narrow_phase, scratch);
        if (ahead.tested) return ahead;
    }
    if (world.triangles().empty()) return {{}, CandidateSet::near};
    return {{}, test_triangles_near(world, margins, query.path, narrow_phase)};
}

}  // namespace

ContactQueryResult find_first_contact(const SurfaceGeometry& geometry, const ContactQuery& query,
                                      ContactScratch& scratch) {
    const CollisionWorld& world = geometry.world();
    const QueryMargins margins(world, query.path, query.radius, query.beside);
    scratch.clear();
    NarrowPhase narrow_phase(geometry, query.path, margins, query.supports, scratch);
    narrow_phase.test_planes();
    narrow_phase.test_shapes();
    const auto [ahead, tested] = test_triangles(world, margins, query, narrow_phase, scratch);
    ContactQueryResult result{std::nullopt, {geometry, scratch, margins, query.path.c[0], *tested}, ahead};
    if (narrow_phase.has_hit()) {
        result.contact = narrow_phase.take_first_contact();
        result.ahead = {};
    }
    return result;
}

bool NearSurfaces::is_overlapped(SurfaceId surface) const {
    const auto& list = scratch_->overlapped;
    return std::find(list.begin(), list.end(), surface) != list.end();
}

bool NearSurfaces::starts_in_overlap() const {
    return margins_.radius > 0.0 ? !scratch_->overlapped.empty() : blocker(start_, start_).has_value();
}

bool NearSurfaces::plane_blocks(const CollisionWorld::PlaneSurface& plane, const Vec3& p, const Vec3& q,
                                double tolerance) const {
    if (side_of(plane.plane, p) * side_of(plane.plane, q) <= 0) return true;
    if (margins_.radius == 0.0 || is_overlapped(plane.surface)) return false;
    const double nearest =
        std::min(std::fabs(signed_distance(p, plane.plane)), std::fabs(signed_distance(q, plane.plane)));
    return nearest < margins_.radius - tolerance;
}

bool NearSurfaces::shape_blocks(const CollisionWorld::ShapeSurface& shape, const Vec3& p, const Vec3& q,
                                double tolerance) const {
    if (!shape.shape.segment_is_clear(p, q)) return true;
    const auto& overlapped = scratch_->overlapped;
    const bool is_already_overlapped =
        std::any_of(overlapped.begin(), overlapped.end(), [&](SurfaceId s) { return shape.owns(s); });
    if (margins_.radius == 0.0 || is_already_overlapped) return false;
    return shape.shape.distance_to_segment(p, q) < margins_.radius - tolerance;
}

bool NearSurfaces::triangle_blocks(std::uint32_t triangle, const Vec3& p, const Vec3& q, double tolerance) const {
    if (margins_.radius == 0.0) return geometry_.plane_of(triangle).intersects_segment(p, q);
    const auto [a, b, c] = world().corners_of_triangle(triangle);
    if (segment_intersects_triangle(p, q, a, b, c)) return true;
    if (sphere_segment_is_clear(p, q, margins_.radius, tolerance, a, b, c)) return false;
    return !is_overlapped(world().surface_of_triangle(triangle));
}

bool NearSurfaces::is_free(const Vec3& p, const Vec3& q) const {
    const double tolerance = tolerance_of(p, q);
    const auto none = [](const auto& list, const auto& blocks) {
        return std::none_of(list.begin(), list.end(), blocks);
    };
    return none(scratch_->planes,
                [&](std::uint32_t k) { return plane_blocks(world().planes()[k], p, q, tolerance); }) &&
           none(scratch_->shapes,
                [&](std::uint32_t k) { return shape_blocks(world().shapes()[k], p, q, tolerance); }) &&
           none(scratch_->triangles, [&](std::uint32_t t) { return triangle_blocks(t, p, q, tolerance); });
}

std::optional<SurfaceId> NearSurfaces::blocker(const Vec3& p, const Vec3& q) const {
    const double tolerance = tolerance_of(p, q);
    std::optional<SurfaceId> smallest;
    const auto consider = [&](SurfaceId surface) {
        if (!smallest || surface < *smallest) smallest = surface;
    };
    for (const std::uint32_t k : scratch_->planes) {
        if (plane_blocks(world().planes()[k], p, q, tolerance)) consider(world().planes()[k].surface);
    }
    for (const std::uint32_t k : scratch_->shapes) {
        if (shape_blocks(world().shapes()[k], p, q, tolerance)) consider(world().shapes()[k].nearest_to(q));
    }
    for (const std::uint32_t triangle : scratch_->triangles) {
        if (triangle_blocks(triangle, p, q, tolerance)) consider(world().surface_of_triangle(triangle));
    }
    return smallest;
}

std::optional<SurfaceId> NearSurfaces::deepened_overlap(const Vec3& p, const Vec3& q) const {
    if (margins_.radius == 0.0) return std::nullopt;
    const double least = margins_.radius - tolerance_of(q, q);
    for (const SurfaceId surface : scratch_->overlapped) {
        if (!world().owns(surface)) continue;
        const double distance = geometry_.nearest(surface, q).distance;
        if (distance < least && distance < geometry_.nearest(surface, p).distance) return surface;
    }
    return std::nullopt;
}

/// Returns the surfaces in ascending order. Each shape is represented by its part nearest to p.
std::vector<SurfaceId> NearSurfaces::surfaces(const Vec3& p) const {
    std::vector<SurfaceId> list;
    for (const std::uint32_t k : scratch_->planes) list.push_back(world().planes()[k].surface);
    for (const std::uint32_t k : scratch_->shapes) list.push_back(world().shapes()[k].nearest_to(p));
    for (const std::uint32_t triangle : scratch_->triangles) list.push_back(world().surface_of_triangle(triangle));
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

std::vector<SurfaceId> NearSurfaces::surfaces_at(const Vec3& p) const {
    std::vector<SurfaceId> list = surfaces(p);
    std::erase_if(list, [&](SurfaceId surface) { return !world().point_on(surface, p); });
    return list;
}

bool NearSurfaces::is_free_after(const Vec3& p, const Vec3& q) const {
    const std::vector<SurfaceId> list = surfaces(p);
    return std::all_of(list.begin(), list.end(), [&](SurfaceId surface) {
        if (!world().segment_intersects(surface, p, q)) return true;
        return world().point_on(surface, p) && world().side_of_surface(surface, q) != 0;
    });
}

bool NearSurfaces::covers_chord(const Path& path, double from, double to) const {
    const bool covers_own =
        candidates_ == CandidateSet::all || ricochet::covers_chord(world(), margins_, path, from, to);
    return covers_own && (other_frames_ == nullptr || other_frames_->cover_chord(from, to));
}

PathPoint NearSurfaces::point_at(const Vec3& p, double time) const {
    return other_frames_ == nullptr ? PathPoint{p, time, p} : other_frames_->surfaces().point_at(p, time);
}

PathPoint NearSurfaces::start() const {
    return other_frames_ == nullptr ? PathPoint{start_, 0.0, start_} : other_frames_->start();
}

bool NearSurfaces::is_segment_free(const PathPoint& p, const PathPoint& q) const {
    return is_free(p.position, q.position) && (other_frames_ == nullptr || other_frames_->are_free(p, q));
}

std::optional<SurfaceId> NearSurfaces::segment_blocker(const PathPoint& p, const PathPoint& q) const {
    const std::optional<SurfaceId> own = blocker(p.position, q.position);
    return own || other_frames_ == nullptr ? own : other_frames_->blocker(p, q);
}

std::optional<SurfaceId> NearSurfaces::overlap_deepened_by(const PathPoint& p, const PathPoint& q) const {
    const std::optional<SurfaceId> own = deepened_overlap(p.position, q.position);
    return own || other_frames_ == nullptr ? own : other_frames_->overlap_deepened_by(p, q);
}

bool NearSurfaces::is_own(SurfaceId surface) const { return other_frames_ == nullptr || world().owns(surface); }

CollisionWorld::Nearest NearSurfaces::nearest(SurfaceId surface, const PathPoint& p) const {
    return is_own(surface) ? geometry_.nearest(surface, p.position) : other_frames_->surfaces().nearest(surface, p);
}

double NearSurfaces::signed_distance_from(SurfaceId surface, const PathPoint& p) const {
    return is_own(surface) ? geometry_.signed_distance_from(surface, p.position)
                           : other_frames_->surfaces().signed_distance_from(surface, p);
}

Vec3 NearSurfaces::unit_normal_of(SurfaceId surface, const PathPoint& p) const {
    return is_own(surface) ? geometry_.unit_normal_of(surface, p.position)
                           : other_frames_->surfaces().unit_normal_of(surface, p);
}

ContactSurface NearSurfaces::facing_surface(SurfaceId surface, const PathPoint& p) const {
    if (radius() > 0.0) {
        const CollisionWorld::Nearest nearest = this->nearest(surface, p);
        return {surface, nearest.normal, nearest.flat};
    }
    if (is_own(surface)) {
        const int side = world().side_of_surface(surface, p.position);
        return {surface, static_cast<double>(side) * geometry_.unit_normal_of(surface, p.position),
                world().is_flat(surface)};
    }
    const SurfacesInTime& surfaces = other_frames_->surfaces();
    const int side = surfaces.side_of_surface(surface, p);
    return {surface, static_cast<double>(side) * surfaces.unit_normal_of(surface, p), surfaces.is_flat(surface)};
}

double NearSurfaces::offset_at(const PathPoint& p) const {
    const double own = geometry_.contact_offset(p.position);
    return other_frames_ == nullptr ? own : std::max(own, other_frames_->offset_at(p));
}

}  // namespace ricochet
