#include "ricochet/collision/moving_sweep.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "ricochet/collision/deforming_sweep.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Of a path's duration: as near to its ends as a key of a mesh that deforms may cut it.
constexpr double kLeastPart = 0x1p-45;

/// A cubic that has the values and velocities of a function at both ends of a time h is within h^4 / kHermiteError
/// times the fourth derivative of it.
constexpr double kHermiteError = 384.0;

/// What is left of a path may be so much longer than a fine piece, by rounding, and still be one.
constexpr double kAlmostOne = 1.0 + 1e-9;

/// Most fine pieces that a piece which meets nothing is as long as: its cubic may err by the fourth power of that more.
constexpr double kLongestPiece = 16.0;

/// Most fine pieces in a row before a longer one is tried again.
constexpr int kMostFinePieces = 64;

/// Newton steps in search of the true time of an impact; each leaves the square of what was wrong.
constexpr int kNewtonSteps = 4;

/// The piece of a path between two times, from a start that may differ by rounding.
Path piece_of(const Path& path, double from, double to, const Vec3& start) {
    Path piece = path;
    piece.c[0] = start;
    piece.c[1] = path.velocity(from);
    piece.c[2] = path.c[2] + (3.0 * from) * path.c[3];
    piece.duration = to - from;
    piece.end = path.position(to);
    return piece;
}

Box3 grown(const Box3& box, double margin) {
    const Vec3 by{margin, margin, margin};
    return {box.lower - by, box.upper + by};
}

Box3 box_of(const Path& path, double margin) {
    Box3 box;
    for (const Vec3& point : path.control_points()) box.include(point);
    box.include(path.end);
    return grown(box, margin);
}

/// Bounds of the derivatives of a path.
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

MovingSweep::MovingSweep(const MovingView& view, const SurfaceGeometry& geometry, const ContactQuery& query,
                         const WayPoint& start, ContactScratch& scratch)
    : view_(view),
      geometry_(geometry),
      query_(query),
      start_(start),
      scratch_(scratch),
      lists_(std::exchange(scratch.sweep, {})) {
    find_near();
    cut();
}

/// By the box of the path in the world; seen from a body everything may be near.
void MovingSweep::find_near() {
    const MovingColliders& bodies = view_.bodies();
    const double largest = largest_coordinate(query_.path);
    Box3 box = box_of(query_.path, query_.radius + kCandidateSlack * (largest + query_.radius));
    if (view_.home() != kAtRest) {
        const double from_origin = largest + query_.radius;
        box = {};
        // Between the ends the frame moves by no more than its speed allows.
        const MotionBounds& bounds = bodies.bounds(view_.home());
        const double way = query_.path.duration *
                           (bounds.origin[1] + bounds.rotation[1] * 2.0 * from_origin + bounds_of(query_.path)[1]);
        const double margin = way + query_.radius + kCandidateSlack * (max_abs(start_.world) + query_.radius);
        const Vec3 by{margin, margin, margin};
        box.include(start_.world - by);
        box.include(start_.world + by);
    }
    lists_.near.clear();
    lists_.tolerances.clear();
    bodies.near(box, view_.home(), lists_.near);
    for (const BodyId body : lists_.near) lists_.tolerances.push_back(tolerance_in(body));
    if (!bodies.deforming().empty()) find_deforming(box);
}

/// With those within reach of all positions that are tried beside the path.
void MovingSweep::find_deforming(const Box3& box) {
    const DeformingColliders& deforming = view_.bodies().deforming();
    if (deforming.stay_out(box)) return;
    deforming.near(box, deforming_);
    double by = rounding() + query_.beside;
    for (const BodyId body : lists_.near) by += 8.0 * tolerance_of(body);
    deforming_.clear();
    deforming.near(grown(box, 8.0 * by), deforming_);
}

DerivativeBounds MovingSweep::world_bounds() const {
    const MotionBounds& frame = view_.bodies().bounds(view_.home());
    DerivativeBounds bounds = product(frame.rotation, bounds_of(query_.path));
    for (std::size_t n = 0; n < bounds.size(); ++n) bounds[n] += frame.origin[n];
    return bounds;
}

