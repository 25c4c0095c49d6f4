#include "queries/ray_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace {

using Integer = boost::multiprecision::cpp_int;
using Point = std::array<Integer, 3>;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Integer dot_of(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross_of(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

int lowest_exponent(const Vec3& p) {
    int least = std::numeric_limits<int>::max();
    for (int axis = 0; axis < 3; ++axis) {
        if (p[axis] != 0.0) least = std::min(least, std::ilogb(p[axis]) - 53);
    }
    return least;
}

}  // namespace

RayOracle::RayOracle(const TriangleMesh& mesh) : mesh_(mesh) {}

RayOracle::Point RayOracle::whole(const Vec3& p, int exponent) const {
    Point result;
    for (int axis = 0; axis < 3; ++axis) {
        if (p[axis] == 0.0) continue;
        const int own = std::ilogb(p[axis]) - 53;
        result[static_cast<std::size_t>(axis)] = Integer(static_cast<long long>(std::ldexp(p[axis], -own)))
                                                 << static_cast<unsigned>(own - exponent);
    }
    return result;
}

/// Returns true if the ray certainly misses the triangle. Computed in doubles with a generous error bound.
bool RayOracle::certainly_misses(const Vec3& origin, const Vec3& direction, std::uint32_t triangle) const {
    bool left = false;
    bool right = false;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = mesh_.vertices[mesh_.triangles[triangle][k]] - origin;
        const Vec3 q = mesh_.vertices[mesh_.triangles[triangle][(k + 1) % 3]] - origin;
        const double value = dot(cross(p, q), direction);
        const double doubt = 1e-13 * length(p) * length(q) * length(direction);
        left = left || value > doubt;
        right = right || value < -doubt;
    }
    return left && right;
}

/// Intersects a ray with a triangle. Clips the range [begin, end] of t by the half spaces value + t change >= 0 that
/// bound the triangle's prism. For a ray in the triangle's plane, the remaining range is the intersection.
bool RayOracle::meets(const Point& origin, const Point& direction, const std::array<Point, 3>& corners,
                      Meeting& meeting) const {
    const Point normal = cross_of(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    const Integer speed = dot_of(normal, direction);
    const Integer height = dot_of(normal, minus(corners[0], origin));
    meeting.in_plane = speed == 0;
    Fraction begin{0, 1};
    Fraction end{1, 0};  // infinite
    if (!meeting.in_plane) {
        begin = speed > 0 ? Fraction{height, speed} : Fraction{-height, -speed};
        if (begin.numerator < 0) return false;
        end = begin;
    } else if (height != 0) {
        return false;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const Point inward = cross_of(normal, minus(corners[(k + 1) % 3], corners[k]));
        const Integer value = dot_of(inward, minus(origin, corners[k]));
        const Integer change = dot_of(inward, direction);
        if (change == 0) {
            if (value < 0) return false;
            continue;
        }
        const Fraction at = change > 0 ? Fraction{-value, change} : Fraction{value, -change};
        const auto less = [](const Fraction& x, const Fraction& y) {
            return x.numerator * y.denominator < y.numerator * x.denominator;
        };
        if (change > 0 && less(begin, at)) begin = at;
        if (change < 0 && less(at, end)) end = at;
        if (less(end, begin)) return false;
    }
    meeting.t = begin;
    return true;
}

TrueHits RayOracle::ask(const Vec3& origin, const Vec3& direction) const {
    int exponent = lowest_exponent(origin);
    for (const Vec3& vertex : mesh_.vertices) exponent = std::min(exponent, lowest_exponent(vertex));
    const Point from = whole(origin, exponent);
    const Point along = whole(direction, lowest_exponent(direction));
    TrueHits truth;
    std::vector<std::pair<Fraction, std::uint32_t>> met;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        if (certainly_misses(origin, direction, t)) continue;
        std::array<Point, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) corners[k] = whole(mesh_.vertices[mesh_.triangles[t][k]], exponent);
        Meeting meeting;
        if (!meets(from, along, corners, meeting)) continue;
        truth.runs_along = truth.runs_along || meeting.in_plane;
        met.emplace_back(meeting.t, t);
    }
    std::stable_sort(met.begin(), met.end(), [](const auto& x, const auto& y) {
        return x.first.numerator * y.first.denominator < y.first.numerator * x.first.denominator;
    });
    for (std::size_t i = 0; i < met.size(); ++i) {
        const Fraction& t = met[i].first;
        const bool is_new =
            i == 0 || t.numerator * met[i - 1].first.denominator != met[i - 1].first.numerator * t.denominator;
        truth.places += is_new ? 1 : 0;
        if (truth.places == 1) truth.first.push_back(met[i].second);
    }
    truth.begins_on = !met.empty() && met[0].first.numerator == 0;
    return truth;
}

HardRay hard_ray(const TriangleMesh& mesh, double unit, RandomSequence& random) {
    const auto below = [&](double count) { return static_cast<int>(random.uniform() * count); };
    const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(below(double(mesh.triangles.size())))];
    const std::array<Vec3, 3> p{mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]};
    const auto lattice_step = [&](int reach) {
        return unit * Vec3{double(below(2 * reach + 1) - reach), double(below(2 * reach + 1) - reach),
                           double(below(2 * reach + 1) - reach)};
    };
    const Vec3 aim = p[0] + lattice_step(4000);
    // Smaller components of a direction count as zero.
    const auto nudged = [&](double x) {
        const double to = below(2) == 0 ? -1e300 : 1e300;
        return x == 0.0 ? std::copysign(unit * 0x1p-80, to) : std::nextafter(x, to);
    };
    switch (below(8)) {
        case 0:
            return {aim, p[0] - aim};  // through a corner
        case 1:
            return {aim, 0.5 * (p[0] + p[1]) - aim};  // through the middle of an edge
        case 2:
            return {aim, p[0] + random.uniform() * (p[1] - p[0]) - aim};
        case 3: {  // in the plane of a face
            const Vec3 u = p[1] - p[0];
            const Vec3 v = p[2] - p[0];
            return {p[0] + double(below(9) - 4) * u + double(below(9) - 4) * v,
                    double(below(9) - 4) * u + (double(below(9) - 4) + 0.5) * v};
        }
        case 4: {  // along an axis through a corner
            const int axis = below(3);
            Vec3 direction;
            direction[axis] = below(2) == 0 ? -1.0 : 1.0;
            return {p[0] - unit * double(below(8000)) * direction, direction};
        }
        case 5:
            return {0.5 * (p[0] + p[1]), aim - p[2]};  // from an edge
        case 6: {                                      // one ulp beside a corner
            const Vec3 d = p[0] - aim;
            return {aim, {nudged(d.x), nudged(d.y), nudged(d.z)}};
        }
        default: {  // from far away
            const Vec3 far = p[0] + 1000.0 * lattice_step(4000);
            return {far, 0.5 * (p[1] + p[2]) - far};
        }
    }
}

TriangleMesh lattice_ball(const Vec3& center, double scale, int levels) {
    TriangleMesh mesh = sphere_mesh({}, 1.0, levels);
    for (Vec3& v : mesh.vertices) {
        v = scale * Vec3{std::round(v.x * 1024.0) / 1024.0, std::round(v.y * 1024.0) / 1024.0,
                         std::round(v.z * 1024.0) / 1024.0} +
            center;
    }
    return mesh;
}

}  // namespace ricochet::testing
