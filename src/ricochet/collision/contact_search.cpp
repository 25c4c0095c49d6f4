#include "ricochet/collision/contact_search.h"

#include <algorithm>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {
namespace {

/// Halvings of a path in search of pieces flat enough for the boxes. Only pieces near the triangles are halved; a path
/// that bends so much that this is not enough is tested against every triangle.
constexpr int kPieceDepth = 40;

/// Looks at how far a sphere is from a triangle that it comes near, each from where the one before says that it may be
/// near. Fewer: steps in which it is searched for in vain. More: each costs some hundred operations.
constexpr int kLooksAtDistance = 4;

/// What a further look may gain is not worth it when the last one has gained less than this part of a step.
constexpr double kLittleOfAStep = 0x1p-5;

double largest_coordinate(const Path& path) {
    const double h = path.duration;
    Vec3 magnitude = abs(path.c[0]);
    double power = h;
    for (int k = 1; k <= path.degree; ++k, power *= h) magnitude += power * abs(path.c[static_cast<std::size_t>(k)]);
    return max_abs(magnitude);
}

/// Edges and vertices met together with a face that has the same normal are seams of a flat surface.
void drop_seams(std::vector<ContactScratch::Found>& found) {
    const auto faces_end = std::partition(found.begin(), found.end(), [](const auto& f) { return f.flat; });
    const auto is_seam = [&](const ContactScratch::Found& f) {
        return std::any_of(found.begin(), faces_end, [&](const ContactScratch::Found& face) {
            return length_squared(face.normal - f.normal) < 2.0 * kSeamTurn;
        });
    };
    found.erase(std::remove_if(faces_end, found.end(), is_seam), found.end());
}

/// The latest time that counts as the same.
double latest_with(double first) { return first + kSimultaneousUlps * ulp(first); }

Vec3 facing(const Vec3& normal, int side, const Vec3& v) {
    if (side != 0) return side > 0 ? normal : -normal;
    const double speed = length(v);
    return speed > 0.0 ? v / -speed : normal;
}

}  // namespace

Vec3 facing_normal(const CollisionWorld& world, SurfaceId surface, int side, const Vec3& p, const Vec3& v) {
    return facing(world.unit_normal_of(surface, p), side, v);
}

std::optional<Contact> ContactSearch::search(const Path& path, double radius, const LookAhead* look_ahead,
                                             const ContactCandidates& candidates) {
    begin(path, radius);
    search_planes(path);
    search_shapes(path);
    if (candidates.is_known()) look_at_awaited(path, candidates);
    if (!candidates.is_known() || scratch_.found.empty()) search_triangles_of(path, look_ahead);
    if (scratch_.found.empty()) return std::nullopt;
    free_until_ = candidates_until_ = 0.0;
    return first_of_found(path);
}

/// Forgets the last search.
void ContactSearch::begin(const Path& path, double radius) {
    scratch_.triangles.clear();
    scratch_.planes.clear();
    scratch_.shapes.clear();
    scratch_.overlapped.clear();
    scratch_.found.clear();
    scratch_.ahead.clear();
    const double largest = largest_coordinate(path);
    radius_ = radius;
    tolerance_ = radius > 0.0 ? sphere_tolerance(radius, largest) : 0.0;
    slack_ = kCandidateSlack * (largest + radius) + kLargestContactOffsetUlps * kSmallestContactOffset;
    first_time_ = std::numeric_limits<double>::infinity();
    start_ = path.c[0];
    sphere_.reset();
    if (radius > 0.0) sphere_.emplace(path, radius);
    bvh_ = &world_.bvh_for(radius);
    bulge_ = bvh_->margin() - radius;
    largest_ = largest;
    all_triangles_ = false;
    free_until_ = candidates_until_ = 0.0;
}