/// A bound of that of the path in the coordinates of a body, m/s^4.
double MovingSweep::fourth_derivative(BodyId body, const DerivativeBounds& world) const {
    const MotionBounds& frame = view_.bodies().bounds(body);
    DerivativeBounds relative = world;
    for (std::size_t n = 1; n < relative.size(); ++n) relative[n] += frame.origin[n];
    const Vec3 origin = view_.bodies().pose(body, view_.clock().begin).world_from_frame.translation;
    relative[0] = length(start_.world - origin) + relative[1] * query_.path.duration;
    return product(frame.rotation, relative)[4];
}

/// m, by which a body may see a piece of the path beside where it is.
double MovingSweep::tolerance_in(BodyId body) const {
    const CollisionWorld& world = view_.bodies().world(body);
    const Vec3 at = view_.image(body, start_.world, 0.0);
    const double size = std::max(max_abs(at), query_.radius);
    double tolerance = kMovingPathTolerance * size;
    if (!world.triangles().empty()) {
        const TriangleBvh& bvh = world.bvh_for(query_.radius);
        tolerance = std::min(tolerance, (bvh.margin() - query_.radius) / 64.0);
    }
    return std::max(tolerance, kSmallestContactOffset);
}

/// The same, known already of one that is near.
double MovingSweep::tolerance_of(BodyId body) const {
    const auto found = std::find(lists_.near.begin(), lists_.near.end(), body);
    if (found == lists_.near.end()) return tolerance_in(body);
    return lists_.tolerances[static_cast<std::size_t>(found - lists_.near.begin())];
}

/// m, by which the images of stored positions may lie beside the path in a frame, and safe positions further: by the
/// rounding of the world's coordinates and of the frames' origins.
double MovingSweep::rounding() const {
    Vec3 largest = abs(start_.world) + abs(query_.path.end - query_.path.c[0]);
    const auto include = [&](BodyId body) {
        if (body == kAtRest) return;
        const MovingPose pose = view_.bodies().pose(body, view_.clock().begin);
        largest = max(largest, abs(pose.world_from_frame.translation));
        const double way = view_.bodies().bounds(body).origin[1] * (view_.clock().end - view_.clock().begin);
        largest += Vec3{way, way, way};
    };
    include(view_.home());
    for (const BodyId body : lists_.near) include(body);
    double offset = contact_offset(largest);
    for (const SurfaceId surface : deforming_) {
        offset = std::max(offset, view_.bodies().deforming().offset_of(surface));
    }
    return kLargestContactOffsetUlps / kContactOffsetUlps * offset;
}

/// At the keys of all bodies that are near, and evenly between them.
void MovingSweep::cut() {
    const double duration = query_.path.duration;
    const PathClock& clock = view_.clock();
    if (view_.home() == kAtRest && lists_.near.empty() && deforming_.empty()) {
        lists_.cuts.assign({0.0, duration});
        return;
    }
    std::vector<double>& keys = lists_.keys;
    keys.assign(1, 0.0);
    const auto add_keys = [&](BodyId body) {
        double key = view_.bodies().next_key(body, clock.begin);
        for (int count = 0; count < kMostKeysInStep && key < clock.end;
             ++count, key = view_.bodies().next_key(body, key)) {
            const double at = key - clock.base - clock.offset;
            if (at > 0.0 && at < duration) keys.push_back(at);
        }
    };
    add_keys(view_.home());
    for (const BodyId body : lists_.near) add_keys(body);
    for (const double key : deforming_keys()) keys.push_back(path_time_of(key));
    keys.push_back(duration);
    std::sort(keys.begin(), keys.end());
    find_rates();
    lists_.cuts.assign(1, 0.0);
    for (const double key : keys) {
        if (key > lists_.cuts.back()) lists_.cuts.push_back(key);
    }
    if (lists_.cuts.size() == 1) lists_.cuts.push_back(duration);
    if (deforming_.empty()) return;
    cut_finely();
    set_times();
}

