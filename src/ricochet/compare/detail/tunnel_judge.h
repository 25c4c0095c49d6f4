/// \file
/// From what the verifier reports to who went through what: the verdict on a run's particles.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/compare/figures.h"
#include "ricochet/simulation.h"
#include "ricochet/verify/violation.h"

namespace ricochet::detail {

/// What the verifier can say of a collider.
enum class ColliderKind : std::uint8_t {
    plane,        ///< sides; a leg meets it once at most
    shape,        ///< ball or cylinder: sides; a leg that meets it is reported once, however often it does
    closed_mesh,  ///< sides, and every triangle that a leg meets
    open_mesh,    ///< every triangle that a leg meets
};

[[nodiscard]] std::vector<ColliderKind> collider_kinds(const Simulation& simulation);

/// Follows a run. The order in which violations are given within a step does not matter.
class TunnelJudge {
public:
    explicit TunnelJudge(std::vector<ColliderKind> colliders) : colliders_(std::move(colliders)) {}

    /// Takes what was found wrong in one step.
    void add_step(std::span<const Violation> violations);
    /// is_penetrating: of a particle's id, whether the response was pushing it back when it was seen last.
    [[nodiscard]] TunnelCounts verdict(const std::function<bool(std::uint64_t)>& is_penetrating) const;

private:
    using Pair = std::pair<std::uint64_t, std::uint32_t>;  // particle, collider

    void judge_meetings(const Pair& pair, ColliderKind kind, const std::map<double, std::vector<Vec3>>& legs);

    std::vector<ColliderKind> colliders_;
    std::set<Pair> odd_;  // where the particle is on the wrong side now
    std::set<std::uint64_t> jumped_;
};

}  // namespace ricochet::detail
