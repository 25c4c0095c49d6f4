/// \file
/// Private to the simulation: the path of a particle in a move, as legs between stored positions, and the changes of
/// side along a leg.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/coupled_member.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Number of bisections for the time of a passage. Local: more would exceed the precision of a double.
inline constexpr int kPassageHalvings = 64;

/// Part of a move along one path. `next` is the stored position at which the particle continues. It replaces the end of
/// the path, because after a contact the particle continues at a safe position.
struct PathLeg {
    const Path& path;
    double duration = 0.0;  ///< s, at most that of the path
    Vec3 next;              ///< m
    std::size_t piece = 0;  ///< index of the piece that gives the time and the velocity
    bool is_gap = false;    ///< true for the step from the stored position to the start of the first piece
};

/// Returns true if the particle does not move along a piece.
[[nodiscard]] inline bool is_still(const FlownPiece& piece) {
    return !(piece.duration > 0.0) ||
           (piece.path.c[1] == Vec3{} && piece.path.c[2] == Vec3{} && piece.path.c[3] == Vec3{});
}

/// Calls visit(leg) for each leg of a move between two stored positions, in m, in the order of time.
template <class Visit>
void for_each_leg(const Vec3& from, const Vec3& to, std::span<const FlownPiece> pieces, const Visit& visit) {
    const auto next_moving = [&](std::size_t k) {
        while (k < pieces.size() && is_still(pieces[k])) ++k;
        return k;
    };
    const std::size_t first = next_moving(0);
    const Vec3& start = first < pieces.size() ? pieces[first].path.c[0] : to;
    if (start != from) {
        const Path gap = line_path(from, start - from, 1.0);
        visit(PathLeg{gap, 1.0, start, first, true});
    }
    for (std::size_t k = first; k < pieces.size();) {
        const std::size_t next = next_moving(k + 1);
        const Vec3& end = next < pieces.size() ? pieces[next].path.c[0] : to;
        visit(PathLeg{pieces[k].path, pieces[k].duration, end, k, false});
        k = next;
    }
}

/// Times, in s, at which a path reaches an extreme height along a direction, in ascending order.
struct Extremes {
    std::array<double, 2> time{};
    int count = 0;
};

/// Returns the extremes of the height along a path within a duration, in s. The height is monotonic between two
/// extremes.
[[nodiscard]] Extremes extremes_of(const Path& path, const Vec3& normal, double duration);

/// Side of a plane on which a particle is. It follows legs and finds each change of side.
class SideTrace {
public:
    explicit SideTrace(bool is_in_front) : is_in_front_(is_in_front) {}

    [[nodiscard]] bool is_in_front() const { return is_in_front_; }

    /// Follows a leg. is_front(position): the side of a position, which depends only on the height along `normal`.
    /// report(is_front, s): called for each change of side, at the time s from the start of the leg.
    template <class IsFront, class Report>
    void follow(const PathLeg& leg, const Vec3& normal, const IsFront& is_front, const Report& report) {
        double from = 0.0;
        const Extremes extremes = extremes_of(leg.path, normal, leg.duration);
        for (int k = 0; k < extremes.count; ++k) {
            const double to = extremes.time[static_cast<std::size_t>(k)];
            pass(leg.path, from, to, is_front(leg.path.position(to)), is_front, report);
            from = to;
        }
        pass(leg.path, from, leg.duration, is_front(leg.next), is_front, report);
    }

private:
    template <class IsFront, class Report>
    void pass(const Path& path, double from, double to, bool is_in_front, const IsFront& is_front,
              const Report& report) {
        if (is_in_front == is_in_front_) return;
        for (int k = 0; k < kPassageHalvings; ++k) {
            const double middle = 0.5 * (from + to);
            (is_front(path.position(middle)) == is_in_front ? to : from) = middle;
        }
        is_in_front_ = is_in_front;
        report(is_in_front, to);
    }

    bool is_in_front_;
};

}  // namespace ricochet