void MovingSweep::find_rates() {
    lists_.fourth.clear();
    rate_ = 0.0;
    if (lists_.near.empty() && deforming_.empty()) return;
    const DerivativeBounds world = world_bounds();
    const auto rate_of = [](double fourth, double tolerance) {
        return std::sqrt(std::sqrt(fourth / (kHermiteError * tolerance)));
    };
    for (const BodyId body : lists_.near) {
        lists_.fourth.push_back(fourth_derivative(body, world));
        rate_ = std::max(rate_, rate_of(lists_.fourth.back(), tolerance_of(body)));
    }
    if (view_.home() != kAtRest && !deforming_.empty()) {
        rate_ = std::max(rate_, rate_of(fourth_derivative(kAtRest, world), tolerance_of(kAtRest)));
    }
}

double MovingSweep::pieces_within(double span) const {
    return std::clamp(std::ceil(span * rate_), 1.0, kMostMovingPieces);
}

void MovingSweep::cut_finely() {
    const std::vector<double> keys = std::exchange(lists_.cuts, {0.0});
    for (std::size_t k = 1; k < keys.size(); ++k) {
        const double span = keys[k] - keys[k - 1];
        const double count = pieces_within(span);
        for (double i = 1.0; i < count; ++i) lists_.cuts.push_back(keys[k - 1] + span * (i / count));
        lists_.cuts.push_back(keys[k]);
    }
}