// Where none of them is met the particle has passed them by, and what comes then is not known: the boxes are asked.
void ContactSearch::look_at_awaited(const Path& path, const ContactCandidates& candidates) {
    for (const std::uint32_t triangle : candidates.triangles()) (void)look_at_triangle(path, triangle);
    if (scratch_.found.empty()) scratch_.triangles.clear();
}

void ContactSearch::search_triangles_of(const Path& path, const LookAhead* look_ahead) {
    if (look_ahead != nullptr && scratch_.found.empty()) look_past_planes_and_shapes(*look_ahead);
    if (world_.triangles().empty()) return;
    const bool can_look = free_until_ > 0.0 && world_.culls();
    const bool looks_ahead = can_look && (look_ahead->path.degree > 1 ? look_along_parabola(path, *look_ahead)
                                                                      : look_along_line(path, *look_ahead));
    if (looks_ahead) return;
    free_until_ = 0.0;
    search_meshes(path);
}

/// Paths so long that their rounding exceeds what the boxes leave for it are tested against every triangle.
void ContactSearch::search_meshes(const Path& path) {
    if (world_.culls() && kPathRounding * largest_ <= bvh_->slack()) {
        search_triangles(path, 0.0, path.duration, kPieceDepth);
    } else if (!world_.culls() || may_reach_triangles(path, 0.0, path.duration)) {
        search_all_triangles(path);
    }
}

// For shapes there is no time, only a yes or no: durations are tried, each half of the one before.
void ContactSearch::look_past_planes_and_shapes(const LookAhead& look_ahead) {
    free_until_ = look_ahead.path.duration;
    const double margin = radius_ + look_ahead.margin;
    for (const auto& [plane, surface] : world_.planes()) {
        free_until_ = std::min(free_until_, time_free_of_plane(look_ahead.path, plane, margin));
    }
    for (const auto& [shape, surface] : world_.shapes()) {
        while (free_until_ >= look_ahead.least && !shape.can_cull(shortened(look_ahead.path, free_until_), margin)) {
            free_until_ *= 0.5;
        }
    }
    if (free_until_ < look_ahead.least) free_until_ = 0.0;
}

/// Where paths may come near triangles.
Box3 ContactSearch::box_of_interest(const LookAhead& look_ahead) const {
    const double margin = 2.0 * (radius_ + look_ahead.margin + bulge_);
    const Vec3 by{margin, margin, margin};
    return {world_.triangle_bounds().lower - by, world_.triangle_bounds().upper + by};
}

bool ContactSearch::boxes_hold(const Path& path, double duration) const {
    return kPathRounding * largest_coordinate(shortened(path, duration)) <= bvh_->slack();
}

/// False when the path has still to be searched. A straight way that leaves all triangles behind is free for good.
bool ContactSearch::look_along_line(const Path& path, const LookAhead& look_ahead) {
    const double end = std::min(end_of_look(look_ahead), time_of_leaving(look_ahead.path, box_of_interest(look_ahead)));
    if (!(look_ahead.margin < bulge_) || !boxes_hold(look_ahead.path, end)) return false;
    if (end == 0.0) return true;  // it does not come near the triangles
    look_along_stretch(path, look_ahead, 0.0, end);
    keep_candidates(std::min(end, end_of_interest(path, look_ahead)));
    return true;
}

