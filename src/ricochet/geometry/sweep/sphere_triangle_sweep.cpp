#include "ricochet/geometry/sweep/sphere_triangle_sweep.h"

#include <cmath>

namespace ricochet {
namespace {

using std::size_t;

/// Rounding of a clearance in plain doubles and of its Bernstein coefficients, relative to the squares from which it is
/// computed. A term has about 20 roundings, and 64 u is used. Local: an error bound of this arithmetic.
constexpr double kClearanceError = 0x1p-47;

TriangleFeature edge_feature(int i) {
    return static_cast<TriangleFeature>(static_cast<int>(TriangleFeature::kEdgeAB) + i);
}
TriangleFeature vertex_feature(int i) {
    return static_cast<TriangleFeature>(static_cast<int>(TriangleFeature::kVertexA) + i);
}
int next(int i) { return i == 2 ? 0 : i + 1; }
int index_of(TriangleFeature feature) { return (static_cast<int>(feature) + 2) % 3; }

bool is_before(const Vec3& p, const Vec3& q) { return p.x != q.x ? p.x < q.x : (p.y != q.y ? p.y < q.y : p.z < q.z); }

VectorOf<double> as_vector(const Vec3& v) { return {v.x, v.y, v.z}; }

bool is_axis(const Vec3& n) {
    return static_cast<int>(n.x == 0.0) + static_cast<int>(n.y == 0.0) + static_cast<int>(n.z == 0.0) == 2;
}

/// Returns the power of two whose product with x is between 1 and 2.
double scale_to_one(double x) { return std::ldexp(1.0, -std::ilogb(x)); }

/// Returns (b - a) x (c - a) times a power of two, with a relative error below 2^-60. Returns nullopt for a triangle so
/// slender that double-doubles do not reach that accuracy.
std::optional<PreciseVec3> precise_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
    PreciseVec3 u = difference<DoubleDouble>(b, a);
    PreciseVec3 v = difference<DoubleDouble>(c, a);
    u = scale_to_one(max_abs(rounded(u))) * u;
    v = scale_to_one(max_abs(rounded(v))) * v;
    const PreciseVec3 normal = cross_of(u, v);
    if (max_abs(rounded(normal)) < 0x1p-40) return std::nullopt;
    return normal;
}

double evaluated(const std::array<DoubleDouble, 4>& m, int degree, double s) {
    DoubleDouble sum = m[static_cast<size_t>(degree)];
    for (int k = degree - 1; k >= 0; --k) sum = sum * s + m[static_cast<size_t>(k)];
    return sum.hi;
}

/// Returns true if the smallest value of a quadratic on [0, to] exceeds the margin.
bool quadratic_exceeds(const Coefficients<double>& q, double margin, double to) {
    const double at_ends = std::min(q[0], q[0] + to * (q[1] + to * q[2]));
    if (at_ends <= margin) return false;
    if (!(q[2] > 0.0) || q[1] >= 0.0 || -q[1] >= 2.0 * q[2] * to) return true;
    return q[0] - q[1] * q[1] / (4.0 * q[2]) > margin;
}

}  // namespace

Polynomial face_clearance(const Path& path, const std::array<DoubleDouble, 4>& height, const DoubleDouble& radius,
                          int side) {
    Polynomial p;
    p.degree = path.degree;
    p.duration = path.duration;
    for (size_t k = 0; k < height.size(); ++k) p.coefficients[k] = side > 0 ? height[k] : -height[k];
    p.coefficients[0] = p.coefficients[0] - radius;
    return p;
}

SphereTriangleSweep::SphereTriangleSweep(const SphereSweep& sphere, const TrianglePlane& plane)
    : sphere_(sphere),
      path_(sphere.path_),
      radius_(sphere.radius_),
      plane_(plane),
      corners_{plane.a(), plane.b(), plane.c()},
      largest_coordinate_(std::max({max_abs(plane.a()), max_abs(plane.b()), max_abs(plane.c())})),
      limit_(sphere.latest_) {}

std::optional<SphereContact> SphereTriangleSweep::first() {
    search(0.0);
    if (starts_in_overlap_) return search_from_overlap();
    if (!best_) return std::nullopt;
    return contact_at(*best_);
}

/// Searches the face and the vertices first. Their contacts shorten the search along the edges, which takes the most
/// time.
void SphereTriangleSweep::search(double from) {
    best_.reset();
    limit_ = sphere_.latest_;
    search_face(from);
    for (int i = 0; i < 3; ++i) search_vertex(i, from);
    for (int i = 0; i < 3; ++i) search_edge(i, from);
}

