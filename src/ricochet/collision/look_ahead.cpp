#include "ricochet/collision/look_ahead.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {

namespace {

/// Bound of the relative rounding error of times. Distance margins are far larger. Local: an error bound of this
/// arithmetic.
constexpr double kTimeRounding = 0x1p-40;

/// Largest number of sphere tracing steps in one call. A field of a thousand cells is crossed in fewer steps, except
/// along walls. Local, because only the cost depends on it.
constexpr int kMostTracingSteps = 64;

}  // namespace

Path shortened(const Path& path, double duration) {
    Path shorter = path;
    shorter.end = path.position(duration);
    shorter.duration = std::min(duration, path.duration);
    return shorter;
}

// Solves for the first root of g0 + g1 t + g2 t^2, the height above the margin on the side of the start. The formula
// avoids cancellation (e.g. Higham, "Accuracy and Stability of Numerical Algorithms", section 1.8).
double time_free_of_plane(const Path& path, const Plane& plane, double margin) {
    const Vec3 start = path.c[0] - plane.point;
    const double height = dot(plane.normal, start);
    const double side = height < 0.0 ? -1.0 : 1.0;
    // The margin covers rounding of the path only. The height also has an error proportional to the distance along the
    // plane. The height is computed by a difference, a product and two sums: less than five roundings of each
    // component. Local: an error bound of this arithmetic.
    constexpr double kHeightError = 16.0 * 0x1p-53;
    const double g0 = side * height - margin - kHeightError * dot(abs(plane.normal), abs(start));
    const double g1 = side * dot(plane.normal, path.c[1]);
    const double g2 = side * dot(plane.normal, path.c[2]);
    if (!(g0 > 0.0)) return 0.0;
    const double discriminant = g1 * g1 - 4.0 * g0 * g2;
    if (!(discriminant >= 0.0) || (g1 >= 0.0 && g2 >= 0.0)) return path.duration;
    const double root = std::sqrt(discriminant);
    const double time = g1 < 0.0 ? 2.0 * g0 / (root - g1) : (g1 + root) / (-2.0 * g2);
    return std::min(path.duration, (1.0 - kTimeRounding) * time);
}

double time_outside(const Path& path, const Box3& box) {
    constexpr std::array kAxes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    double longest = 0.0;
    for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
        const Vec3& normal = kAxes[axis];
        const double coordinate = dot(normal, path.c[0]);
        const bool is_below = coordinate < dot(normal, box.lower);
        if (!is_below && coordinate <= dot(normal, box.upper)) continue;
        const Plane face{is_below ? box.lower : box.upper, normal};
        longest = std::max(longest, time_free_of_plane(path, face, 0.0));
    }
    return longest;
}

// Within a time t the particle moves at most v t + a t^2 / 2. The step is the time t at which this distance equals the
// clearance, computed without cancellation.
double time_clear_of_field(const Path& path, const DistanceField& field, double margin, double from) {
    double acceleration = 2.0 * length(path.c[2]);
    if (path.degree > 2) {
        acceleration = std::max(acceleration, length(2.0 * path.c[2] + (6.0 * path.duration) * path.c[3]));
    }
    double time = from;
    for (int step = 0; step < kMostTracingSteps && time < path.duration; ++step) {
        const double clearance = field.lower_bound(path.position(time)) - margin;
        if (!(clearance > 0.0)) break;
        const double speed = length(path.velocity(time));
        const double sum = speed + std::sqrt(speed * speed + 2.0 * acceleration * clearance);
        time += (1.0 - kTimeRounding) * (2.0 * clearance / sum);
    }
    return std::min(time, path.duration);
}

double time_of_leaving(const Path& path, const Box3& box) {
    if (path.degree > 1) return path.duration;
    double enter = 0.0;
    double leave = path.duration;
    for (int axis = 0; axis < 3; ++axis) {
        const double speed = path.c[1][axis];
        const double below = box.lower[axis] - path.c[0][axis];
        const double above = box.upper[axis] - path.c[0][axis];
        if (speed == 0.0) {
            if (below > 0.0 || above < 0.0) return 0.0;
            continue;
        }
        enter = std::max(enter, std::min(below / speed, above / speed));
        leave = std::min(leave, std::max(below / speed, above / speed));
    }
    return enter > leave ? 0.0 : std::min(path.duration, (1.0 + kTimeRounding) * leave);
}

namespace {

/// Number of steps of conservative advancement of a sphere towards a triangle. Fewer: more time steps make unnecessary
/// queries for the sphere. More: each costs some hundred operations. Local, because only the cost depends on it.
constexpr int kAdvancementSteps = 4;

/// Advancement stops when the last step has gained less than this fraction of a time step. Local, because only the cost
/// depends on it.
constexpr double kLittleOfAStep = 0x1p-5;

/// The state of one look-ahead.
class LookAheadQuery {
public:
    LookAheadQuery(const CollisionWorld& world, const QueryMargins& margins, const Path& path, const LookAhead& ahead,
                   NarrowPhase& narrow_phase, ContactScratch& scratch)
        : world_(world),
          margins_(margins),
          path_(path),
          ahead_(ahead),
          narrow_phase_(narrow_phase),
          scratch_(scratch) {}

