/// \file
/// Particles of a cloud: their positions about the parent, and their motion relative to these positions.
#pragma once

#include "ricochet/dynamics/emitter.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Returns the motion of a position about the parent after `age` seconds, relative to the parent. The position turns
/// about the parent at a constant rate.
[[nodiscard]] PhaseState turned_offset(const CloudRule& rule, const Vec3& offset, double age);

/// Returns the angle, in rad, by which a cloud turns or swings in `duration` seconds.
[[nodiscard]] double cloud_turn(const CloudRule& rule, double duration);

/// Motion of a child of a cloud while its parent flies along one path. As a coupling, it gives the acceleration of the
/// child's moving target position in the world, plus the pull towards it. With d the offset from the target, d'' =
/// -pull d - damping d', which is solved in closed form.
class CloudMember final : public Coupling {
public:
    /// parent: path of the parent, which begins at `begin`, in s. place: target position about the parent at the
    /// child's birth.
    CloudMember(const CloudRule& rule, const Path& parent, double begin, const Vec3& offset, double birth_time)
        : rule_(rule), parent_(parent), begin_(begin), place_(offset), birth_time_(birth_time) {}

    /// Returns the target position, with its velocity, in the world at a time, in s.
    [[nodiscard]] PhaseState offset_at(double time) const;
    /// Returns the state at `to`, in s, of a child that has `state` at `from` and hits nothing.
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