void SphereTriangleSweep::add_contact(double time, TriangleFeature feature) {
    if (best_ && (time > best_->time || (time == best_->time && rank(feature) >= rank(best_->feature)))) return;
    best_ = Candidate{time, feature};
    limit_ = std::min(limit_, time);
}

const std::optional<Vec3>& SphereTriangleSweep::normal() {
    if (!normal_is_known_) {
        normal_is_known_ = true;
        const bool is_plain = max_abs(plane_.cross().value) > 0x1p-40 * max_abs(plane_.cross().magnitude);
        if (is_plain || !are_collinear(corners_[0], corners_[1], corners_[2])) normal_ = plane_.unit_normal();
    }
    return normal_;
}

double SphereTriangleSweep::seam_slack(const Vec3& p) const {
    return kSeamSlack * (std::max(max_abs(p), largest_coordinate_) + radius_);
}

/// Returns the height above the face multiplied by the length of a normal. Sets scaled_radius to the radius multiplied
/// by the same length. A normal along an axis is exact and has length 1, so any triangle in an axis-aligned plane gives
/// the same bits.
std::array<DoubleDouble, 4> SphereTriangleSweep::height_over_face(DoubleDouble& scaled_radius) {
    const PreciseVec3 start = difference<DoubleDouble>(path_.c[0], corners_[0]);
    scaled_radius = DoubleDouble(radius_);
    if (is_axis(*normal_)) return component_along(path_, start, *normal_);
    const auto precise = precise_normal(corners_[0], corners_[1], corners_[2]);
    if (!precise) return component_along(path_, start, *normal_);
    scaled_radius = sqrt(dot_of(*precise, *precise)) * radius_;
    return component_along(path_, start, *precise);
}

/// Returns the times at which the sphere comes into contact with the face's plane, from either side.
Times SphereTriangleSweep::face_crossings(const std::array<DoubleDouble, 4>& height, const DoubleDouble& scaled_radius,
                                          double from) const {
    const Times above = down_crossings(face_clearance(path_, height, scaled_radius, +1), from, path_.duration);
    const Times below = down_crossings(face_clearance(path_, height, scaled_radius, -1), from, path_.duration);
    Times all;
    std::merge(above.begin(), above.end(), below.begin(), below.end(), all.time.begin());
    all.count = above.count + below.count;
    return all;
}

/// Returns true if the whole path is on the outer side of some edge, so that no point of it projects onto the face.
bool SphereTriangleSweep::certainly_passes_beside_face() const {
    const double normal_size = length(plane_.cross().magnitude);
    for (int i = 0; i < 3; ++i) {
        const Vec3& from = corner(i);
        const Vec3 d = corner(next(i)) - from;
        const Vec3 outward = cross(d, plane_.cross().value);
        const double size = length(d) * normal_size;
        bool is_outside = true;
        for (int k = 0; k < sphere_.hull_count_; ++k) {
            const Vec3 w = sphere_.hull(k) - from;
            const double margin = size * (0x1p-48 * length(w) + 0x1p-46 * (sphere_.scale_ + largest_coordinate_));
            is_outside = is_outside && dot(outward, w) > margin;
        }
        if (is_outside) return true;
    }
    return false;
}

/// Returns true if p projects onto the face, or at most the seam slack beside it.
bool SphereTriangleSweep::projects_onto_face(const Vec3& p) {
    const auto& [a, b, c] = corners_;
    if (projects_into_triangle(p, a, b, c, *normal_)) return true;
    const double slack = seam_slack(p);
    for (int i = 0; i < 3; ++i) {
        const Vec3& from = corner(i);
        const Vec3& to = corner(next(i));
        if (is_along_normal(closest_point_on_segment(p, from, to).offset, slack)) return true;
    }
    return false;
}

/// Returns true if an offset from the triangle deviates from the normal by at most the slack.
bool SphereTriangleSweep::is_along_normal(const Vec3& offset, double slack) const {
    return length_squared(offset - dot(*normal_, offset) * *normal_) <= slack * slack;
}

void SphereTriangleSweep::search_face(double from) {
    if (certainly_passes_beside_face() || !normal()) return;
    DoubleDouble scaled_radius;
    const auto height = height_over_face(scaled_radius);
    if (abs(height[0]) <= scaled_radius && projects_onto_face(path_.c[0])) starts_in_overlap_ = true;
    for (const double time : face_crossings(height, scaled_radius, from)) {
        if (time > limit_) return;
        if (!projects_onto_face(path_.position(time))) continue;
        add_contact(time, TriangleFeature::kFace);
        return;
    }
}

