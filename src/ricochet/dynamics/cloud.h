/// \file
/// Particles that go with their parent: their places about it, and how they move relative to these.
#pragma once

#include "ricochet/dynamics/emitter.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Where a place about the parent is after a time, s, relative to the parent: it turns steadily about it.
[[nodiscard]] PhaseState turned_place(const CloudRule& rule, const Vec3& place, double age);

/// rad, by which a cloud turns or swings in a time, s.
[[nodiscard]] double cloud_turn(const CloudRule& rule, double duration);

/// What a child of a cloud does while its parent flies along one path, and what is done to it: the acceleration of its
/// place in the world, with what pulls it there. With d its distance from that place, d'' = -pull d - damping d', which
/// is solved in closed form.
class CloudMember final : public Coupling {
public:
    /// parent: its path, which begins at `begin`, s. place: about the parent, at the child's birth.
    CloudMember(const CloudRule& rule, const Path& parent, double begin, const Vec3& place, double birth_time)
        : rule_(rule), parent_(parent), begin_(begin), place_(place), birth_time_(birth_time) {}

    /// Its place in the world at a time, s.
    [[nodiscard]] PhaseState place_at(double time) const;
    /// Its state at `to` where it has this one at `from`, s, and nothing is in its way.
    [[nodiscard]] PhaseState after(const PhaseState& state, double from, double to) const;

    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override;
    [[nodiscard]] bool varies() const override { return true; }
    [[nodiscard]] bool replaces_forces() const override { return true; }

private:
    CloudRule rule_;
    Path parent_;
    double begin_;
    Vec3 place_;
    double birth_time_;
};

}  // namespace ricochet