/// s along the path: the next cut, or before that as far as a fine piece goes, or one that meets nothing.
double MovingSweep::end_of_piece(const WayPoint& start) {
    is_clear_ = false;
    const double cut = lists_.cuts[next_];
    if (!deforming_.empty()) return cut;
    const double whole = cut - lists_.cuts[next_ - 1];
    const double fine = whole / pieces_within(whole);
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

/// s along the path until which nothing of other frames comes near it; where it begins when that is less than a fine
/// piece. Looks as far as cubics are within what the boxes of all bodies leave for that.
double MovingSweep::clear_until(const WayPoint& start, double fine) {
    double longest = kLongestPiece * fine;
    std::vector<double>& besides = lists_.besides;
    besides.clear();
    for (std::size_t k = 0; k < lists_.near.size(); ++k) {
        const CollisionWorld& world = view_.bodies().world(lists_.near[k]);
        double error = kLongestPiece * kLongestPiece * kLongestPiece * kLongestPiece * lists_.tolerances[k];
        if (!world.triangles().empty()) {
            error = std::min(error, (world.bvh_for(query_.radius).margin() - query_.radius) / 32.0);
        }
        longest = std::min(longest, std::sqrt(std::sqrt(kHermiteError * error / lists_.fourth[k])));
        // The pieces that are made of it lie as far beside the true way on its other side.
        besides.push_back(beside_in_bodies() + 2.0 * error);
    }
    if (!(longest >= 2.0 * fine)) return begin_;
    set_piece(std::min(lists_.cuts[next_], begin_ + longest), start);
    const MovingView view(view_.bodies(), view_.home(), clock_);
    double clear = piece_.duration;
    for (std::size_t k = 0; k < lists_.near.size() && clear > 0.0; ++k) {
        const CollisionWorld& world = view.bodies().world(lists_.near[k]);
        const Path path = path_in(lists_.near[k], view, {start.position, 0.0, start.world});
        const QueryMargins margins(world, path, query_.radius, besides[k]);
        clear = std::min(clear, time_clear_of(world, margins, path, fine));
    }
    return clear < piece_.duration ? begin_ + clear : begin_ + piece_.duration;
}

/// s, all keys of meshes that deform within the path's time, where some are near.
std::vector<double> MovingSweep::deforming_keys() const {
    std::vector<double> keys;
    if (deforming_.empty()) return keys;
    const DeformingColliders& deforming = view_.bodies().deforming();
    const PathClock& clock = view_.clock();
    for (double key = deforming.next_key(clock.begin); key < clock.end; key = deforming.next_key(key)) {
        keys.push_back(key);
    }
    return keys;
}

/// Of a key within the path's time: inside the path, also where rounding has it at its ends.
double MovingSweep::path_time_of(double key) const {
    const PathClock& clock = view_.clock();
    const double least = kLeastPart * query_.path.duration;
    return std::clamp(key - clock.base - clock.offset, least, query_.path.duration - least);
}

/// Pieces that end at a key end at its very time.
void MovingSweep::set_times() {
    const PathClock& clock = view_.clock();
    const std::vector<double> keys = deforming_keys();
    times_.clear();
    for (const double cut : lists_.cuts) times_.push_back(clock.at(cut));
    times_.back() = clock.end;
    for (const double key : keys) {
        const auto at = std::find(lists_.cuts.begin(), lists_.cuts.end(), path_time_of(key)) - lists_.cuts.begin();
        for (std::ptrdiff_t k = 0; k < std::ssize(times_); ++k) {
            double& time = times_[static_cast<std::size_t>(k)];
            time = k < at ? std::min(time, key) : (k > at ? std::max(time, key) : key);
        }
    }
}

/// The piece as a body sees it.
Path MovingSweep::path_in(BodyId body, const MovingView& view, const WayPoint& start) const {
    const WayPoint end = view.point_at(piece_.end, piece_.duration);
    const Vec3 from = view.image(body, start.world, 0.0);
    const Vec3 to = view.image(body, end.world, piece_.duration);
    const Vec3 leaving = view.velocity_in(body, {start.position, 0.0, start.world}, piece_.velocity(0.0));
    if (!(piece_.duration > 0.0)) return line_path(from, leaving, 0.0);
    const Vec3 arriving = view.velocity_in(body, end, piece_.velocity(piece_.duration), MovingView::Limit::before);
    return hermite_path(from, leaving, to, arriving, piece_.duration);
}

/// Makes a contact with a body, whose path it was found on, the first one where it is, or a part of it.
void MovingSweep::take(const Contact& found, BodyId body, const MovingView& view, std::optional<Contact>& first) const {
    Contact contact = found;
    if (body != view.home()) {
        find_true_time(contact, body, view);
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

/// By Newton's method on the distance along the true way, from the time on the cubic.
void MovingSweep::find_true_time(Contact& contact, BodyId body, const MovingView& view) const {
    const CollisionWorld& world = view.bodies().world(body);
    const SurfaceId surface = contact.first().surface;
    const double most = 4.0 * tolerance_of(body);
    double time = contact.time;
    for (int k = 0; k < kNewtonSteps; ++k) {
        const WayPoint at = view.point_at(piece_.position(time), time);
        const Vec3 image = view.image(body, at.world, time);
        const Vec3 velocity = view.velocity_in(body, at, piece_.velocity(time));
        double height = 0.0;
        double rate = 0.0;
        if (query_.radius > 0.0) {
            const CollisionWorld::Nearest nearest = world.nearest(surface, image);
            height = nearest.distance - query_.radius;
            rate = dot(velocity, nearest.normal);
        } else {
            height = world.signed_distance_from(surface, image);
            rate = dot(velocity, world.unit_normal_of(surface, image));
        }
        if (rate == 0.0 || std::fabs(height) > most) return;
        const double next = std::clamp(time - height / rate, 0.0, piece_.duration);
        if (std::fabs(next - contact.time) * std::fabs(rate) > most) return;
        const bool is_there = std::fabs(next - time) <= ulp(time);
        time = next;
        if (is_there) break;
    }
    contact.time = time;
    const Vec3 image = view.image(body, view.point_at(piece_.position(time), time).world, time);
    for (int k = 0; k < contact.count; ++k) {
        ContactSurface& touched = contact.surfaces[static_cast<std::size_t>(k)];
        const Vec3 normal = query_.radius > 0.0 ? world.nearest(touched.surface, image).normal
                                                : world.unit_normal_of(touched.surface, image);
        touched.normal = dot(normal, touched.normal) < 0.0 ? -normal : normal;
    }
}

/// m, as far as positions beside the path here may lie beside the cubics that bodies see.
double MovingSweep::beside_in_bodies() const { return 2.0 * (query_.beside + beside_path()); }

/// m, by which what is asked about lies beside the path here: what a body sees beside its cubic.
double MovingSweep::beside_path() const {
    double tolerance = 0.0;
    for (const double one : lists_.tolerances) tolerance = std::max(tolerance, one);
    return 4.0 * tolerance + rounding();
}

void MovingSweep::set_piece(double to, const WayPoint& start) {
    piece_ = piece_of(query_.path, begin_, to, start.position);
    clock_ = view_.clock().piece(begin_, to);
    if (times_.empty()) return;
    clock_.begin = times_[next_ - 1];
    clock_.end = times_[next_];
}

ContactQueryResult MovingSweep::sweep(const WayPoint& start) {
    const double to = end_of_piece(start);
    set_piece(to, start);
    begin_ = to;
    if (to >= lists_.cuts[next_]) ++next_;
    const MovingView view(view_.bodies(), view_.home(), clock_);
    const WayPoint first_point{start.position, 0.0, start.world};
    if (foreign_) {
        foreign_->restart(view, first_point);
    } else {
        foreign_.emplace(view, first_point);
    }
    const double beside = query_.beside + beside_path();
    ContactQueryResult own =
        find_first_contact(geometry_, {piece_, query_.radius, nullptr, {}, query_.held, beside}, scratch_);
    meet_bodies(view, first_point, own.contact);
    if (!deforming_.empty()) meet_deforming(view, first_point, beside_in_bodies(), own.contact);
    own.near.join(*foreign_);
    return own;
}

void MovingSweep::meet_bodies(const MovingView& view, const WayPoint& start, std::optional<Contact>& first) {
    const double beside = beside_in_bodies();
    while (scratch_.foreign.size() < lists_.near.size()) scratch_.foreign.push_back(std::make_unique<ContactScratch>());
    for (std::size_t k = 0; k < lists_.near.size(); ++k) {
        ContactScratch& scratch = *scratch_.foreign[k];
        const SurfaceGeometry geometry(view.bodies().world(lists_.near[k]), scratch.plane_cache);
        const Path path = path_in(lists_.near[k], view, start);
        if (is_clear_) {
            scratch.clear();
            const QueryMargins margins(geometry.world(), path, query_.radius, beside);
            foreign_->add({lists_.near[k], path, {geometry, scratch, margins, path.c[0], CandidateSet::near}});
            continue;
        }
        const ContactQueryResult found =
            find_first_contact(geometry, {path, query_.radius, nullptr, {}, query_.held, beside}, scratch);
        if (found.contact) take(*found.contact, lists_.near[k], view, first);
        foreign_->add({lists_.near[k], path, found.near});
    }
}

/// beside: m, as far beside the path positions may be asked about.
void MovingSweep::meet_deforming(const MovingView& view, const WayPoint& start, double beside,
                                 std::optional<Contact>& first) {
    const DeformingColliders& deforming = view.bodies().deforming();
    const Path path = view.home() == kAtRest ? piece_ : path_in(kAtRest, view, start);
    const DeformingSweep sweep(deforming, path, {clock_.begin, clock_.end}, query_.radius, query_.held, beside);
    std::optional<Contact> contact =
        sweep.first_contact(deforming_, [&](const ForeignSurfaces::Deforming& triangle) { foreign_->add(triangle); });
    if (!contact) return;
    for (int k = 0; k < contact->count; ++k) {
        Vec3& normal = contact->surfaces[static_cast<std::size_t>(k)].normal;
        normal = view.direction_from(kAtRest, normal, contact->time);
    }
    merge(*contact, first);
}

std::optional<Contact> MovingSweep::first_contact() {
    const MovingView view(view_.bodies(), view_.home(), view_.clock());
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