/// Returns true if the path cannot reach a point or line before the limit. The degree of `clearance` is twice that of
/// the path.
bool SphereTriangleSweep::certainly_clears(const Coefficients<double>& clearance, double start_distance) const {
    const double extent = start_distance + sphere_.max_distance_;
    const double margin = kClearanceError * (extent * extent + radius_ * radius_);
    if (path_.degree < 2) return quadratic_exceeds(clearance, margin, limit_);
    Polynomial p;
    p.degree = 2 * path_.degree;
    p.duration = path_.duration;
    for (size_t k = 0; k < clearance.size(); ++k) p.coefficients[k] = DoubleDouble(clearance[k]);
    p.coefficients[0].hi -= margin;
    return is_certainly_positive(p, limit_);
}

Polynomial SphereTriangleSweep::polynomial(const Coefficients<DoubleDouble>& coefficients) const {
    Polynomial p;
    p.coefficients = coefficients;
    p.degree = 2 * path_.degree;
    p.duration = path_.duration;
    return p;
}

/// Returns nullopt for an edge of length 0, because the tests of its vertices cover it.
std::optional<SphereTriangleSweep::EdgeLine> SphereTriangleSweep::edge_line(int i) const {
    const bool in_order = is_before(corner(i), corner(next(i)));
    const int first = in_order ? i : next(i);
    const int second = in_order ? next(i) : i;
    const PreciseVec3 d = difference<DoubleDouble>(corner(second), corner(first));
    const double largest = max_abs(rounded(d));
    if (largest == 0.0) return std::nullopt;
    const double scale = scale_to_one(largest);
    const PreciseVec3 near_one = scale * d;
    const DoubleDouble size = sqrt(dot_of(near_one, near_one));
    return EdgeLine{first, (DoubleDouble(1.0) / size) * near_one, size.hi / scale};
}

SphereTriangleSweep::EdgeClearance SphereTriangleSweep::edge_clearance(const EdgeLine& line) const {
    const PreciseVec3 start = difference<DoubleDouble>(path_.c[0], corner(line.first));
    const auto along = component_along(path_, start, line.direction);
    const auto around_end = point_clearance(path_, sphere_.precise_squared_displacement_, start, radius_);
    return {polynomial(line_clearance(around_end, along, path_.degree)), along};
}

/// Returns true if, until the limit, the path stays beyond one of the edge's ends or away from the edge's line. Uses
/// plain doubles.
bool SphereTriangleSweep::certainly_misses_edge(int i) const {
    const Vec3& origin = corner(i);
    const Vec3 edge = corner(next(i)) - origin;
    const double edge_length = length(edge);
    if (!(edge_length > 0.0)) return false;
    const Vec3 start = path_.c[0] - origin;
    const auto along = component_along(path_, as_vector(start), edge / edge_length);
    double lowest = along[0];
    double highest = along[0];
    double power = limit_;
    for (size_t k = 1; k <= static_cast<size_t>(path_.degree); ++k, power *= limit_) {
        lowest += std::min(0.0, along[k] * power);
        highest += std::max(0.0, along[k] * power);
    }
    const double distance = length(start);
    const double margin = kClearanceError * (distance + sphere_.max_distance_ + edge_length);
    if (highest < -margin || lowest > edge_length + margin) return true;
    const auto around = point_clearance(path_, sphere_.squared_displacement_, as_vector(start), radius_);
    return certainly_clears(line_clearance(around, along, path_.degree), distance);
}

void SphereTriangleSweep::search_edge(int i, double from) {
    if (certainly_misses_edge(i)) return;
    const std::optional<EdgeLine> line = edge_line(i);
    if (!line) return;
    const auto [clearance, along] = edge_clearance(*line);
    const auto is_on_edge = [&, &along = along](double time) {
        const double m = evaluated(along, path_.degree, time);
        return m >= 0.0 && m <= line->length;
    };
    if (clearance.coefficients[0].hi <= 0.0 && is_on_edge(0.0)) starts_in_overlap_ = true;
    for (const double time : down_crossings(clearance, from, limit_)) {
        if (!is_on_edge(time)) continue;
        add_contact(time, edge_feature(i));
        return;
    }
}

void SphereTriangleSweep::search_vertex(int i, double from) {
    const Vec3& vertex = corner(i);
    const Vec3 rough_start = path_.c[0] - vertex;
    const auto rough = point_clearance(path_, sphere_.squared_displacement_, as_vector(rough_start), radius_);
    if (certainly_clears(rough, length(rough_start))) return;
    const PreciseVec3 start = difference<DoubleDouble>(path_.c[0], vertex);
    const Polynomial clearance =
        polynomial(point_clearance(path_, sphere_.precise_squared_displacement_, start, radius_));
    if (clearance.coefficients[0].hi <= 0.0) starts_in_overlap_ = true;
    const Times crossings = down_crossings(clearance, from, limit_);
    if (crossings.count > 0) add_contact(crossings[0], vertex_feature(i));
}