/// The same along a bent way. While it is beyond one side of all triangles nothing need be asked. Free space is crossed
/// in strides. Where triangles are near, the boxes are asked about stretch by stretch: over one, the path, the foreseen
/// one and all their chords of a step stay within what the boxes leave beside the segment that is asked about. Where
/// that is not even a step, only the free space beyond the path's end is looked through.
bool ContactSearch::look_along_parabola(const Path& path, const LookAhead& look_ahead) {
    const double outside = time_outside(look_ahead.path, box_of_interest(look_ahead));
    if (outside >= look_ahead.least) {
        free_until_ = std::min(free_until_, outside);
        return true;
    }
    const double end = end_of_look(look_ahead);
    if (!boxes_hold(look_ahead.path, end)) return false;
    const double margin = margin_of(look_ahead, end);
    const double bend = length(look_ahead.path.c[2]);  // the sagitta over t is bend t^2 / 4; twice that must do
    const double stretch = std::sqrt(2.0 * std::max(0.0, bulge_ - look_ahead.margin) / bend);
    if (!(stretch >= look_ahead.least)) {
        search_meshes(path);
        free_until_ =
            std::min(free_until_, time_clear_of_field(look_ahead.path, world_.distance_field(), margin, path.duration));
        return true;
    }
    double seen = 0.0;
    while (seen < end && scratch_.ahead.empty() && scratch_.found.empty()) {
        seen = std::min(end, time_clear_of_field(look_ahead.path, world_.distance_field(), margin, seen));
        const double next = std::min(seen + stretch, end);
        if (seen < end) look_along_stretch(path, look_ahead, seen, next);
        seen = next;
    }
    keep_candidates(std::min(seen, end_of_interest(path, look_ahead)));
    return true;
}

// A triangle that is near the way only after the path's end is no candidate for the path, and one that is near it only
// before that end, or is left behind, does not matter to what comes after.
void ContactSearch::look_along_stretch(const Path& path, const LookAhead& look_ahead, double from, double to) {
    const double span = to - from;
    const Tube tube(look_ahead.path.position(from), look_ahead.path.position(to), margin_of(look_ahead, to),
                    span * span * look_ahead.path.c[2]);
    bvh_->query_tube(tube, [&](std::uint32_t triangle, double enter, double leave) {
        if (!world_.is_left_out(triangle)) {
            const bool is_near = from + enter * span <= path.duration;
            const double speed = is_near ? look_at_triangle(path, triangle) : 0.0;
            const bool is_ahead = from + leave * span >= path.duration && !leaves_for_good(speed, look_ahead);
            if (is_ahead && scratch_.found.empty()) {
                const double last = std::min(from + leave * span, end_of_interest(path, look_ahead));
                note_ahead(triangle, look_ahead, from + enter * span, last);
            }
        }
        const double until = std::min(first_time_, end_of_interest(path, look_ahead));
        return until < to ? std::max(0.0, (until - from) / span) : 1.0;
    });
}

/// m, how near to the look_ahead's path until some time triangles are of interest.
double ContactSearch::margin_of(const LookAhead& look_ahead, double until) const {
    const Box3& box = world_.triangle_bounds();
    const double largest =
        std::max({largest_coordinate(shortened(look_ahead.path, until)), max_abs(box.lower), max_abs(box.upper)});
    return radius_ + look_ahead.margin + kLookAheadSlack * largest;
}

double ContactSearch::end_of_look(const LookAhead& look_ahead) const {
    return std::min(free_until_ + look_ahead.beyond, look_ahead.path.duration);
}

double ContactSearch::end_of_interest(const Path& path, const LookAhead& look_ahead) const {
    return std::max(free_until_, path.duration) + look_ahead.beyond;
}

void ContactSearch::note_ahead(std::uint32_t triangle, const LookAhead& look_ahead, double enter, double last) {
    const double begin = sphere_ ? time_of_approach(triangle, look_ahead, enter, last) : enter;
    if (begin > last) return;
    free_until_ = std::min(free_until_, begin);
    scratch_.ahead.push_back({triangle, begin});
}

