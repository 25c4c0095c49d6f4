/// \file
/// Decides which particles tunnelled, from the violations that the verifier reports.
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

/// Kinds of colliders, by the facts that the verifier reports about them.
enum class ColliderKind : std::uint8_t {
    plane,        ///< sides; a segment crosses it once at most
    shape,        ///< ball or cylinder: sides; a segment reports one crossing, however often it crosses
    closed_mesh,  ///< sides, and every triangle that a segment crosses
    open_mesh,    ///< every triangle that a segment crosses
};

[[nodiscard]] std::vector<ColliderKind> collider_kinds(const Simulation& simulation);

/// Normal of the surface at a reported crossing; of any length.
using NormalAt = std::function<Vec3(const Violation&)>;

/// Judges the particles of a run. The order of violations within a step does not matter.
class TunnelJudge {
public:
    TunnelJudge(std::vector<ColliderKind> colliders, NormalAt normal_at)
        : colliders_(std::move(colliders)), normal_at_(std::move(normal_at)) {}

    /// Adds the violations of one step.
    void add_step(std::span<const Violation> violations);
    /// Returns the counts. `is_penetrating` returns, for a particle's id, whether the response was pushing it back when
    /// it was last seen.
    [[nodiscard]] TunnelCounts verdict(const std::function<bool(std::uint64_t)>& is_penetrating) const;

private:
    using Pair = std::pair<std::uint64_t, std::uint32_t>;              // particle, collider
    using Segments = std::map<double, std::vector<const Violation*>>;  // by the start time of the segment

    void judge_shape(const Pair& pair, const Segments& segments, bool flipped);
    void judge_mesh(const Pair& pair, ColliderKind kind, const Segments& segments);
    void change_side(const Pair& pair, const Violation& crossing);

    std::vector<ColliderKind> colliders_;
    NormalAt normal_at_;
    std::set<Pair> odd_;  // pairs in which the particle is on the wrong side now
    // Normal of the surface where the particle went to the other side of a closed collider.
    std::map<Pair, Vec3> went_in_;
    std::set<std::uint64_t> jumped_;
    std::set<std::uint64_t> passed_;
};

}  // namespace ricochet
