/// \file
/// Private to the simulation: the box of a counter, and passages through its faces.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/simulation/counters/counter.h"
#include "ricochet/simulation/counters/path_legs.h"

namespace ricochet {

/// The box of a counter. A position is inside if it is on the inner side of all six faces. A particle passes when this
/// changes, so a path through an edge or a corner passes once, and no passage is lost between two steps.
class BoxSurface {
public:
    explicit BoxSurface(const BoxCounter& box);

    /// Returns true if a position is inside. The faces at the lower ends belong to the inside.
    [[nodiscard]] bool contains(const Vec3& position) const;

    /// Calls report(leg, is_forward, s, normal) for each passage of a move, at s seconds from the start of the leg. The
    /// normal of the face points inward.
    template <class Report>
    void trace(const Vec3& from, const Vec3& to, std::span<const FlownPiece> pieces, const Report& report) const {
        if (is_missed(from, to, pieces)) return;
        std::array<bool, kFaces> sides{};
        for (std::size_t face = 0; face < kFaces; ++face) sides[face] = is_behind(face, from);
        std::vector<Change> changes;
        for_each_leg(from, to, pieces, [&](const PathLeg& leg) {
            find_changes(leg, sides, changes);
            apply(changes, sides, [&](bool is_forward, const Change& change) {
                report(leg, is_forward, change.time, inward_normal(change.face));
            });
        });
    }

private:
    static constexpr std::size_t kFaces = 6;

    /// The particle moves to the other side of the plane of a face.
    struct Change {
        double time = 0.0;  // from the start of the leg, s
        std::size_t face = 0;
        bool is_inner = false;  // true if it moves to the inner side
    };

    [[nodiscard]] bool is_missed(const Vec3& from, const Vec3& to, std::span<const FlownPiece> pieces) const;
    /// Returns true if a position is on the inner side of the plane of a face.
    [[nodiscard]] bool is_behind(std::size_t face, const Vec3& position) const;
    [[nodiscard]] static Vec3 inward_normal(std::size_t face);
    /// Finds the changes along a leg in the order of time. sides: state at the start of the leg.
    void find_changes(const PathLeg& leg, const std::array<bool, kFaces>& sides, std::vector<Change>& changes) const;
    /// Applies changes to the sides. Changes at the same time count together. enter(is_forward, change): called when
    /// the particle enters or leaves the box.
    template <class Enter>
    static void apply(const std::vector<Change>& changes, std::array<bool, kFaces>& sides, const Enter& enter) {
        const auto is_inside = [&] { return sides == std::array<bool, kFaces>{true, true, true, true, true, true}; };
        for (std::size_t k = 0; k < changes.size();) {
            const bool was_inside = is_inside();
            const std::size_t first = k;
            for (; k < changes.size() && changes[k].time == changes[first].time; ++k) {
                sides[changes[k].face] = changes[k].is_inner;
            }
            if (is_inside() != was_inside) enter(!was_inside, changes[first]);
        }
    }

    Box3 box_;
};

}  // namespace ricochet