// What the boxes say about a sphere is how it passes the triangle's plane, and beside the triangle it does that early.
// Along a direction in which the triangle is behind, the distance shrinks no faster than the sphere goes against it
// (conservative advancement: B. Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems", PhD thesis, Berkeley
// 1996, section 2.3). The speed along a direction is linear in time, so it is largest at an end.
/// A time before which the sphere certainly does not come near the triangle, s along the look_ahead's path; later than
/// `last` when it does not until then.
double ContactSearch::time_of_approach(std::uint32_t triangle, const LookAhead& look_ahead, double enter,
                                       double last) const {
    const Path& path = look_ahead.path;
    const auto [a, b, c] = world_.corners_of_triangle(triangle);
    const double near = margin_of(look_ahead, last);
    const Vec3 last_velocity = path.velocity(last);
    double time = enter;
    for (int look = 0; look < kLooksAtDistance && time <= last; ++look) {
        const Vec3 place = path.position(time);
        const Vec3 away = separating_direction(place, a, b, c);
        const double distance = distance_lower_bound(away, place, a, b, c);
        if (!(distance > near)) break;
        const double approach = -std::min(dot(away, path.velocity(time)), dot(away, last_velocity)) / length(away);
        if (!(approach > 0.0)) return std::numeric_limits<double>::infinity();
        const double gain = (distance - near) / approach;
        time += gain;
        if (gain < kLittleOfAStep * look_ahead.least) break;
    }
    return time;
}

void ContactSearch::keep_candidates(double until) {
    candidates_until_ = until;
    candidates_ = ContactCandidates::none();
    // What is met first makes short work of the others.
    std::sort(scratch_.ahead.begin(), scratch_.ahead.end(),
              [](const auto& x, const auto& y) { return x.enter < y.enter; });
    for (const auto& [triangle, enter] : scratch_.ahead) {
        if (enter <= until && candidates_.is_known()) candidates_.add(triangle);
    }
}

void ContactSearch::note(const ContactScratch::Found& found) {
    scratch_.found.push_back(found);
    if (!(found.time < first_time_)) return;
    first_time_ = found.time;
    if (sphere_) sphere_->shorten_to(latest_with(first_time_));
}

void ContactSearch::note_overlap(SurfaceId surface, double distance) {
    if (radius_ > 0.0 && distance < radius_ - tolerance_) scratch_.overlapped.push_back(surface);
}

void ContactSearch::search_planes(const Path& path) {
    const auto planes = world_.planes();
    for (std::uint32_t k = 0; k < planes.size(); ++k) {
        const auto& [plane, surface] = planes[k];
        if (stays_on_one_side(path, plane, radius_ + slack_)) continue;
        scratch_.planes.push_back(k);
        if (radius_ == 0.0) {
            if (const auto crossing = first_crossing(path, plane))
                note({crossing->time, surface, crossing->side, true, {}});
        } else {
            note_overlap(surface, std::fabs(signed_distance(start_, plane)));
            const auto contact = sphere_->first_contact(plane);
            if (contact) note({contact->time, surface, 0, true, contact->normal});
        }
    }
}

void ContactSearch::search_shapes(const Path& path) {
    const auto shapes = world_.shapes();
    for (std::uint32_t k = 0; k < shapes.size(); ++k) {
        const auto& [shape, surface] = shapes[k];
        if (shape.can_cull(path, radius_ + slack_)) continue;
        scratch_.shapes.push_back(k);
        if (radius_ > 0.0) note_overlap(surface, std::fabs(shape.closest_point(start_).distance));
        const auto contact = shape.first_contact(path, radius_);
        if (contact) note({contact->time, surface, shape.side(start_), false, contact->normal});
    }
}

// A point of a chord lies within the chord's sagitta of the path, and that point of the path within its piece's sagitta
// of the piece's chord; together they must stay within what the boxes leave for it.
bool ContactSearch::covers_chord(const Path& path, double from, double to) const {
    return all_triangles_ || path.degree < 2 || world_.triangles().empty() || 2.0 * path.sagitta(from, to) <= bulge_ ||
           !may_reach_triangles(path, from, to);
}

