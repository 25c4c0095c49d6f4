/// \file
/// Decision which particles tunnelled, based on the violations that the verifier reports.
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

/// Kinds of colliders. The comment of each kind lists the violations that the verifier reports for it.
enum class ColliderKind : std::uint8_t {
    plane,  ///< changes of side, and crossings; a segment crosses a plane at most once
    /// Ball or cylinder: changes of side, and one crossing per segment, even if the segment crosses the surface twice.
    shape,
    closed_mesh,  ///< changes of side, and one crossing for each triangle that a segment crosses
    open_mesh,    ///< one crossing for each triangle that a segment crosses; no changes of side
};

[[nodiscard]] std::vector<ColliderKind> collider_kinds(const Simulation& simulation);

/// Function that returns the normal of the surface at a reported crossing. The normal can have any length.
using NormalAt = std::function<Vec3(const Violation&)>;

/// Counter of the particles of a run that went through surfaces. The order of violations within a step does not matter.
class TunnelJudge {
public:
    TunnelJudge(std::vector<ColliderKind> colliders, NormalAt normal_at)
        : colliders_(std::move(colliders)), normal_at_(std::move(normal_at)) {}

    /// Adds the violations of one step.
    void add_step(std::span<const Violation> violations);
    /// Returns the counts. `is_penetrating` returns, for a particle's id, true if the response was pushing the particle
    /// back after the particle's last step.
    [[nodiscard]] TunnelCounts verdict(const std::function<bool(std::uint64_t)>& is_penetrating) const;

private:
    using Pair = std::pair<std::uint64_t, std::uint32_t>;              // ids of a particle and a collider
    using Segments = std::map<double, std::vector<const Violation*>>;  // crossings by the start time of their segment

    void judge_shape(const Pair& pair, const Segments& segments, bool flipped);
    void judge_mesh(const Pair& pair, ColliderKind kind, const Segments& segments);
    void change_side(const Pair& pair, const Violation& crossing);

    std::vector<ColliderKind> colliders_;
    NormalAt normal_at_;
    std::set<Pair> odd_;  // pairs in which the particle is currently on the wrong side
    // Surface normals at the crossings by which particles went to the wrong side of a closed collider.
    std::map<Pair, Vec3> went_in_;
    std::set<std::uint64_t> jumped_;
    std::set<std::uint64_t> passed_;
};

}  // namespace ricochet
