#include "ricochet/geometry/sweep/moving_separation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/bernstein.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "ricochet/geometry/sweep/point_sweep.h"

namespace ricochet {
namespace {

using namespace bernstein;

/// Number of intervals of one pair that are tested before its separation counts as not proved. A contact takes about 2
/// intervals for every halving of the gap that a single polynomial does not resolve. Local, because only the cost
/// depends on it.
constexpr int kMostSeparationPieces = 512;

/// Maximum number of halvings of the time, for a certificate and for a search. Local: the last interval is shorter than
/// the rounding of the result.
constexpr int kDeepestProof = 40;
constexpr int kDeepestSearch = 50;

/// Number of halvings after which a change of sign in an interval counts as the first one. Local, because the
/// certificate decides.
constexpr int kShallowRoot = 3;

/// Number of halvings after which the search samples the gap. An interval with a gap at both ends and in the middle
/// then counts as free, if these samples suffice. Certificates detect contacts by curved motion between the samples.
/// Local, because the certificate decides.
constexpr int kSampledSearch = 6;

/// Returns the offset of two points that both move along lines, over an interval [s, t] of the time.
template <class Real>
Vector<Real, 1> offset_on(const MovingPoint& from, const MovingPoint& to, double s, double t) {
    Vector<Real, 1> offset;
    const std::array<double, 2> ends{s, t};
    for (int axis = 0; axis < 3; ++axis) {
        const Real begin = difference_as<Real>(to.from[axis], from.from[axis]);
        const Real end = difference_as<Real>(to.to[axis], from.to[axis]);
        Polynomial<Real, 1>& p = offset[static_cast<std::size_t>(axis)];
        for (std::size_t k = 0; k < 2; ++k) {
            const double rest = 1.0 - ends[k];  // exact: a multiple of 2^-52
            p.c[k] = rest * begin + ends[k] * end;
            p.size[k] = rest * std::fabs(high(begin)) + ends[k] * std::fabs(high(end));
        }
    }
    return offset;
}

/// Separation tests on one interval of the time. w is the vector from corner a to the point, whose path has the given
/// degree. u and v are the vectors from a to the corners b and c.
template <class Real, std::size_t Degree>
class Piece {
public:
    Piece(const Vector<Real, Degree>& w, const Vector<Real, 1>& u, const Vector<Real, 1>& v, double radius)
        : w_(w), u_(u), v_(v), radius_(radius) {}

    /// Returns true if the polynomials of a feature prove that the interval is free. feature: the nearest one at
    /// mid-time.
    [[nodiscard]] bool is_free_of(TriangleFeature feature) {
        normal_ = cross(u_, v_);
        if (feature != TriangleFeature::kFace) {
            const std::size_t k = number_of(feature);
            const bool is_vertex = rank(feature) == 2;
            if (is_vertex && (is_beyond_corner(k) || is_beyond_edge((k + 2) % 3))) return true;
            if (is_beyond_edge(k)) return true;
        }
        return is_over_face();
    }
    /// Returns true if a direction, of any length, proves that the interval is free.
    [[nodiscard]] bool is_free_along(const Vec3& n) const {
        const double least = radius_ * length(n) * (1.0 + kError<double>);
        const Vector<Real, 0> direction{constant(n.x), constant(n.y), constant(n.z)};
        const auto is_beyond = [&](const Vector<Real, Degree>& offset) {
            return sum(dot(offset, direction), raised<Degree>(constant(least)), Real(-1.0)).has_sign(1);
        };
        return is_beyond(w_) && is_beyond(difference(w_, u_)) && is_beyond(difference(w_, v_));
    }

private:
    [[nodiscard]] static Polynomial<Real, 0> constant(double value) { return {{Real(value)}, {std::fabs(value)}}; }
    /// Returns true if `squared` certainly exceeds radius^2 * `of` at all times. Both are squared lengths, as
    /// polynomials in time.
    template <std::size_t M, std::size_t N>
    [[nodiscard]] bool is_further(const Polynomial<Real, M>& squared, const Polynomial<Real, N>& of) const {
        const Real r(radius_);
        return sum(squared, raised<M>(of), Real(-1.0) * (r * r)).has_sign(1);
    }
    [[nodiscard]] bool is_over_face() const {
        const auto height = dot(w_, normal_);
        if (radius_ > 0.0) return is_further(height * height, dot(normal_, normal_));
        return height.has_sign(1) || height.has_sign(-1);
    }
    /// Returns the vector from corner k to the point.
    [[nodiscard]] Vector<Real, Degree> offset_from(std::size_t k) const {
        if (k == 0) return w_;
        return difference(w_, k == 1 ? u_ : v_);
    }
    /// Returns the vector from corner k to the next corner.
    [[nodiscard]] Vector<Real, 1> edge(std::size_t k) const {
        if (k == 0) return u_;
        return k == 1 ? difference(v_, u_) : negative(v_);
    }
    [[nodiscard]] bool is_beyond_edge(std::size_t k) const {
        const Vector<Real, Degree> w = offset_from(k);
        const Vector<Real, 1> along = edge(k);
        if (!dot(w, cross(along, normal_)).has_sign(1)) return false;
        if (radius_ == 0.0) return true;
        const auto across = cross(w, along);
        return is_further(dot(across, across), dot(along, along));
    }
    [[nodiscard]] bool is_beyond_corner(std::size_t k) const {
        const Vector<Real, Degree> w = offset_from(k);
        if (!dot(w, edge(k)).has_sign(-1) || !dot(w, edge((k + 2) % 3)).has_sign(1)) return false;
        return radius_ == 0.0 || is_further(dot(w, w), constant(1.0));
    }

