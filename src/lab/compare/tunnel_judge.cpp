#include "lab/compare/tunnel_judge.h"

#include <algorithm>
#include <cstddef>
#include <variant>

#include "ricochet/verify/parity.h"

namespace ricochet {
namespace {

/// Distance, as a fraction of the largest coordinate, below which two crossings of a segment through neighbouring
/// triangles count as one. Reason: a segment through an edge crosses both triangles at points that differ only by
/// rounding. Smaller: such a crossing counts twice, so that the parity for an open surface indicates no crossing.
/// Larger: the two faces of a thin plate count as one. Local: only the comparison counts crossings.
constexpr double kSameCrossing = 1e-9;

bool same_position(const Vec3& a, const Vec3& b) {
    return max_abs(a - b) <= kSameCrossing * std::max(max_abs(a), max_abs(b));
}

/// Returns the number of crossings of a segment. If the segment crosses neighbouring triangles in their common edge,
/// they count as one crossing.
std::size_t count_crossings(const std::vector<const Violation*>& meetings) {
    std::vector<Vec3> different;
    for (const Violation* crossing : meetings) {
        const bool known = std::any_of(different.begin(), different.end(),
                                       [&](const Vec3& other) { return same_position(crossing->position, other); });
        if (!known) different.push_back(crossing->position);
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
    std::map<Pair, Segments> meetings;
    std::set<Pair> flipped;
    for (const Violation& violation : violations) {
        if (!violation.collider) continue;
        const Pair pair{violation.particle, *violation.collider};
        if (violation.kind == ViolationKind::crossing) meetings[pair][violation.time].push_back(&violation);
        if (violation.kind == ViolationKind::wrong_side) toggle(flipped, pair);
    }
    for (const auto& [pair, segments] : meetings) {
        const ColliderKind kind = colliders_[pair.second];
        if (kind == ColliderKind::shape) judge_shape(pair, segments, flipped.contains(pair));
        if (kind == ColliderKind::closed_mesh || kind == ColliderKind::open_mesh) judge_mesh(pair, kind, segments);
    }
    for (const Pair& pair : flipped) toggle(odd_, pair);
}

// Each segment that crosses a shape enters it, leaves it, or passes through it. Entering and leaving change the side of
// the particle. If no segment passes through, the particle is on another side after the step if and only if the number
// of segments is odd. If this does not match the verifier's report, at least one segment passed through the shape.
void TunnelJudge::judge_shape(const Pair& pair, const Segments& segments, bool flipped) {
    std::size_t count = 0;
    for (const auto& [time, crossings] : segments) count += crossings.size();
    const bool agrees = (count % 2 == 1) == flipped;
    if (!agrees) jumped_.insert(pair.first);
    if (!agrees && flipped) change_side(pair, *segments.rbegin()->second.back());
    if (!agrees) return;
    for (const auto& [time, crossings] : segments) {
        for (const Violation* crossing : crossings) change_side(pair, *crossing);
    }
}

void TunnelJudge::judge_mesh(const Pair& pair, ColliderKind kind, const Segments& segments) {
    for (const auto& [time, meetings] : segments) {
        const bool is_odd = count_crossings(meetings) % 2 == 1;
        if (kind == ColliderKind::open_mesh) {
            if (is_odd) toggle(odd_, pair);
        } else if (is_odd) {
            change_side(pair, *meetings.front());
        } else {
            jumped_.insert(pair.first);
        }
    }
}

// If the response pushes a particle back, the particle leaves the collider near its entry, where the normal is similar.
// If the normals at entry and exit point in opposite directions, the particle has passed through.
void TunnelJudge::change_side(const Pair& pair, const Violation& crossing) {
    const Vec3 normal = normal_at_(crossing);
    const auto [entry, is_entry] = went_in_.try_emplace(pair, normal);
    if (is_entry) return;
    if (dot(entry->second, normal) < 0.0) passed_.insert(pair.first);
    went_in_.erase(entry);
}

TunnelCounts TunnelJudge::verdict(const std::function<bool(std::uint64_t)>& is_penetrating) const {
    std::set<std::uint64_t> wrong;
    for (const Pair& pair : odd_) wrong.insert(pair.first);
    std::set<std::uint64_t> tunnelled = jumped_;
    tunnelled.insert(passed_.begin(), passed_.end());
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
    counts.passed = passed_.size();
    counts.tunnelled = tunnelled.size();
    return counts;
}

}  // namespace ricochet
