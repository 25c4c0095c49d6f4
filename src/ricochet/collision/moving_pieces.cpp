#include "ricochet/collision/moving_pieces.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/pair_sweep.h"

namespace ricochet {
namespace {

/// Least time between a deforming mesh's key and an end of the path, as a part of its duration. Local: a guard.
constexpr double kLeastPart = 0x1p-45;

/// Divisor in the error bound of a cubic Hermite path: over a time h it deviates from the function by at most h^4 /
/// kHermiteError times the largest fourth derivative. Local: a bound of this interpolation.
constexpr double kHermiteError = 384.0;

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

double longest_cubic(double error, double fourth) { return std::sqrt(std::sqrt(kHermiteError * error / fourth)); }

MovingPieces::MovingPieces(const SurfacesInTime& surfaces, const ContactQuery& query, const PathPoint& start,
                           ContactScratch& scratch)
    : surfaces_(surfaces), query_(query), start_(start), scratch_(scratch), lists_(std::exchange(scratch.sweep, {})) {
    find_bodies();
    double tolerance = 0.0;
    for (const NearBody& body : lists_.bodies) tolerance = std::max(tolerance, body.tolerance);
    beside_ = 4.0 * tolerance + rounding();
    cut();
}

/// Finds the bodies near the path by a box in the world that contains all positions that the path can reach.
void MovingPieces::find_bodies() {
    const MovingColliders& bodies = surfaces_.bodies();
    Box3 box = reach_of(query_.path, query_.radius);
    if (surfaces_.reference() != kWorldBody) {
        const double from_origin = largest_coordinate(query_.path) + query_.radius;
        // Between the ends the frame moves by no more than its speed allows.
        const MotionBounds& bounds = bodies.bounds(surfaces_.reference());
        const double path_length = query_.path.duration * (bounds.origin[1] + bounds.rotation[1] * 2.0 * from_origin +
                                                           bounds_of(query_.path)[1]);
        const double margin = path_length + query_.radius + kCandidateSlack * (max_abs(start_.world) + query_.radius);
        box = ball_box(start_.world, margin);
    }
    lists_.near.clear();
    lists_.bodies.clear();
    bodies.near(box, surfaces_.reference(), lists_.near);
    for (const BodyId body : lists_.near) lists_.bodies.push_back({body, tolerance_in(body), 0.0, 0.0, {}});
    if (!bodies.deforming().empty()) find_deforming(box);
}

/// Finds the deforming triangles near the path, and near all positions beside the path that may be tested.
void MovingPieces::find_deforming(const Box3& box) {
    const DeformingColliders& deforming = surfaces_.bodies().deforming();
    deforming_offset_ = deforming.offset_in(box);
    if (deforming_offset_ == 0.0) return;
    double by = rounding() + query_.beside;
    for (const NearBody& body : lists_.bodies) by += 8.0 * body.tolerance;
    deforming.near(grown(box, 8.0 * by), deforming_);
    if (deforming_.empty()) deforming_offset_ = 0.0;
}

/// Returns a bound, in m/s^4, of the path's fourth derivative for a body. world: bounds of its derivatives in the
/// world.
double MovingPieces::fourth_derivative(BodyId body, const DerivativeBounds& world) const {
    const MovingColliders& bodies = surfaces_.bodies();
    const MotionBounds& frame = bodies.bounds(body);
    DerivativeBounds relative = world;
    for (std::size_t n = 1; n < relative.size(); ++n) relative[n] += frame.origin[n];
    const Vec3 origin = bodies.pose(body, surfaces_.clock().begin).world_from_frame.translation;
    relative[0] = length(start_.world - origin) + relative[1] * query_.path.duration;
    return product(frame.rotation, relative)[4];
}

double MovingPieces::tolerance_in(BodyId body) const {
    const CollisionWorld& world = surfaces_.bodies().world(body);
    const Vec3 at = surfaces_.local_position(body, start_.world, 0.0);
    const double size = std::max(max_abs(at), query_.radius);
    double tolerance = kMovingPathTolerance * size;
    if (!world.triangles().empty()) {
        const TriangleBvh& bvh = world.bvh_for(query_.radius);
        tolerance = std::min(tolerance, (bvh.margin() - query_.radius) / 64.0);
    }
    return std::max(tolerance, kSmallestContactOffset);
}

double MovingPieces::tolerance_of(BodyId body) const {
    const auto found = std::ranges::find_if(lists_.bodies, [&](const NearBody& near) { return near.id == body; });
    return found == lists_.bodies.end() ? tolerance_in(body) : found->tolerance;
}

/// Returns the largest deviation, in m, of local positions from the path in a frame, and of safe positions from the
/// path. It results from rounding of the world's coordinates and of the frames' origins.
double MovingPieces::rounding() const {
    Vec3 largest = abs(start_.world) + abs(query_.path.end - query_.path.c[0]);
    const MovingColliders& bodies = surfaces_.bodies();
    const PathClock& clock = surfaces_.clock();
    const auto include = [&](BodyId body) {
        if (!bodies.has_frame(body)) return;
        largest = max(largest, abs(bodies.pose(body, clock.begin).world_from_frame.translation));
        const double path_length = bodies.bounds(body).origin[1] * (clock.end - clock.begin);
        largest += Vec3{path_length, path_length, path_length};
    };
    include(surfaces_.reference());
    for (const NearBody& body : lists_.bodies) include(body.id);
    return kLargestContactOffsetUlps / kContactOffsetUlps * std::max(contact_offset(largest), deforming_offset_);
}

/// Cuts the path at the keys of all nearby bodies. If deforming meshes are near, also cuts it evenly between the keys.
void MovingPieces::cut() {
    const double duration = query_.path.duration;
    const PathClock& clock = surfaces_.clock();
    if (surfaces_.reference() == kWorldBody && lists_.bodies.empty() && deforming_.empty()) {
        lists_.cuts.assign({0.0, duration});
        return;
    }
    std::vector<double>& keys = lists_.keys;
    keys.assign(1, 0.0);
    const auto add_keys = [&](BodyId body) {
        double key = surfaces_.bodies().next_key(body, clock.begin);
        for (int count = 0; count < kMostKeysInStep && key < clock.end;
             ++count, key = surfaces_.bodies().next_key(body, key)) {
            const double at = key - clock.base - clock.offset;
            if (at > 0.0 && at < duration) keys.push_back(at);
        }
    };
    add_keys(surfaces_.reference());
    for (const NearBody& body : lists_.bodies) add_keys(body.id);
    for (const double key : deforming_keys()) keys.push_back(path_time_of(key));
    keys.push_back(duration);
    std::ranges::sort(keys);
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

void MovingPieces::find_rates() {
    if (lists_.bodies.empty() && deforming_.empty()) return;
    const MotionBounds& frame = surfaces_.bodies().bounds(surfaces_.reference());
    DerivativeBounds world = product(frame.rotation, bounds_of(query_.path));
    for (std::size_t n = 1; n < world.size(); ++n) world[n] += frame.origin[n];
    const auto include = [&](double fourth, double tolerance) {
        rate_ = std::max(rate_, std::sqrt(std::sqrt(fourth / (kHermiteError * tolerance))));
    };
    for (NearBody& body : lists_.bodies) {
        body.fourth = fourth_derivative(body.id, world);
        include(body.fourth, body.tolerance);
    }
    if (surfaces_.reference() != kWorldBody && !deforming_.empty()) {
        include(fourth_derivative(kWorldBody, world), tolerance_of(kWorldBody));
    }
}

double MovingPieces::count_within(double span) const {
    return std::clamp(std::ceil(span * rate_), 1.0, kMostMovingPieces);
}

void MovingPieces::cut_finely() {
    const std::vector<double> keys = std::exchange(lists_.cuts, {0.0});
    for (std::size_t k = 1; k < keys.size(); ++k) {
        const double span = keys[k] - keys[k - 1];
        const double count = count_within(span);
        for (double i = 1.0; i < count; ++i) lists_.cuts.push_back(keys[k - 1] + span * (i / count));
        lists_.cuts.push_back(keys[k]);
    }
}

/// Returns all keys of deforming meshes within the path's time, in s, if such a mesh is near.
std::vector<double> MovingPieces::deforming_keys() const {
    std::vector<double> keys;
    if (deforming_.empty()) return keys;
    const DeformingColliders& deforming = surfaces_.bodies().deforming();
    const PathClock& clock = surfaces_.clock();
    for (double key = deforming.next_key(clock.begin); key < clock.end; key = deforming.next_key(key)) {
        keys.push_back(key);
    }
    return keys;
}

/// Returns the time of a key along the path. The result is inside the path even if rounding would put it at an end.
double MovingPieces::path_time_of(double key) const {
    const PathClock& clock = surfaces_.clock();
    const double least = kLeastPart * query_.path.duration;
    return std::clamp(key - clock.base - clock.offset, least, query_.path.duration - least);
}

/// Sets the simulation times of the cuts. A piece that ends at a key ends exactly at the key's time.
void MovingPieces::set_times() {
    const PathClock& clock = surfaces_.clock();
    for (const double cut : lists_.cuts) times_.push_back(clock.at(cut));
    times_.back() = clock.end;
    for (const double key : deforming_keys()) {
        const auto at = std::ranges::find(lists_.cuts, path_time_of(key)) - lists_.cuts.begin();
        for (std::ptrdiff_t k = 0; k < std::ssize(times_); ++k) {
            double& time = times_[static_cast<std::size_t>(k)];
            time = k < at ? std::min(time, key) : (k > at ? std::max(time, key) : key);
        }
    }
}

PathClock MovingPieces::clock_of(double from, double to, std::size_t next) const {
    PathClock clock = surfaces_.clock().piece(from, to);
    if (times_.empty()) return clock;
    clock.begin = times_[next - 1];
    clock.end = times_[next];
    return clock;
}

}  // namespace ricochet