    const Vector<Real, Degree>& w_;
    const Vector<Real, 1>& u_;
    const Vector<Real, 1>& v_;
    double radius_;
    Vector<Real, 2> normal_;
};

ClosestPointOnTriangle nearest_at(const Vec3& p, const MovingTriangle& triangle, double s) {
    const auto& [a, b, c] = triangle.corners;
    return closest_point_on_triangle(p, a.at(s), b.at(s), c.at(s));
}

/// Returns true if n . (p - a) > radius |n| for all control points p of a path and the corners a at their times. The
/// inequality then also holds between these times. `rounding` is the relative error of the points' coordinates, which
/// is zero for a line with exact points.
template <class Points>
bool are_beyond(const Points& control, double rounding, double radius, const MovingTriangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    const auto count = static_cast<std::size_t>(control.end() - control.begin());
    const Vec3 middle = 0.5 * (*control.begin() + *(control.begin() + (count - 1)));
    const Vec3 n = separating_direction(middle, a.at(0.5), b.at(0.5), c.at(0.5));
    const Vec3 size = abs(n);
    const double least = radius > 0.0 ? radius * length(n) * (1.0 + kError<double>) : 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const double part = static_cast<double>(k) / static_cast<double>(count - 1);
        for (const MovingPoint& corner : triangle.corners) {
            const Vec3 p = *(control.begin() + k);
            const Vec3 offset = p - corner.at(part);
            const double error = kError<double> * (dot(size, abs(offset)) + least) + rounding * dot(size, abs(p));
            if (!(error > kError<double> * kSmallestCoefficient && dot(n, offset) - least > error)) return false;
        }
    }
    return true;
}

/// Proof of separation for a point that moves along a line.
class Proof {
public:
    Proof(const MovingPoint& point, double radius, const MovingTriangle& triangle)
        : point_(point), radius_(radius), triangle_(triangle) {}

