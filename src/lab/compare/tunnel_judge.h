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

#include "lab/compare/figures.h"
#include "ricochet/core/vec3.h"
#include "ricochet/simulation.h"
#include "ricochet/verify/verifier.h"

namespace ricochet {

/// What the verifier can say of a collider.
enum class ColliderKind : std::uint8_t {
    plane,        ///< sides; a segment crosses it once at most
    shape,        ///< ball or cylinder: sides; a segment that crosses it is reported once, however often it does
    closed_mesh,  ///< sides, and every triangle that a segment crosses
    open_mesh,    ///< every triangle that a segment crosses
};

[[nodiscard]] std::vector<ColliderKind> collider_kinds(const Simulation& simulation);

/// Where the surface faces where a crossing was reported; of any length.
using NormalAt = std::function<Vec3(const Violation&)>;

/// Follows a run. The order in which violations are given within a step does not matter.
class TunnelJudge {
public:
    TunnelJudge(std::vector<ColliderKind> colliders, NormalAt normal_at)
        : colliders_(std::move(colliders)), normal_at_(std::move(normal_at)) {}

    /// Takes what was found wrong in one step.
    void add_step(std::span<const Violation> violations);
    /// is_penetrating: of a particle's id, whether the response was pushing it back when it was seen last.
    [[nodiscard]] TunnelCounts verdict(const std::function<bool(std::uint64_t)>& is_penetrating) const;

private:
    using Pair = std::pair<std::uint64_t, std::uint32_t>;              // particle, collider
    using Segments = std::map<double, std::vector<const Violation*>>;  // by the time of the segment's beginning

    void judge_shape(const Pair& pair, const Segments& segments, bool flipped);
    void judge_mesh(const Pair& pair, ColliderKind kind, const Segments& segments);
    void change_side(const Pair& pair, const Violation& crossing);

    std::vector<ColliderKind> colliders_;
    NormalAt normal_at_;
    std::set<Pair> odd_;            // where the particle is on the wrong side now
    std::map<Pair, Vec3> went_in_;  // the surface's normal where it went to the other side of a closed collider
    std::set<std::uint64_t> jumped_;
    std::set<std::uint64_t> passed_;
};

}  // namespace ricochet
