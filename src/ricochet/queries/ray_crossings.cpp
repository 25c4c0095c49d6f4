#include "ricochet/queries/ray_crossings.h"

#include <algorithm>

#include "ricochet/core/disjoint_sets.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/queries/mesh_index.h"

namespace ricochet {
namespace {

/// Fraction by which the part of a ray that the broad phase tests is lengthened beyond the mesh's box. This segment
/// then reaches all of the mesh despite rounding. Local, because the exact test decides.
constexpr double kBeyond = 0x1p-20;

/// Rounding of the ends of this segment, relative to their coordinates. Local: an error bound of this arithmetic.
constexpr double kEndRounding = 0x1p-48;

/// Relative rounding of a position along this segment, given as a fraction of its length. Includes a margin. Local: an
/// error bound of this arithmetic.
constexpr double kFractionRounding = 0x1p-40;

struct Candidate {
    std::uint32_t triangle;
    MetTriangle met;
};

/// Part of the ray that can reach the mesh, for the broad phase.
struct Reach {
    double t = 0.0;  ///< parameter of the ray at the end of the tube
    Tube tube;

    Reach(const MeshIndex& mesh, const RayQuery& query) {
        const Ray& ray = query.ray;
        const Box3& box = mesh.box();
        const Vec3 farthest = max(abs(box.lower - ray.origin), abs(box.upper - ray.origin));
        const double norm = length(ray.direction);
        const double longest = std::min(length(farthest), query.most);
        t = longest / norm * (1.0 + kBeyond) + std::numeric_limits<double>::min();
        const Vec3 end = ray.origin + t * ray.direction;
        tube = Tube(ray.origin, end, kEndRounding * (max_abs(ray.origin) + max_abs(end)));
    }
    /// Returns the fraction of the tube at a parameter of the ray, rounded up.
    [[nodiscard]] double fraction(double crossing_point) const {
        return std::min(1.0, crossing_point / t * (1.0 + kFractionRounding));
    }
};

std::optional<MetTriangle> meet(const MeshIndex& mesh, const RayQuery& query, std::uint32_t triangle) {
    const auto [a, b, c] = mesh.corners(triangle);
    const auto intersection = meet(query.ray, a, b, c);
    if (!intersection || !query.reaches(intersection->t)) return std::nullopt;
    return MetTriangle{{a, b, c}, *intersection};
}

bool comes_before(const Ray& ray, const Candidate& x, const Candidate& y) {
    const int order = compare_along(ray, x.met, y.met);
    return order != 0 ? order < 0 : x.triangle < y.triangle;
}

// The next functions find all hits of a ray. Triangles that share the feature through which the ray passes give one
// hit.

/// Feature of a triangle through which the ray passes, and the triangle's index among the candidates.
struct Passed {
    FeatureKey key;
    std::uint32_t candidate;
};

std::vector<Passed> features_passed(const std::vector<Candidate>& candidates) {
    std::vector<Passed> passed;
    for (std::uint32_t k = 0; k < candidates.size(); ++k) {
        const MetTriangle& met = candidates[k].met;
        passed.push_back({FeatureKey(met.corners, met.intersection.feature), k});
        if (!met.intersection.in_plane) continue;
        for (int f = static_cast<int>(TriangleFeature::kEdgeAB); f <= static_cast<int>(TriangleFeature::kVertexC);
             ++f) {
            const auto feature = static_cast<TriangleFeature>(f);
            if (met.intersection.features.has(feature)) passed.push_back({FeatureKey(met.corners, feature), k});
        }
    }
    std::ranges::sort(passed, [](const Passed& x, const Passed& y) {
        const int order = FeatureKey::order(x.key, y.key);
        return order != 0 ? order < 0 : x.candidate < y.candidate;
    });
    return passed;
}

DisjointSets join(const std::vector<Candidate>& candidates) {
    DisjointSets joined(candidates.size());
    const std::vector<Passed> passed = features_passed(candidates);
    for (std::size_t i = 1; i < passed.size(); ++i) {
        if (FeatureKey::order(passed[i - 1].key, passed[i].key) == 0) {
            joined.join(passed[i - 1].candidate, passed[i].candidate);
        }
    }
    return joined;
}

/// Returns the direction in which the moved ray crosses a triangle (+1 along the normal, -1 against it), or 0 if the
/// ray misses the triangle. The ray's origin is moved by an infinitesimal amount along x, and by still smaller amounts
/// along y and z. The moved ray hits neither edges nor vertices. Method: H. Edelsbrunner, E. P. Muecke, "Simulation of
/// Simplicity", ACM Transactions on Graphics 9, 1990.
int moved_crossing(const Ray& ray, const MetTriangle& met) {
    const RayIntersection& intersection = met.intersection;
    if (intersection.speed == 0) return 0;
    if (intersection.feature == TriangleFeature::kFace && intersection.t.hi > 0.0) return intersection.speed;
    const auto& [a, b, c] = met.corners;
    const ExactDifference u(b, a);
    const ExactDifference v(c, a);
    for (const int side : {moved_side(ray, a, b), moved_side(ray, b, c), moved_side(ray, c, a)}) {
        if (side != intersection.speed) return 0;
    }
    int height = detail::exact_determinant(u, v, ExactDifference(a, ray.origin)).sign();
    for (int axis = 0; axis < 3 && height == 0; ++axis) height = -detail::exact_cross_component(u, v, axis).sign();
    return height == intersection.speed ? intersection.speed : 0;
}

void append_crossings(const RayQuery& query, const MeshIndex& mesh, const std::vector<Candidate>& candidates,
                      std::vector<RayCrossing>& crossings) {
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    DisjointSets joined = join(candidates);
    std::vector<std::size_t> crossing_of(candidates.size(), kNone);
    for (std::uint32_t k = 0; k < candidates.size(); ++k) {
        const auto& [triangle, met] = candidates[k];
        if (mesh.is_degenerate(triangle)) continue;  // a degenerate triangle only joins hits of other triangles
        std::size_t& number = crossing_of[joined.find(k)];
        if (number == kNone) {
            number = crossings.size();
            crossings.push_back({met.intersection.t, triangle, 0, true});
        }
        RayCrossing& crossing_point = crossings[number];
        crossing_point.is_in_plane = crossing_point.is_in_plane && met.intersection.in_plane;
        crossing_point.crossing = static_cast<std::int8_t>(crossing_point.crossing + moved_crossing(query.ray, met));
    }
}

}  // namespace

int moved_side(const Ray& ray, const Vec3& p, const Vec3& q) {
    // Computes the sign of (p - o) x (q - o) . d for the ray's origin o and direction d. If the sign is 0, the first
    // nonzero component of the gradient with respect to o, -(q - p) x d, decides.
    const ExactDifference u(p, ray.origin);
    const ExactDifference v(q, ray.origin);
    const ExactDifference d(ray.direction, Vec3{});
    const int sign = detail::exact_determinant(u, v, d).sign();
    if (sign != 0) return sign;
    const ExactDifference side(q, p);
    for (int axis = 0; axis < 3; ++axis) {
        const int change = detail::exact_cross_component(d, side, axis).sign();
        if (change != 0) return change;
    }
    return 0;
}

std::optional<RayCrossing> first_crossing_on(const MeshIndex& mesh, const RayQuery& query) {
    const Reach reach(mesh, query);
    std::optional<Candidate> best;
    double limit = 1.0;
    mesh.hierarchy().query_tube(reach.tube, [&](std::uint32_t triangle, double enter, double /*leave*/) {
        if (enter > limit || mesh.is_degenerate(triangle)) return limit;
        const auto met = meet(mesh, query, triangle);
        if (!met) return limit;
        const Candidate candidate{triangle, *met};
        if (best && !comes_before(query.ray, candidate, *best)) return limit;
        best = candidate;
        limit = reach.fraction(met->intersection.t.hi);
        return limit;
    });
    if (!best) return std::nullopt;
    return RayCrossing{best->met.intersection.t, best->triangle, 0};
}

bool hits_anything(const MeshIndex& mesh, const RayQuery& query) {
    const Reach reach(mesh, query);
    bool found = false;
    mesh.hierarchy().query_tube(reach.tube, [&](std::uint32_t triangle, double, double) {
        if (!found && !mesh.is_degenerate(triangle)) found = meet(mesh, query, triangle).has_value();
        return found ? 0.0 : 1.0;
    });
    return found;
}

void all_crossings(const MeshIndex& mesh, const RayQuery& query, std::vector<RayCrossing>& crossings) {
    thread_local std::vector<Candidate> candidates;
    candidates.clear();
    crossings.clear();
    const Reach reach(mesh, query);
    mesh.hierarchy().query_tube(reach.tube, [&](std::uint32_t triangle, double, double) {
        if (const auto met = meet(mesh, query, triangle)) candidates.push_back({triangle, *met});
        return 1.0;
    });
    std::ranges::sort(candidates, [](const Candidate& x, const Candidate& y) { return x.triangle < y.triangle; });
    // The hierarchy may propose a triangle twice.
    candidates.erase(std::unique(candidates.begin(), candidates.end(),
                                 [](const Candidate& x, const Candidate& y) { return x.triangle == y.triangle; }),
                     candidates.end());
    std::ranges::sort(candidates,
                      [&](const Candidate& x, const Candidate& y) { return comes_before(query.ray, x, y); });
    append_crossings(query, mesh, candidates, crossings);
}

}  // namespace ricochet
