#include "ricochet/collision/moving_sweep.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "ricochet/collision/deforming_sweep.h"
#include "ricochet/collision/look_ahead.h"
#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/pair_sweep.h"

namespace ricochet {
namespace {

/// Number of Newton steps in the search for the true time of an impact. Each squares the error.
constexpr int kNewtonSteps = 4;

/// Returns the piece of a path between two times, with a given start, which may differ by rounding.
Path piece_of(const Path& path, double from, double to, const Vec3& start) {
    Path piece = path;
    piece.c[0] = start;
    piece.c[1] = path.velocity(from);
    piece.c[2] = path.c[2] + (3.0 * from) * path.c[3];
    piece.duration = to - from;
    piece.end = path.position(to);
    return piece;
}

/// Returns the straight path between two positions.
Path straight_path(const Vec3& from, const Vec3& to, double duration) {
    const Vec3 velocity = (to - from) / duration;
    Path path = line_path(from, is_finite(velocity) ? velocity : Vec3{}, duration);
    path.end = to;
    return path;
}

/// Returns bounds of the derivatives of a path.
DerivativeBounds bounds_of(const Path& path) {
    const double t = path.duration;
    const double second = length(path.c[2]);
    const double third = length(path.c[3]);
    DerivativeBounds bounds{};
    bounds[3] = 6.0 * third;
    bounds[2] = 2.0 * second + 6.0 * t * third;
    bounds[1] = length(path.c[1]) + t * (2.0 * second + 3.0 * t * third);
    bounds[0] = length(path.c[0]) + t * bounds[1];
    return bounds;
}

}  // namespace

Box3 reach_of(const Path& path, double radius) {
    const Box3 box = box_of(path, path.duration);
    return grown(box, radius + kCandidateSlack * (std::max(max_abs(box.lower), max_abs(box.upper)) + radius));
}

MovingSweep::MovingSweep(const MovingView& view, const SurfaceGeometry& geometry, const ContactQuery& query,
                         const PathPoint& start, ContactScratch& scratch)
    : view_(view),
      geometry_(geometry),
      query_(query),
      start_(start),
      scratch_(scratch),
      lists_(std::exchange(scratch.sweep, {})) {
    find_near();
    beside_path_ = beside_path();
    cut();
}

/// Finds the bodies near the path, by the path's box in the world. A path in the frame of a body has a box of all
/// positions that it can reach.
void MovingSweep::find_near() {
    const MovingColliders& bodies = view_.bodies();
    Box3 box = reach_of(query_.path, query_.radius);
    if (view_.reference() != kWorldBody) {
        const double from_origin = largest_coordinate(query_.path) + query_.radius;
        box = {};
        // Between the ends the frame moves by no more than its speed allows.
        const MotionBounds& bounds = bodies.bounds(view_.reference());
        const double path_length = query_.path.duration * (bounds.origin[1] + bounds.rotation[1] * 2.0 * from_origin +
                                                           bounds_of(query_.path)[1]);
        const double margin = path_length + query_.radius + kCandidateSlack * (max_abs(start_.world) + query_.radius);
        const Vec3 by{margin, margin, margin};
        box.include(start_.world - by);
        box.include(start_.world + by);
    }
    lists_.near.clear();
    lists_.tolerances.clear();
    bodies.near(box, view_.reference(), lists_.near);
    for (const BodyId body : lists_.near) lists_.tolerances.push_back(tolerance_in(body));
    if (!bodies.deforming().empty()) find_deforming(box);
}

/// Finds the deforming triangles near the path, and near all positions beside the path that can be tried.
void MovingSweep::find_deforming(const Box3& box) {
    const DeformingColliders& deforming = view_.bodies().deforming();
    deforming_offset_ = deforming.offset_in(box);
    if (deforming_offset_ == 0.0) return;
    double by = rounding() + query_.beside;
    for (const BodyId body : lists_.near) by += 8.0 * tolerance_of(body);
    deforming.near(grown(box, 8.0 * by), deforming_);
    if (deforming_.empty()) deforming_offset_ = 0.0;
}

DerivativeBounds MovingSweep::world_bounds() const {
    const MotionBounds& frame = view_.bodies().bounds(view_.reference());
    DerivativeBounds bounds = product(frame.rotation, bounds_of(query_.path));
    for (std::size_t n = 0; n < bounds.size(); ++n) bounds[n] += frame.origin[n];
    return bounds;
}

/// Returns a bound of the path's fourth derivative in the coordinates of a body, in m/s^4.
double MovingSweep::fourth_derivative(BodyId body, const DerivativeBounds& world) const {
    const MotionBounds& frame = view_.bodies().bounds(body);
    DerivativeBounds relative = world;
    for (std::size_t n = 1; n < relative.size(); ++n) relative[n] += frame.origin[n];
    const Vec3 origin = view_.bodies().pose(body, view_.clock().begin).world_from_frame.translation;
    relative[0] = length(start_.world - origin) + relative[1] * query_.path.duration;
    return product(frame.rotation, relative)[4];
}

/// Returns the largest allowed deviation, in m, of a piece from the true path in the coordinates of a body.
double MovingSweep::tolerance_in(BodyId body) const {
    const CollisionWorld& world = view_.bodies().world(body);
    const Vec3 at = view_.local_position(body, start_.world, 0.0);
    const double size = std::max(max_abs(at), query_.radius);
    double tolerance = kMovingPathTolerance * size;
    if (!world.triangles().empty()) {
        const TriangleBvh& bvh = world.bvh_for(query_.radius);
        tolerance = std::min(tolerance, (bvh.margin() - query_.radius) / 64.0);
    }
    return std::max(tolerance, kSmallestContactOffset);
}

/// Returns tolerance_in(body), which is already known for bodies near the path.
double MovingSweep::tolerance_of(BodyId body) const {
    const auto found = std::find(lists_.near.begin(), lists_.near.end(), body);
    if (found == lists_.near.end()) return tolerance_in(body);
    return lists_.tolerances[static_cast<std::size_t>(found - lists_.near.begin())];
}

/// Returns the deviation of local positions from the path in a frame, and of safe positions from the path, in m. It
/// comes from rounding of the world's coordinates and of the frames' origins.
double MovingSweep::rounding() const {
    Vec3 largest = abs(start_.world) + abs(query_.path.end - query_.path.c[0]);
    const auto include = [&](BodyId body) {
        if (body == kWorldBody) return;
        const MovingPose pose = view_.bodies().pose(body, view_.clock().begin);
        largest = max(largest, abs(pose.world_from_frame.translation));
        const double path_length = view_.bodies().bounds(body).origin[1] * (view_.clock().end - view_.clock().begin);
        largest += Vec3{path_length, path_length, path_length};
    };
    include(view_.reference());
    for (const BodyId body : lists_.near) include(body);
    return kLargestContactOffsetUlps / kContactOffsetUlps * std::max(contact_offset(largest), deforming_offset_);
}

/// Returns the piece in the coordinates of a body.
Path MovingSweep::path_in(BodyId body, const MovingView& view, const PathPoint& start) const {
    const PathPoint end = view.point_at(piece_.end, piece_.duration);
    const Vec3 from = view.local_position(body, start.world, 0.0);
    const Vec3 to = view.local_position(body, end.world, piece_.duration);
    const Vec3 leaving = view.velocity_in(body, {start.position, 0.0, start.world}, piece_.velocity(0.0));
    if (!(piece_.duration > 0.0)) return line_path(from, leaving, 0.0);
    // If the piece is shorter than the resolution of the clock, the body jumps from one pose to the next. A cubic with
    // the velocities at both ends would then bend without limit.
    if (piece_.duration <= ulp(clock_.end)) return straight_path(from, to, piece_.duration);
    const Vec3 arriving = view.velocity_in(body, end, piece_.velocity(piece_.duration), MovingView::Limit::before);
    return hermite_path(from, leaving, to, arriving, piece_.duration);
}

/// Makes a contact found in the frame of a body the first contact if it is earlier, or merges it if it is simultaneous.
void MovingSweep::take(const Contact& found, BodyId body, const SurfaceGeometry& geometry, const MovingView& view,
                       std::optional<Contact>& first) const {
    Contact contact = found;
    if (body != view.reference()) {
        find_true_time(contact, body, geometry, view);
        for (int k = 0; k < contact.count; ++k) {
            Vec3& normal = contact.surfaces[static_cast<std::size_t>(k)].normal;
            normal = view.direction_from(body, normal, contact.time);
        }
    }
    merge(contact, first);
}

void MovingSweep::merge(Contact contact, std::optional<Contact>& first) const {
    if (!first) {
        first = contact;
        return;
    }
    if (contact.time < first->time) std::swap(contact, *first);
    if (contact.time > first->time + kSimultaneousUlps * ulp(first->time)) return;
    for (const ContactSurface& surface : contact.all()) {
        if (first->count == Contact::kMostSurfaces) break;
        first->surfaces[static_cast<std::size_t>(first->count++)] = surface;
    }
    const auto surfaces = std::span(first->surfaces).first(static_cast<std::size_t>(first->count));
    std::sort(surfaces.begin(), surfaces.end(), [](const auto& a, const auto& b) { return a.surface < b.surface; });
}

/// Finds the time of a contact on the true path by Newton's method on the distance. It starts from the time on the
/// cubic and ends when the distance is below the rounding of the coordinates.
void MovingSweep::find_true_time(Contact& contact, BodyId body, const SurfaceGeometry& geometry,
                                 const MovingView& view) const {
    const SurfaceId surface = contact.first().surface;
    const bool is_sphere = query_.radius > 0.0;
    const double most = 4.0 * tolerance_of(body);
    double time = contact.time;
    for (int k = 0; k < kNewtonSteps; ++k) {
        const PathPoint at = view.point_at(piece_.position(time), time);
        const Vec3 local_position = view.local_position(body, at.world, time);
        const Vec3 velocity = view.velocity_in(body, at, piece_.velocity(time));
        double height = 0.0;
        double rate = 0.0;
        if (is_sphere) {
            const CollisionWorld::Nearest nearest = geometry.nearest(surface, local_position);
            height = nearest.distance - query_.radius;
            rate = dot(velocity, nearest.normal);
        } else {
            height = geometry.signed_distance_from(surface, local_position);
            rate = dot(velocity, geometry.unit_normal_of(surface, local_position));
        }
        if (rate == 0.0 || std::fabs(height) > most) return;
        if (std::fabs(height) <= ulp(std::max(max_abs(local_position), query_.radius))) break;
        const double next = std::clamp(time - height / rate, 0.0, piece_.duration);
        if (std::fabs(next - contact.time) * std::fabs(rate) > most) return;
        const bool is_there = std::fabs(next - time) <= ulp(time);
        time = next;
        if (is_there) break;
    }
    contact.time = time;
    const Vec3 local_position = view.local_position(body, view.point_at(piece_.position(time), time).world, time);
    for (int k = 0; k < contact.count; ++k) {
        ContactSurface& touched = contact.surfaces[static_cast<std::size_t>(k)];
        const Vec3 normal = is_sphere ? geometry.nearest(touched.surface, local_position).normal
                                      : geometry.unit_normal_of(touched.surface, local_position);
        touched.normal = dot(normal, touched.normal) < 0.0 ? -normal : normal;
    }
}

/// Returns the distance from the path, in m, at which positions are queried. It covers the error of the cubics and
/// rounding.
double MovingSweep::beside_path() const {
    double tolerance = 0.0;
    for (const double one : lists_.tolerances) tolerance = std::max(tolerance, one);
    return 4.0 * tolerance + rounding();
}

void MovingSweep::set_piece(double to, const PathPoint& start) {
    piece_ = piece_of(query_.path, begin_, to, start.position);
    clock_ = view_.clock().piece(begin_, to);
    if (times_.empty()) return;
    clock_.begin = times_[next_ - 1];
    clock_.end = times_[next_];
}

ContactQueryResult MovingSweep::sweep(const PathPoint& start) {
    const double to = end_of_piece(start);
    set_piece(to, start);
    begin_ = to;
    if (to >= lists_.cuts[next_]) ++next_;
    const MovingView view(view_.bodies(), view_.reference(), clock_);
    const PathPoint first_point{start.position, 0.0, start.world};
    if (other_frames_) {
        other_frames_->restart(view, first_point);
    } else {
        other_frames_.emplace(view, first_point);
    }
    const double beside = query_.beside + beside_path_;
    ContactQueryResult own =
        find_first_contact(geometry_, {piece_, query_.radius, nullptr, {}, query_.supports, beside}, scratch_);
    meet_bodies(view, first_point, own.contact);
    if (!deforming_.empty()) meet_deforming(view, first_point, beside_in_bodies(), own.contact);
    own.near.join(*other_frames_);
    return own;
}

void MovingSweep::meet_bodies(const MovingView& view, const PathPoint& start, std::optional<Contact>& first) {
    const double beside = beside_in_bodies();
    while (scratch_.other_frames.size() < lists_.near.size())
        scratch_.other_frames.push_back(std::make_unique<ContactScratch>());
    for (std::size_t k = 0; k < lists_.near.size(); ++k) {
        ContactScratch& scratch = *scratch_.other_frames[k];
        const SurfaceGeometry geometry(view.bodies().world(lists_.near[k]), scratch.plane_cache);
        if (is_clear_ && geometry.world().culls()) {
            scratch.clear();
            const Path path = shortened(lists_.clear[k], piece_.duration);
            const QueryMargins margins(geometry.world(), path, query_.radius, lists_.besides[k]);
            other_frames_->add({lists_.near[k], path, {geometry, scratch, margins, path.c[0], CandidateSet::near}});
            continue;
        }
        const Path path = path_in(lists_.near[k], view, start);
        const ContactQueryResult found =
            find_first_contact(geometry, {path, query_.radius, nullptr, {}, query_.supports, beside}, scratch);
        if (found.contact) take(*found.contact, lists_.near[k], geometry, view, first);
        other_frames_->add({lists_.near[k], path, found.near});
    }
}

/// Tests deforming meshes. `beside` has the meaning of ContactQuery::beside.
void MovingSweep::meet_deforming(const MovingView& view, const PathPoint& start, double beside,
                                 std::optional<Contact>& first) {
    const DeformingColliders& deforming = view.bodies().deforming();
    const Path path = view.reference() == kWorldBody ? piece_ : path_in(kWorldBody, view, start);
    const DeformingSweep sweep(deforming, path, {clock_.begin, clock_.end}, query_.radius, query_.supports, beside);
    std::optional<Contact> contact = sweep.first_contact(
        deforming_, [&](const SurfacesInOtherFrames::Deforming& triangle) { other_frames_->add(triangle); });
    if (!contact) return;
    for (int k = 0; k < contact->count; ++k) {
        Vec3& normal = contact->surfaces[static_cast<std::size_t>(k)].normal;
        normal = view.direction_from(kWorldBody, normal, contact->time);
    }
    merge(*contact, first);
}

std::optional<Contact> MovingSweep::first_contact() {
    const MovingView view(view_.bodies(), view_.reference(), view_.clock());
    while (!is_done()) {
        const double from = begin_;
        std::optional<Contact> contact =
            sweep(from == 0.0 ? start_ : view.point_at(query_.path.position(from), from)).contact;
        if (!contact) continue;
        contact->time += from;
        return contact;
    }
    return std::nullopt;
}

}  // namespace ricochet
