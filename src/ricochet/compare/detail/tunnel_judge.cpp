#include "ricochet/compare/detail/tunnel_judge.h"

#include <algorithm>
#include <cstddef>
#include <variant>

#include "ricochet/core/tolerances.h"
#include "ricochet/verify/parity.h"

namespace ricochet::detail {
namespace {

bool same_place(const Vec3& a, const Vec3& b) {
    return max_abs(a - b) <= kSameCrossing * std::max(max_abs(a), max_abs(b));
}

/// Neighbouring triangles that a leg meets in their common edge are one crossing.
std::size_t count_crossings(const std::vector<Vec3>& places) {
    std::vector<Vec3> different;
    for (const Vec3& place : places) {
        const bool known = std::any_of(different.begin(), different.end(),
                                       [&](const Vec3& other) { return same_place(place, other); });
        if (!known) different.push_back(place);
    }
    return different.size();
}

template <class T>
void toggle(std::set<T>& set, const T& value) {
    if (!set.insert(value).second) set.erase(value);
}

ColliderKind kind_of(const Simulation& simulation, std::size_t i) {
    const ColliderShape& shape = simulation.colliders()[i].shape;
    if (std::holds_alternative<PlaneShape>(shape)) return ColliderKind::plane;
    if (std::holds_alternative<BallShape>(shape) || std::holds_alternative<CylinderShape>(shape)) {
        return ColliderKind::shape;
    }
    return count_open_edges(*simulation.collider_mesh(i)) == 0 ? ColliderKind::closed_mesh : ColliderKind::open_mesh;
}

}  // namespace

std::vector<ColliderKind> collider_kinds(const Simulation& simulation) {
    std::vector<ColliderKind> kinds;
    for (std::size_t i = 0; i < simulation.colliders().size(); ++i) kinds.push_back(kind_of(simulation, i));
    return kinds;
}

void TunnelJudge::add_step(std::span<const Violation> violations) {
    std::map<Pair, std::map<double, std::vector<Vec3>>> meetings;  // by leg, named by the time of its beginning
    std::set<Pair> flipped;
    for (const Violation& violation : violations) {
        if (!violation.collider) continue;
        const Pair pair{violation.particle, *violation.collider};
        if (violation.kind == ViolationKind::crossing) meetings[pair][violation.time].push_back(violation.place);
        if (violation.kind == ViolationKind::wrong_side) toggle(flipped, pair);
    }
    for (const auto& [pair, legs] : meetings) {
        const ColliderKind kind = colliders_[pair.second];
        if (kind != ColliderKind::shape) {
            judge_meetings(pair, kind, legs);
            continue;
        }
        // A leg that met a shape has gone in, come out, or passed through it. Ins and outs change the side, so where
        // the number of legs and the change of side do not agree, one has passed through.
        std::size_t met = flipped.contains(pair) ? 1 : 0;
        for (const auto& [time, places] : legs) met += places.size();
        if (met % 2 == 1) jumped_.insert(pair.first);
    }
    for (const Pair& pair : flipped) toggle(odd_, pair);
}

void TunnelJudge::judge_meetings(const Pair& pair, ColliderKind kind, const std::map<double, std::vector<Vec3>>& legs) {
    for (const auto& [time, places] : legs) {
        const std::size_t crossings = count_crossings(places);
        if (kind == ColliderKind::open_mesh && crossings % 2 == 1) toggle(odd_, pair);
        if (kind == ColliderKind::closed_mesh && crossings % 2 == 0) jumped_.insert(pair.first);
    }
}

TunnelCounts TunnelJudge::verdict(const std::function<bool(std::uint64_t)>& is_penetrating) const {
    std::set<std::uint64_t> wrong;
    for (const Pair& pair : odd_) wrong.insert(pair.first);
    std::set<std::uint64_t> tunnelled = jumped_;
    TunnelCounts counts;
    for (const std::uint64_t particle : wrong) {
        if (is_penetrating(particle)) {
            ++counts.penetrating;
        } else {
            tunnelled.insert(particle);
        }
    }
    counts.wrong_side = wrong.size();
    counts.jumped = jumped_.size();
    counts.tunnelled = tunnelled.size();
    return counts;
}

}  // namespace ricochet::detail
