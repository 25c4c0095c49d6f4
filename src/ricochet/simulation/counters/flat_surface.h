/// \file
/// Private to the simulation: the flat surfaces of counters, and passages through them.
#pragma once

#include <array>
#include <span>

#include "ricochet/simulation/counters/counter.h"
#include "ricochet/simulation/counters/path_legs.h"

namespace ricochet {

/// The plane of a counter, and the part of it that counts. The sides of stored positions determine the passages, so no
/// passage is lost or counted twice.
class FlatSurface {
public:
    explicit FlatSurface(const DiskCounter& disk);
    explicit FlatSurface(const PlaneCounter& plane);
    explicit FlatSurface(const RectangleCounter& rectangle);

    /// Returns the height of a position above the plane, in m. It is negative behind the plane.
    [[nodiscard]] double height(const Vec3& position) const { return dot(normal_, position - center_); }
    /// Returns true if a position belongs to the front side.
    [[nodiscard]] bool is_in_front(const Vec3& position) const { return height(position) >= 0.0; }
    /// Returns true if the projection of a position onto the plane lies in the counted part or on its rim.
    [[nodiscard]] bool contains(const Vec3& position) const;
    [[nodiscard]] const Vec3& normal() const { return normal_; }

    /// Returns true if a move of a single piece certainly stays on one side, as most free flights do.
    [[nodiscard]] bool is_missed(const Vec3& from, const Vec3& to, std::span<const FlownPiece> pieces) const;
    /// Calls report(leg, is_forward, s, normal) for each passage of a move, at s seconds from the start of the leg.
    template <class Report>
    void trace(const Vec3& from, const Vec3& to, std::span<const FlownPiece> pieces, const Report& report) const {
        if (is_missed(from, to, pieces)) return;
        SideTrace side(is_in_front(from));
        for_each_leg(from, to, pieces, [&](const PathLeg& leg) {
            side.follow(
                leg, normal_, [&](const Vec3& position) { return is_in_front(position); },
                [&](bool is_forward, double s) {
                    if (contains(leg.path.position(s))) report(leg, is_forward, s, normal_);
                });
        });
    }

private:
    enum class Kind { disk, plane, rectangle };

    Kind kind_;
    Vec3 center_;
    Vec3 normal_;                     // of length 1
    double radius_ = 0.0;             // of a disk
    std::array<Vec3, 2> sides_{};     // unit vectors of a rectangle
    std::array<double, 2> halves_{};  // half lengths of a rectangle's sides
};

}  // namespace ricochet
