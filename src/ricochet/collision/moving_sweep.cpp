#include "ricochet/collision/moving_sweep.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "ricochet/collision/broad_phase.h"
#include "ricochet/collision/deforming_sweep.h"
#include "ricochet/collision/look_ahead.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Number of Newton steps in the search for the true time of an impact. Each step squares the error.
constexpr int kNewtonSteps = 4;

/// Largest rest of a path, in fine pieces, that is swept as one fine piece, above 1 for rounding. Local: only for
/// speed.
constexpr double kAlmostOne = 1.0 + 1e-9;

/// Largest duration of a piece without contacts, in fine pieces. The error of its cubic is larger by the fourth power
/// of this number. Local, because boxes are enlarged by that error, so only the cost depends on it.
constexpr double kLongestPiece = 16.0;

/// Largest number of fine pieces in sequence before a longer one is tried again.
constexpr int kMostFinePieces = 64;

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

/// Replaces `first` by a contact that is earlier, or adds the surfaces of a contact that is simultaneous.
void merge(Contact contact, std::optional<Contact>& first) {
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
    std::sort(first->surfaces.begin(), first->surfaces.begin() + first->count,
              [](const auto& a, const auto& b) { return a.surface < b.surface; });
}

}  // namespace

/// Returns the end of the next piece, in s along the path: a fine one, a longer one without contacts, or the next cut.
double MovingSweep::end_of_piece(const PathPoint& start) {
    is_clear_ = false;
    const double cut = pieces_.cuts()[next_];
    if (!pieces_.deforming().empty()) return cut;
    const double whole = cut - pieces_.cuts()[next_ - 1];
    const double fine = whole / pieces_.count_within(whole);
    if (!(cut - begin_ > kAlmostOne * fine)) return cut;
    if (fine_left_ == 0) {
        const double clear = clear_until(start, fine);
        is_clear_ = clear > begin_;
        if (is_clear_) return clear;
        fine_left_ = fine_after_next_;
        fine_after_next_ = std::min(2 * fine_after_next_, kMostFinePieces);
    }
    --fine_left_;
    return begin_ + fine;
}

/// Returns the time, in s along the path, until which no surface of other frames comes near, or the start of the piece
/// if that is less than a fine piece away. The search ends where the cubics' errors exceed the margins of the boxes.
double MovingSweep::clear_until(const PathPoint& start, double fine) {
    double longest = kLongestPiece * fine;
    for (MovingPieces::NearBody& body : pieces_.bodies()) {
        const CollisionWorld& world = surfaces_.bodies().world(body.id);
        double error = kLongestPiece * kLongestPiece * kLongestPiece * kLongestPiece * body.tolerance;
        if (!world.triangles().empty()) {
            error = std::min(error, (world.bvh_for(query_.radius).margin() - query_.radius) / 32.0);
        }
        longest = std::min(longest, longest_cubic(error, body.fourth));
        // This cubic and the cubic that is swept later can deviate by `error` from the true path, to opposite sides.
        body.beside = beside_in_bodies() + 2.0 * error;
    }
    if (!(longest >= 2.0 * fine)) return begin_;
    set_piece(std::min(pieces_.cuts()[next_], begin_ + longest), start);
    const SurfacesInTime surfaces = at_piece();
    double clear = piece_.duration;
    for (MovingPieces::NearBody& body : pieces_.bodies()) {
        if (!(clear > 0.0)) break;
        const CollisionWorld& world = surfaces.bodies().world(body.id);
        body.clear = path_in(body.id, surfaces, {start.position, 0.0, start.world});
        const QueryMargins margins(world, body.clear, query_.radius, body.beside);
        clear = std::min(clear, time_clear_of(world, margins, body.clear, fine));
    }
    // Whole fine pieces: so the broad phase's roundings do not reach the ends of pieces, and through them the results.
    return clear < piece_.duration ? begin_ + std::floor(clear / fine) * fine : begin_ + piece_.duration;
}

void MovingSweep::set_piece(double to, const PathPoint& start) {
    piece_ = piece_of(query_.path, begin_, to, start.position);
    clock_ = pieces_.clock_of(begin_, to, next_);
}

/// Returns the piece in the coordinates of a body.
Path MovingSweep::path_in(BodyId body, const SurfacesInTime& surfaces, const PathPoint& start) const {
    const PathPoint end = surfaces.point_at(piece_.end, piece_.duration);
    const Vec3 from = surfaces.local_position(body, start.world, 0.0);
    const Vec3 to = surfaces.local_position(body, end.world, piece_.duration);
    const Vec3 leaving = surfaces.velocity_in(body, {start.position, 0.0, start.world}, piece_.velocity(0.0));
    if (!(piece_.duration > 0.0)) return line_path(from, leaving, 0.0);
    // If the piece is shorter than the resolution of the clock, the body jumps from one pose to the next. A cubic could
    // then have any curvature.
    if (piece_.duration <= ulp(clock_.end)) return straight_path(from, to, piece_.duration);
    const Vec3 arriving =
        surfaces.velocity_in(body, end, piece_.velocity(piece_.duration), SurfacesInTime::Limit::before);
    return hermite_path(from, leaving, to, arriving, piece_.duration);
}