    [[nodiscard]] bool holds(double s, double t, int depth) {
        if (is_free(s, t)) return true;
        if (depth == 0 || ++pieces_ > kMostSeparationPieces || meet_in(s, t)) return false;
        const double middle = s + 0.5 * (t - s);
        return holds(s, middle, depth - 1) && holds(middle, t, depth - 1);
    }

private:
    /// Returns true if the bodies intersect, up to rounding, so that further halvings cannot prove separation. A sphere
    /// must overlap the triangle at an end or in the middle. A point must be over the face at both ends and change
    /// sides.
    [[nodiscard]] bool meet_in(double s, double t) const {
        if (radius_ > 0.0) {
            const auto overlaps = [&](double at) {
                const double squared = nearest_at(point_.at(at), triangle_, at).distance_squared;
                return squared < radius_ * radius_ * (1.0 - kError<double>);
            };
            return overlaps(s) || overlaps(t) || overlaps(s + 0.5 * (t - s));
        }
        const auto is_over_face = [&](double at) {
            return nearest_at(point_.at(at), triangle_, at).feature == TriangleFeature::kFace;
        };
        const auto side = [&](double at) {
            const auto& [a, b, c] = triangle_.corners;
            return orient3d(a.at(at), b.at(at), c.at(at), point_.at(at));
        };
        return is_over_face(s) && is_over_face(t) && side(s) * side(t) <= 0;
    }
    [[nodiscard]] bool is_free(double s, double t) const {
        const double middle = s + 0.5 * (t - s);
        const ClosestPointOnTriangle nearest = nearest_at(point_.at(middle), triangle_, middle);
        return is_free_in<double>(s, t, nearest) || is_free_in<DoubleDouble>(s, t, nearest) ||
               is_apart(point_, radius_, triangle_, s, t);
    }
    template <class Real>
    [[nodiscard]] bool is_free_in(double s, double t, const ClosestPointOnTriangle& nearest) const {
        const auto& [a, b, c] = triangle_.corners;
        const Vector<Real, 1> w = offset_on<Real>(a, point_, s, t);
        const Vector<Real, 1> u = offset_on<Real>(a, b, s, t);
        const Vector<Real, 1> v = offset_on<Real>(a, c, s, t);
        Piece<Real, 1> piece(w, u, v, radius_);
        if constexpr (std::is_same_v<Real, double>) {
            if (piece.is_free_along(nearest.offset)) return true;
        }
        return piece.is_free_of(nearest.feature);
    }

    const MovingPoint& point_;
    double radius_;
    const MovingTriangle& triangle_;
    int pieces_ = 0;
};

/// Search for the first contact along a curved path.
class Search {
public:
    using Counts = std::function<bool(const PossibleContact&)>;

    Search(const Path& path, double radius, const MovingTriangle& triangle, const Counts& counts)
        : path_(path), radius_(radius), triangle_(triangle), counts_(counts), control_(path.control_points()) {}

    [[nodiscard]] std::optional<PossibleContact> first(double s, double t, int depth) {
        if (is_free(s, t)) return std::nullopt;
        if (depth >= kShallowRoot) {
            if (const auto root = root_in(s, t)) return counted({*root, side_at(s)});
        }
        if (depth >= kSampledSearch && has_gap(s, t)) return std::nullopt;
        if (depth == kDeepestSearch || ++pieces_ > kMostSeparationPieces) return counted({s, side_at(s)});
        const double middle = s + 0.5 * (t - s);
        const auto early = first(s, middle, depth + 1);
        return early ? early : first(middle, t, depth + 1);
    }

private:
    [[nodiscard]] Vec3 position(double s) const { return path_.position(s * path_.duration); }
    [[nodiscard]] std::optional<PossibleContact> counted(const PossibleContact& contact) const {
        return counts_(contact) ? std::optional(contact) : std::nullopt;
    }
    [[nodiscard]] int side_at(double s) const {
        const auto& [a, b, c] = triangle_.corners;
        return orient3d(a.at(s), b.at(s), c.at(s), position(s));
    }

