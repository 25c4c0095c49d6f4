/// \file
/// Particles of a cloud: their target positions relative to the parent, and their motion relative to these targets.
#pragma once

#include "ricochet/dynamics/emitter.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Returns position and velocity, relative to the parent, of a target position after `age` seconds. The target turns
/// about the parent at a constant rate.
[[nodiscard]] PhaseState turned_offset(const CloudRule& rule, const Vec3& offset, double age);

/// Returns the largest phase angle, in rad, of the cloud's rotation, oscillation and damping in `duration` seconds.
[[nodiscard]] double cloud_turn(const CloudRule& rule, double duration);

/// Motion of a child of a cloud while its parent flies along one path. As a coupling, it provides the acceleration of
/// the child's target, plus that towards the target. The offset d from the target obeys d'' = -pull d - damping d',
/// which is solved in closed form.
class CloudMember final : public Coupling {
public:
    /// parent: path of the parent. begin: start time of that path, in s. offset: target position relative to the parent
    /// at the child's birth, in m.
    CloudMember(const CloudRule& rule, const Path& parent, double begin, const Vec3& offset, double birth_time)
        : rule_(rule), parent_(parent), begin_(begin), offset_(offset), birth_time_(birth_time) {}

    /// Returns position and velocity of the target in the world at a time, in s.
    [[nodiscard]] PhaseState offset_at(double time) const;
    /// Returns the state at time `to` of a child that has `state` at time `from`, in s, and hits nothing in between.
    [[nodiscard]] PhaseState after(const PhaseState& state, double from, double to) const;

    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override;
    [[nodiscard]] bool varies() const override { return true; }
    [[nodiscard]] bool replaces_forces() const override { return true; }

private:
    CloudRule rule_;
    Path parent_;
    double begin_;
    Vec3 offset_;
    double birth_time_;
};

}  // namespace ricochet