    [[nodiscard]] LookAheadOutcome run();

private:
    void advance_past_planes_and_shapes();
    [[nodiscard]] bool query_line();
    [[nodiscard]] bool query_parabola();
    void query_piece(double from, double to);
    void add_approach(std::uint32_t triangle, double enter, double last);
    void keep_candidates(double until);
    [[nodiscard]] double time_of_approach(std::uint32_t triangle, double enter, double last) const;
    [[nodiscard]] bool is_left_behind(double separating_speed) const;
    [[nodiscard]] Box3 box_of_interest() const;
    [[nodiscard]] bool boxes_hold(double duration) const;
    [[nodiscard]] double margin_until(double time) const;
    [[nodiscard]] double end_of_query() const;
    [[nodiscard]] double end_of_interest() const;

    const CollisionWorld& world_;
    const QueryMargins& margins_;
    const Path& path_;
    const LookAhead& ahead_;
    NarrowPhase& narrow_phase_;
    ContactScratch& scratch_;
    LookAheadResult result_;
    CandidateSet candidates_ = CandidateSet::near;
};

LookAheadOutcome LookAheadQuery::run() {
    advance_past_planes_and_shapes();
    if (world_.triangles().empty()) return {result_, candidates_};
    if (result_.free_until > 0.0 && world_.culls()) {
        const bool is_tested = ahead_.path.degree > 1 ? query_parabola() : query_line();
        if (is_tested) return {result_, candidates_};
    }
    return {};
}

// The test of a shape does not return a time, so the search halves the duration until the path is clear of the shape.
void LookAheadQuery::advance_past_planes_and_shapes() {
    double& free_until = result_.free_until;
    free_until = ahead_.path.duration;
    const double margin = margins_.radius + ahead_.margin;
    for (const auto& [plane, surface] : world_.planes()) {
        free_until = std::min(free_until, time_free_of_plane(ahead_.path, plane, margin));
    }
    for (const auto& [shape, surface] : world_.shapes()) {
        while (free_until >= ahead_.least && !shape.can_cull(shortened(ahead_.path, free_until), margin)) {
            free_until *= 0.5;
        }
    }
    if (free_until < ahead_.least) free_until = 0.0;
}

/// Returns the box in which paths may come near triangles.
Box3 LookAheadQuery::box_of_interest() const {
    const double margin = 2.0 * (margins_.radius + ahead_.margin + margins_.curvature);
    const Vec3 by{margin, margin, margin};
    return {world_.triangle_bounds().lower - by, world_.triangle_bounds().upper + by};
}

bool LookAheadQuery::boxes_hold(double duration) const {
    return kPathRounding * largest_coordinate(shortened(ahead_.path, duration)) <= margins_.bvh->slack();
}

// A straight path that has left the box around all triangles stays free.
bool LookAheadQuery::query_line() {
    const double end = std::min(end_of_query(), time_of_leaving(ahead_.path, box_of_interest()));
    if (!(ahead_.margin < margins_.curvature) || !boxes_hold(end)) return false;
    if (end == 0.0) return true;  // the path does not come near the triangles
    query_piece(0.0, end);
    keep_candidates(std::min(end, end_of_interest()));
    return true;
}

// While a parabola is beyond one face of the box around all triangles, it needs no query. Otherwise sphere tracing
// crosses free space, and near triangles the broad phase is queried piece by piece. Over one piece, three curves stay
// within the margin of the boxes: the query's path, the look-ahead's path and their chords of a step. If such a piece
// is shorter than a step, only the free space beyond the path's end is traced.
bool LookAheadQuery::query_parabola() {
    const double outside = time_outside(ahead_.path, box_of_interest());
    if (outside >= ahead_.least) {
        result_.free_until = std::min(result_.free_until, outside);
        return true;
    }
    const double end = end_of_query();
    if (!boxes_hold(end)) return false;
    const double margin = margin_until(end);
    // A chord over a time t has a sagitta of |c2| t^2 / 4. Twice that must fit into the remaining margin for curvature.
    const double piece = std::sqrt(2.0 * std::max(0.0, margins_.curvature - ahead_.margin) / length(ahead_.path.c[2]));
    if (!(piece >= ahead_.least)) {
        candidates_ = test_triangles_near(world_, margins_, path_, narrow_phase_);
        result_.free_until = std::min(
            result_.free_until, time_clear_of_field(ahead_.path, world_.distance_field(), margin, path_.duration));
        return true;
    }
    double done = 0.0;
    while (done < end && scratch_.approaches.empty() && !narrow_phase_.has_hit()) {
        done = std::min(end, time_clear_of_field(ahead_.path, world_.distance_field(), margin, done));
        const double next = std::min(done + piece, end);
        if (done < end) query_piece(done, next);
        done = next;
    }
    keep_candidates(std::min(done, end_of_interest()));
    return true;
}

// A triangle that is near only after the end of the query's path is no candidate of that path. A triangle that is near
// only before that end, or is left behind, is no candidate of later steps.
void LookAheadQuery::query_piece(double from, double to) {
    const double span = to - from;
    const Tube tube(ahead_.path.position(from), ahead_.path.position(to), margin_until(to),
                    span * span * ahead_.path.c[2]);
    margins_.bvh->query_tube(tube, [&](std::uint32_t triangle, double enter, double leave) {
        if (!world_.is_degenerate(triangle)) {
            const bool is_near_path = from + enter * span <= path_.duration;
            const double speed = is_near_path ? narrow_phase_.test_triangle(triangle) : 0.0;
            const bool is_ahead = from + leave * span >= path_.duration && !is_left_behind(speed);
            if (is_ahead && !narrow_phase_.has_hit()) {
                add_approach(triangle, from + enter * span, std::min(from + leave * span, end_of_interest()));
            }
        }
        const double until = std::min(narrow_phase_.first_time(), end_of_interest());
        return until < to ? std::max(0.0, (until - from) / span) : 1.0;
    });
}

/// Returns the distance, in m, from the look-ahead's path within which triangles must be considered until a given time.
double LookAheadQuery::margin_until(double time) const {
    const Box3& box = world_.triangle_bounds();
    const double largest =
        std::max({largest_coordinate(shortened(ahead_.path, time)), max_abs(box.lower), max_abs(box.upper)});
    return margins_.radius + ahead_.margin + kLookAheadSlack * largest;
}

double LookAheadQuery::end_of_query() const {
    return std::min(result_.free_until + ahead_.beyond, ahead_.path.duration);
}

double LookAheadQuery::end_of_interest() const { return std::max(result_.free_until, path_.duration) + ahead_.beyond; }

void LookAheadQuery::add_approach(std::uint32_t triangle, double enter, double last) {
    const double begin = margins_.radius > 0.0 ? time_of_approach(triangle, enter, last) : enter;
    if (begin > last) return;
    result_.free_until = std::min(result_.free_until, begin);
    scratch_.approaches.push_back({triangle, begin});
}

/// Returns a time before which the sphere certainly does not come near the triangle. It is later than `last` if the
/// sphere does not come near until then.
///
/// The boxes only bound the time at which the sphere reaches the triangle's plane. If the sphere passes beside the
/// triangle, that time is too early. Conservative advancement improves it: along a direction that separates sphere and
/// triangle, the distance shrinks no faster than the sphere moves against the direction (B. Mirtich, "Impulse-based
/// Dynamic Simulation of Rigid Body Systems", PhD thesis, Berkeley 1996, section 2.3). The speed along a direction is
/// linear in time, so it is largest at an end of the interval.
double LookAheadQuery::time_of_approach(std::uint32_t triangle, double enter, double last) const {
    const Path& path = ahead_.path;
    const auto [a, b, c] = world_.corners_of_triangle(triangle);
    const double near = margin_until(last);
    const Vec3 last_velocity = path.velocity(last);
    double time = enter;
    for (int step = 0; step < kAdvancementSteps && time <= last; ++step) {
        const Vec3 position = path.position(time);
        const Vec3 away = separating_direction(position, a, b, c);
        const double distance = distance_lower_bound(away, position, a, b, c);
        if (!(distance > near)) break;
        const double approach = -std::min(dot(away, path.velocity(time)), dot(away, last_velocity)) / length(away);
        if (!(approach > 0.0)) return std::numeric_limits<double>::infinity();
        const double gain = (distance - near) / approach;
        time += gain;
        if (gain < kLittleOfAStep * ahead_.least) break;
    }
    return time;
}

void LookAheadQuery::keep_candidates(double until) {
    result_.candidates_until = until;
    result_.candidates = ContactCandidates::none();
    // Sorts by time, because an early hit shortens the tests of the remaining triangles.
    std::sort(scratch_.approaches.begin(), scratch_.approaches.end(),
              [](const auto& a, const auto& b) { return a.begin < b.begin; });
    for (const auto& [triangle, begin] : scratch_.approaches) {
        if (begin <= until && result_.candidates.is_known()) result_.candidates.add(triangle);
    }
}

/// Returns true if a triangle can be dropped because a sphere leaves it behind at the given speed, in m/s.
///
/// Reason: the positions after the following steps are rounded. Each step must lead away from the triangle by more than
/// the rounding error. Otherwise rounding could move the sphere back through the triangle. A safe position elsewhere on
/// the path must not lie beyond the triangle either. If the path is only a forecast, the sphere may turn back.
bool LookAheadQuery::is_left_behind(double separating_speed) const {
    const bool may_turn = ahead_.path.degree > 1 || ahead_.deviation > 0.0;
    if (separating_speed == 0.0 || may_turn || !(margins_.radius > ahead_.margin)) return false;
    return separating_speed * ahead_.least > kPathRounding * largest_coordinate(ahead_.path);
}

}  // namespace

LookAheadOutcome test_triangles_and_look_ahead(const CollisionWorld& world, const QueryMargins& margins,
                                               const Path& path, const LookAhead& ahead, NarrowPhase& narrow_phase,
                                               ContactScratch& scratch) {
    return LookAheadQuery(world, margins, path, ahead, narrow_phase, scratch).run();
}

}  // namespace ricochet