// The bulge keeps chords that begin on such a piece and end on the next one away from the triangles too.
bool ContactSearch::may_reach_triangles(const Path& path, double from, double to) const {
    Box3 box;
    box.include(path.position(from));
    box.include(path.position(to));
    const double margin = path.sagitta(from, to) + slack_ + bulge_ + radius_;
    const Vec3 by{margin, margin, margin};
    const Box3& triangles = world_.triangle_bounds();
    const Vec3 gap = max(box.lower - by - triangles.upper, triangles.lower - (box.upper + by));
    return std::max({gap.x, gap.y, gap.z}) <= 0.0;
}

void ContactSearch::search_all_triangles(const Path& path) {
    all_triangles_ = true;
    for (std::uint32_t triangle = 0; triangle < world_.triangles().size(); ++triangle) {
        (void)look_at_triangle(path, triangle);
    }
}

// Pieces are visited in the order of time, so a contact ends the search. How the path is cut serves the boxes only:
// every triangle is judged on the whole path.
void ContactSearch::search_triangles(const Path& path, double from, double to, int depth) {
    if (from > first_time_ || all_triangles_) return;
    if (path.degree == 2) {
        const double clear = time_clear_of_field(path, world_.distance_field(), margin_of(path), from);
        if (clear > from && clear >= to) return;
        from = clear;
    }
    if (!covers_chord(path, from, to)) {
        if (depth == 0) {
            search_all_triangles(path);
            return;
        }
        const double middle = 0.5 * (from + to);
        search_triangles(path, from, middle, depth - 1);
        search_triangles(path, middle, to, depth - 1);
        return;
    }
    const double span = to - from;
    // Chords of the path that covers_chord() lets pass are covered too.
    const bool is_parabola = path.degree == 2;
    const double beside_piece = is_parabola ? 0.0 : path.sagitta(from, to);
    const double margin = margin_of(path) + beside_piece;
    const Tube tube(path.position(from), path.position(to), margin, is_parabola ? span * span * path.c[2] : Vec3{});
    bvh_->query_tube(tube, [&](std::uint32_t triangle, double /*enter*/, double /*leave*/) {
        (void)look_at_triangle(path, triangle);
        return first_time_ < to ? std::max(0.0, (first_time_ - from) / span) : 1.0;
    });
}

/// m, how near to the path candidates may be: what its chords that covers_chord() lets pass may meet are among them.
double ContactSearch::margin_of(const Path& path) const {
    return radius_ + 2.0 * slack_ + std::min(path.sagitta(0.0, path.duration), 0.5 * bulge_);
}

/// Where a sphere goes straight away from the triangle: the speed of that, m/s. Else 0.
double ContactSearch::look_at_triangle(const Path& path, std::uint32_t triangle) {
    if (world_.is_left_out(triangle)) return 0.0;
    if (sphere_) return look_with_sphere(triangle);
    look_with_point(path, triangle);
    return 0.0;
}

void ContactSearch::look_with_point(const Path& path, std::uint32_t triangle) {
    const TrianglePlane& plane = plane_of(triangle);
    if (stays_on_one_side(path, plane, slack_)) return;
    scratch_.triangles.push_back(triangle);
    const auto crossing = first_crossing(path, plane, latest_with(first_time_));
    if (crossing) note({crossing->time, world_.surface_of_triangle(triangle), crossing->side, true, {}});
}

double ContactSearch::look_with_sphere(std::uint32_t triangle) {
    const auto [a, b, c] = world_.corners_of_triangle(triangle);
    if (sphere_->can_cull(a, b, c)) return 0.0;
    const bool starts_near = !sphere_->starts_separated_from(a, b, c);
    const double speed = starts_near ? sphere_->separating_speed(a, b, c) : 0.0;
    if (sphere_->can_cull_at_end(a, b, c)) return speed;
    scratch_.triangles.push_back(triangle);
    if (speed > 0.0) return speed;
    const SurfaceId surface = world_.surface_of_triangle(triangle);
    if (starts_near) {
        const ClosestPointOnTriangle nearest = closest_point_on_triangle(start_, a, b, c);
        note_overlap(surface, std::sqrt(nearest.distance_squared));
        if (sphere_->is_separating_from(nearest, a, b, c)) {
            return dot(nearest.offset, sphere_->path().c[1]) / std::sqrt(nearest.distance_squared);
        }
    }
    const auto contact = sphere_->narrow_phase_contact(plane_of(triangle));
    if (contact) note({contact->time, surface, 0, contact->feature == TriangleFeature::kFace, contact->normal});
    return 0.0;
}