ContactQueryResult MovingSweep::sweep(const PathPoint& start) {
    const double to = end_of_piece(start);
    set_piece(to, start);
    begin_ = to;
    if (to >= pieces_.cuts()[next_]) ++next_;
    const SurfacesInTime surfaces = at_piece();
    const PathPoint first_point{start.position, 0.0, start.world};
    if (other_frames_) {
        other_frames_->restart(surfaces, first_point);
    } else {
        other_frames_.emplace(surfaces, first_point);
    }
    const double beside = query_.beside + pieces_.beside();
    ContactQueryResult own =
        find_first_contact(geometry_, {piece_, query_.radius, nullptr, {}, query_.supports, beside}, scratch_);
    meet_bodies(surfaces, first_point, own.contact);
    if (!pieces_.deforming().empty()) meet_deforming(surfaces, first_point, own.contact);
    own.near.join(*other_frames_);
    return own;
}

void MovingSweep::meet_bodies(const SurfacesInTime& surfaces, const PathPoint& start, std::optional<Contact>& first) {
    const std::span<const MovingPieces::NearBody> bodies = pieces_.bodies();
    while (scratch_.other_frames.size() < bodies.size()) {
        scratch_.other_frames.push_back(std::make_unique<ContactScratch>());
    }
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        ContactScratch& scratch = *scratch_.other_frames[k];
        const SurfaceGeometry geometry(surfaces.bodies().world(bodies[k].id), scratch.plane_cache);
        if (is_clear_ && geometry.world().culls()) {
            scratch.clear();
            const Path path = shortened(bodies[k].clear, piece_.duration);
            const QueryMargins margins(geometry.world(), path, query_.radius, bodies[k].beside);
            other_frames_->add({bodies[k].id, path, {geometry, scratch, margins, path.c[0], CandidateSet::near}});
            continue;
        }
        const Path path = path_in(bodies[k].id, surfaces, start);
        ContactQueryResult found = find_first_contact(
            geometry, {path, query_.radius, nullptr, {}, query_.supports, beside_in_bodies()}, scratch);
        if (found.contact) {
            find_true_time(*found.contact, bodies[k].id, geometry, surfaces);
            take(*found.contact, bodies[k].id, surfaces, first);
        }
        other_frames_->add({bodies[k].id, path, found.near});
    }
}

void MovingSweep::meet_deforming(const SurfacesInTime& surfaces, const PathPoint& start,
                                 std::optional<Contact>& first) {
    const Path path = surfaces.reference() == kWorldBody ? piece_ : path_in(kWorldBody, surfaces, start);
    const DeformingSweep sweep(surfaces.bodies().deforming(), path, clock_, query_.radius, query_.supports,
                               beside_in_bodies());
    const std::optional<Contact> contact = sweep.first_contact(
        pieces_.deforming(), [&](const SurfacesInOtherFrames::Deforming& triangle) { other_frames_->add(triangle); });
    if (contact) take(*contact, kWorldBody, surfaces, first);
}

/// Merges a contact that was found in the coordinates of a body, or of the world, into `first`.
void MovingSweep::take(Contact contact, BodyId body, const SurfacesInTime& surfaces,
                       std::optional<Contact>& first) const {
    for (int k = 0; k < contact.count; ++k) {
        Vec3& normal = contact.surfaces[static_cast<std::size_t>(k)].normal;
        normal = surfaces.direction_from(body, normal, contact.time);
    }
    merge(contact, first);
}

/// Finds the time of a contact on the true path by Newton's method on the distance. It starts from the time on the
/// cubic and ends when the distance is below the rounding of the coordinates.
void MovingSweep::find_true_time(Contact& contact, BodyId body, const SurfaceGeometry& geometry,
                                 const SurfacesInTime& surfaces) const {
    const SurfaceId surface = contact.first().surface;
    const bool is_sphere = query_.radius > 0.0;
    const double most = 4.0 * pieces_.tolerance_of(body);
    double time = contact.time;
    for (int k = 0; k < kNewtonSteps; ++k) {
        const PathPoint at = surfaces.point_at(piece_.position(time), time);
        const Vec3 local_position = surfaces.local_position(body, at.world, time);
        const Vec3 velocity = surfaces.velocity_in(body, at, piece_.velocity(time));
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
    const Vec3 local_position =
        surfaces.local_position(body, surfaces.point_at(piece_.position(time), time).world, time);
    for (int k = 0; k < contact.count; ++k) {
        ContactSurface& touched = contact.surfaces[static_cast<std::size_t>(k)];
        const Vec3 normal = is_sphere ? geometry.nearest(touched.surface, local_position).normal
                                      : geometry.unit_normal_of(touched.surface, local_position);
        touched.normal = dot(normal, touched.normal) < 0.0 ? -normal : normal;
    }
}

std::optional<Contact> MovingSweep::first_contact() {
    while (!is_done()) {
        const double from = begin_;
        std::optional<Contact> contact =
            sweep(from == 0.0 ? start_ : surfaces_.point_at(query_.path.position(from), from)).contact;
        if (!contact) continue;
        contact->time += from;
        return contact;
    }
    return std::nullopt;
}

}  // namespace ricochet