    /// Returns the control points of the interval, by de Casteljau's algorithm.
    template <std::size_t Degree>
    [[nodiscard]] std::array<Vec3, Degree + 1> piece_of(double s, double t) const {
        std::array<Vec3, Degree + 1> piece;
        for (std::size_t k = 0; k <= Degree; ++k) {
            std::array<Vec3, 4> p = control_.point;
            for (std::size_t level = 0; level < Degree; ++level) {
                const double at = level < k ? t : s;
                for (std::size_t i = 0; i < Degree - level; ++i) p[i] = p[i] + at * (p[i + 1] - p[i]);
            }
            piece[k] = p[0];
        }
        return piece;
    }
    template <std::size_t Degree>
    [[nodiscard]] Vector<double, Degree> offset_from(const MovingPoint& corner, double s, double t) const {
        constexpr std::array<std::array<double, 4>, 4> kBinomials{
            {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}}};
        const std::array<Vec3, Degree + 1> piece = piece_of<Degree>(s, t);
        Vector<double, Degree> offset;
        for (std::size_t k = 0; k <= Degree; ++k) {
            const double part = static_cast<double>(k) / static_cast<double>(Degree);
            const Vec3 value = kBinomials[Degree][k] * (piece[k] - corner.at(s + (t - s) * part));
            for (int axis = 0; axis < 3; ++axis) {
                offset[static_cast<std::size_t>(axis)].c[k] = value[axis];
                offset[static_cast<std::size_t>(axis)].size[k] = std::fabs(value[axis]);
            }
        }
        return offset;
    }
    [[nodiscard]] bool is_free(double s, double t) const {
        if (control_.count == 2) return is_free_of_degree<1>(s, t);
        return control_.count == 3 ? is_free_of_degree<2>(s, t) : is_free_of_degree<3>(s, t);
    }
    template <std::size_t Degree>
    [[nodiscard]] bool is_free_of_degree(double s, double t) const {
        const double middle = s + 0.5 * (t - s);
        const ClosestPointOnTriangle nearest = nearest_at(position(middle), triangle_, middle);
        if (is_gap_above_displacement<Degree>(s, t, std::sqrt(nearest.distance_squared))) return true;
        const auto& [a, b, c] = triangle_.corners;
        const Vector<double, Degree> w = offset_from<Degree>(a, s, t);
        const Vector<double, 1> u = offset_on<double>(a, b, s, t);
        const Vector<double, 1> v = offset_on<double>(a, c, s, t);
        Piece<double, Degree> piece(w, u, v, radius_);
        return piece.is_free_along(nearest.offset) || piece.is_free_of(nearest.feature);
    }
    /// Returns true if the gap at mid-time exceeds the displacement relative to each corner, from mid-time to any other
    /// time of the interval. The gap then also exceeds the displacement relative to all other points of the triangle.
    template <std::size_t Degree>
    [[nodiscard]] bool is_gap_above_displacement(double s, double t, double distance) const {
        const double spare = distance - radius_ - kLeastGap * offset();
        if (!(spare > 0.0)) return false;
        const std::array<Vec3, Degree + 1> piece = piece_of<Degree>(s, t);
        const double middle = s + 0.5 * (t - s);
        const Vec3 here = position(middle);
        for (const MovingPoint& corner : triangle_.corners) {
            const Vec3 arm = here - corner.at(middle);
            for (std::size_t k = 0; k <= Degree; ++k) {
                const double part = static_cast<double>(k) / static_cast<double>(Degree);
                if (!(length(piece[k] - corner.at(s + (t - s) * part) - arm) < spare)) return false;
            }
        }
        return true;
    }
    /// Returns the gap of a sphere from the triangle, or the signed height of a point above its plane, in m.
    [[nodiscard]] double gap(double s) const {
        const auto& [a, b, c] = triangle_.corners;
        if (radius_ == 0.0) return signed_distance(position(s), a.at(s), b.at(s), c.at(s));
        return std::sqrt(nearest_at(position(s), triangle_, s).distance_squared) - radius_;
    }
    /// Returns true if there is a gap between ball and triangle at both ends and in the middle. Between these times,
    /// only curvature of the motion can close the gap.
    [[nodiscard]] bool has_gap(double s, double t) const {
        const double least = radius_ + kLeastGap * offset();
        bool is_over_plane = true;
        int side = 0;
        std::optional<TriangleFeature> feature;
        bool is_one_feature = true;
        for (const double at : {s, s + 0.5 * (t - s), t}) {
            const Vec3 p = position(at);
            const ClosestPointOnTriangle nearest = nearest_at(p, triangle_, at);
            if (!(std::sqrt(nearest.distance_squared) > least)) return false;
            if (radius_ == 0.0) continue;
            const auto& [a, b, c] = triangle_.corners;
            const double height = signed_distance(p, a.at(at), b.at(at), c.at(at));
            const int here = height > least ? 1 : (height < -least ? -1 : 0);
            is_over_plane = is_over_plane && here != 0 && (side == 0 || here == side);
            side = here;
            is_one_feature = is_one_feature && (!feature || *feature == nearest.feature);
            feature = nearest.feature;
        }
        if (radius_ == 0.0 || is_over_plane) return true;
        // Around an edge or a corner, the gap decreases between samples by less than an eighth of the squared path
        // length divided by the distance.
        const double past = distance_past(s, t, is_one_feature ? feature : std::nullopt);
        return past * past <= 8.0 * radius_ * kLeastGap * offset();
    }
    /// Returns the length, in m, of the ball's path relative to the triangle in an interval. If one edge is nearest all
    /// the time, motion along this edge does not count.
    [[nodiscard]] double distance_past(double s, double t, const std::optional<TriangleFeature>& nearest) const {
        const Vec3 moved = position(t) - position(s);
        const auto& corners = triangle_.corners;
        Vec3 along;
        if (nearest && rank(*nearest) == 1) {
            const std::size_t edge = number_of(*nearest);
            along = normalized(corners[(edge + 1) % 3].at(s) - corners[edge].at(s));
        }
        double past = 0.0;
        for (const MovingPoint& corner : corners) {
            const Vec3 relative = moved - (corner.at(t) - corner.at(s));
            past = std::max(past, length(relative - dot(relative, along) * along));
        }
        return past;
    }
    /// Returns the contact offset, in m, at the largest coordinate of the path's ends.
    [[nodiscard]] double offset() const {
        return contact_offset({std::max(max_abs(path_.c[0]), max_abs(path_.end)), 0.0, 0.0});
    }
    /// Returns the time at which the gap changes its sign, by the Illinois variant of false position (M. Dowell, P.
    /// Jarratt, BIT 11, 1971).
    [[nodiscard]] std::optional<double> root_in(double s, double t) const {
        double at_s = gap(s);
        double at_t = gap(t);
        if (!(at_s * at_t < 0.0) || (radius_ > 0.0 && at_s < 0.0)) return std::nullopt;
        constexpr int kMostSteps = 80;
        int side = 0;
        double root = t;
        for (int step = 0; step < kMostSteps && t - s > 0x1p-53; ++step) {
            root = std::clamp((s * at_t - t * at_s) / (at_t - at_s), s, t);
            const double at = gap(root);
            if (at == 0.0 || root == s || root == t) break;
            const bool is_before = (at > 0.0) == (at_s > 0.0);
            (is_before ? s : t) = root;
            (is_before ? at_s : at_t) = at;
            if (side == (is_before ? -1 : 1)) (is_before ? at_t : at_s) *= 0.5;
            side = is_before ? -1 : 1;
        }
        if (radius_ > 0.0) return root;
        const Vec3 p = position(root);
        const double off = std::sqrt(nearest_at(p, triangle_, root).distance_squared);
        return off <= kLeastGap * offset() ? std::optional(root) : std::nullopt;
    }

    const Path& path_;
    double radius_;
    const MovingTriangle& triangle_;
    const Counts& counts_;
    ControlPoints control_;
    int pieces_ = 0;
};

}  // namespace

bool stay_apart(const MovingPoint& point, double radius, const MovingTriangle& triangle) {
    return are_beyond(std::array{point.from, point.to}, 0.0, radius, triangle) ||
           Proof(point, radius, triangle).holds(0.0, 1.0, kDeepestProof);
}

bool pass_along_direction(const Path& path, double radius, const MovingTriangle& triangle) {
    return are_beyond(path.control_points(), kError<double>, radius, triangle);
}

std::optional<PossibleContact> first_possible_contact(const Path& path, double radius, const MovingTriangle& triangle,
                                                      double from,
                                                      const std::function<bool(const PossibleContact&)>& counts) {
    return Search(path, radius, triangle, counts).first(from, 1.0, 0);
}

}  // namespace ricochet