// The steps to come are rounded. Each must lead away from the triangle by more than that, else they may lead back
// through it; and what is parked elsewhere on the way must not be moved through it.
/// May a triangle be forgotten that a sphere leaves behind at some speed, m/s?
bool ContactSearch::leaves_for_good(double speed, const LookAhead& look_ahead) const {
    if (speed == 0.0 || look_ahead.path.degree > 1 || !(radius_ > look_ahead.margin)) return false;
    return speed * look_ahead.least > kPathRounding * largest_coordinate(look_ahead.path);
}

Vec3 ContactSearch::unit_normal_of(SurfaceId surface, const Vec3& p) const {
    const auto triangle = world_.triangle_of(surface);
    return triangle ? plane_of(*triangle).unit_normal() : world_.unit_normal_of(surface, p);
}

double ContactSearch::signed_distance_from(SurfaceId surface, const Vec3& p) const {
    const auto triangle = world_.triangle_of(surface);
    return triangle ? plane_of(*triangle).signed_distance(p) : world_.signed_distance_from(surface, p);
}

CollisionWorld::Nearest ContactSearch::nearest(SurfaceId surface, const Vec3& p) const {
    const auto triangle = world_.triangle_of(surface);
    return triangle ? CollisionWorld::nearest(plane_of(*triangle), p) : world_.nearest(surface, p);
}

Contact ContactSearch::first_of_found(const Path& path) const {
    Contact contact;
    contact.time = first_time_;
    const double latest = latest_with(first_time_);
    auto& found = scratch_.found;
    std::erase_if(found, [&](const auto& f) { return f.time > latest; });
    // A surface that a point meets rim-on answers only when nothing is met from a side.
    const auto has_side = [&](const auto& f) { return f.side != 0 || radius_ > 0.0; };
    if (std::any_of(found.begin(), found.end(), has_side)) {
        std::erase_if(found, [&](const auto& f) { return !has_side(f); });
    }
    if (radius_ > 0.0) drop_seams(found);
    std::sort(found.begin(), found.end(), [](const auto& f, const auto& g) { return f.surface < g.surface; });
    const Vec3 place = path.position(first_time_);
    const Vec3 velocity = path.velocity(first_time_);
    for (std::size_t k = 0; k < found.size() && contact.count < Contact::kMostSurfaces; ++k) {
        if (k > 0 && found[k].surface == found[k - 1].surface) continue;
        const auto& f = found[k];
        const bool ready = radius_ > 0.0 || !f.flat;
        const Vec3 normal = ready ? f.normal : facing(unit_normal_of(f.surface, place), f.side, velocity);
        contact.surfaces[static_cast<std::size_t>(contact.count++)] = {f.surface, normal, f.flat};
    }
    return contact;
}

bool ContactSearch::is_overlapped(SurfaceId surface) const {
    const auto& list = scratch_.overlapped;
    return std::find(list.begin(), list.end(), surface) != list.end();
}

bool ContactSearch::starts_in_overlap() const {
    return radius_ > 0.0 ? !scratch_.overlapped.empty() : blocker(start_, start_).has_value();
}

bool ContactSearch::plane_blocks(const CollisionWorld::PlaneSurface& plane, const Vec3& p, const Vec3& q) const {
    if (side_of(plane.plane, p) * side_of(plane.plane, q) <= 0) return true;
    if (radius_ == 0.0 || is_overlapped(plane.surface)) return false;
    const double nearest =
        std::min(std::fabs(signed_distance(p, plane.plane)), std::fabs(signed_distance(q, plane.plane)));
    return nearest < radius_ - tolerance_;
}