std::span<const double> SphereTriangleSweep::distance_extrema(Extrema& extrema) {
    for (int i = 0; i < 3; ++i) {
        const PreciseVec3 start = difference<DoubleDouble>(path_.c[0], corner(i));
        extrema.add_of(polynomial(point_clearance(path_, sphere_.precise_squared_displacement_, start, radius_)));
        if (const std::optional<EdgeLine> line = edge_line(i)) extrema.add_of(edge_clearance(*line).polynomial);
    }
    if (normal()) {
        DoubleDouble scaled_radius;
        extrema.add_of_height(face_clearance(path_, height_over_face(scaled_radius), 0.0, +1));
    }
    return extrema.sorted();
}

std::optional<SphereContact> SphereTriangleSweep::search_from_overlap() {
    const auto nearest_to = [&](const Vec3& p) {
        return closest_point_on_triangle(p, corners_[0], corners_[1], corners_[2]);
    };
    Extrema extrema;
    const double overlap = radius_ + kSeamSlack * (sphere_.scale_ + largest_coordinate_);
    const OverlapEnd end =
        follow_overlap(path_, overlap, distance_extrema(extrema), [&](const Vec3& p) { return nearest_to(p).offset; });
    if (end.kind == OverlapEnd::kNever) return std::nullopt;
    if (end.kind == OverlapEnd::kStopped) {
        return contact_at({end.time, nearest_to(path_.position(end.time)).feature});
    }
    if (end.time > sphere_.latest_) return std::nullopt;
    search(end.time);
    if (!best_) return std::nullopt;
    return contact_at(*best_);
}

PreciseVec3 SphereTriangleSweep::position_from(const Vec3& origin, double time) const {
    const auto degree = static_cast<size_t>(path_.degree);
    PreciseVec3 w{DoubleDouble(path_.c[degree].x), DoubleDouble(path_.c[degree].y), DoubleDouble(path_.c[degree].z)};
    for (size_t k = degree - 1; k >= 1; --k) {
        w = time * w;
        w = {w.x + path_.c[k].x, w.y + path_.c[k].y, w.z + path_.c[k].z};
    }
    return time * w + difference<DoubleDouble>(path_.c[0], origin);
}

/// Returns the offset from the nearest point of an edge or vertex to the centre, not rounded to the coordinates' last
/// place.
Vec3 SphereTriangleSweep::offset_at(const Candidate& candidate) const {
    const int i = index_of(candidate.feature);
    if (rank(candidate.feature) == 2) return rounded(position_from(corner(i), candidate.time));
    const std::optional<EdgeLine> line = edge_line(i);
    const PreciseVec3 w = position_from(corner(line->first), candidate.time);
    return rounded(w - dot_of(w, line->direction) * line->direction);
}

/// Converts a candidate into a contact. A contact with an edge or vertex whose normal equals the face's normal within
/// rounding is reported as one with the face. It then has the face's normal. It also has the time of contact with the
/// face's plane if both times agree within rounding.
SphereContact SphereTriangleSweep::contact_at(const Candidate& candidate) {
    const Vec3 p = path_.position(candidate.time);
    if (candidate.feature != TriangleFeature::kFace) {
        const Vec3 offset = offset_at(candidate);
        const bool leans = !normal() || !is_along_normal(offset, seam_slack(p));
        if (leans) {
            const Vec3 point = rank(candidate.feature) == 2 ? corner(index_of(candidate.feature)) : p - offset;
            return {candidate.time, normalized(offset), point, candidate.feature};
        }
    }
    double time = candidate.time;
    if (candidate.feature != TriangleFeature::kFace) {
        DoubleDouble scaled_radius;
        const auto height = height_over_face(scaled_radius);
        const double near = kCandidateSlack * path_.duration;
        double nearest = near;
        for (const double crossing : face_crossings(height, scaled_radius, 0.0)) {
            if (std::fabs(crossing - candidate.time) > nearest) continue;
            nearest = std::fabs(crossing - candidate.time);
            time = crossing;
        }
    }
    const Vec3 at_face = path_.position(time);
    const double height = dot(*normal_, at_face - corners_[0]);
    return {time, height > 0.0 ? *normal_ : -*normal_, at_face - height * *normal_, TriangleFeature::kFace};
}

}  // namespace ricochet