bool ContactSearch::shape_blocks(const CollisionWorld::ShapeSurface& shape, const Vec3& p, const Vec3& q) const {
    if (!shape.shape.segment_is_clear(p, q)) return true;
    if (radius_ == 0.0 || is_overlapped(shape.surface)) return false;
    return shape.shape.distance_to_segment(p, q) < radius_ - tolerance_;
}

bool ContactSearch::triangle_blocks(std::uint32_t triangle, const Vec3& p, const Vec3& q) const {
    if (radius_ == 0.0) return plane_of(triangle).intersects_segment(p, q);
    const auto [a, b, c] = world_.corners_of_triangle(triangle);
    if (segment_intersects_triangle(p, q, a, b, c)) return true;
    if (sphere_segment_is_clear(p, q, radius_, tolerance_, a, b, c)) return false;
    return !is_overlapped(world_.surface_of_triangle(triangle));
}

std::optional<SurfaceId> ContactSearch::blocker(const Vec3& p, const Vec3& q) const {
    std::optional<SurfaceId> smallest;
    const auto consider = [&](SurfaceId surface) {
        if (!smallest || surface < *smallest) smallest = surface;
    };
    for (const std::uint32_t k : scratch_.planes) {
        if (plane_blocks(world_.planes()[k], p, q)) consider(world_.planes()[k].surface);
    }
    for (const std::uint32_t k : scratch_.shapes) {
        if (shape_blocks(world_.shapes()[k], p, q)) consider(world_.shapes()[k].surface);
    }
    for (const std::uint32_t triangle : scratch_.triangles) {
        if (triangle_blocks(triangle, p, q)) consider(world_.surface_of_triangle(triangle));
    }
    return smallest;
}

std::vector<SurfaceId> ContactSearch::gathered() const {
    std::vector<SurfaceId> surfaces;
    for (const std::uint32_t k : scratch_.planes) surfaces.push_back(world_.planes()[k].surface);
    for (const std::uint32_t k : scratch_.shapes) surfaces.push_back(world_.shapes()[k].surface);
    for (const std::uint32_t triangle : scratch_.triangles) surfaces.push_back(world_.surface_of_triangle(triangle));
    std::sort(surfaces.begin(), surfaces.end());
    surfaces.erase(std::unique(surfaces.begin(), surfaces.end()), surfaces.end());
    return surfaces;
}

std::vector<SurfaceId> ContactSearch::surfaces_at(const Vec3& p) const {
    std::vector<SurfaceId> surfaces = gathered();
    std::erase_if(surfaces, [&](SurfaceId surface) { return !world_.point_on(surface, p); });
    return surfaces;
}

bool ContactSearch::is_free_after(const Vec3& p, const Vec3& q) const {
    const std::vector<SurfaceId> surfaces = gathered();
    return std::all_of(surfaces.begin(), surfaces.end(), [&](SurfaceId surface) {
        if (!world_.segment_meets(surface, p, q)) return true;
        return world_.point_on(surface, p) && world_.side_of_surface(surface, q) != 0;
    });
}

bool ContactSearch::is_free(const Vec3& p, const Vec3& q) const {
    const auto none = [](const auto& list, const auto& blocks) {
        return std::none_of(list.begin(), list.end(), blocks);
    };
    return none(scratch_.planes, [&](std::uint32_t k) { return plane_blocks(world_.planes()[k], p, q); }) &&
           none(scratch_.shapes, [&](std::uint32_t k) { return shape_blocks(world_.shapes()[k], p, q); }) &&
           none(scratch_.triangles, [&](std::uint32_t t) { return triangle_blocks(t, p, q); });
}

}  // namespace ricochet
