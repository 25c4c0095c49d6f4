/// \file
/// Private to the simulation: what the impacts of a part of a step would do to a body, and when the part has to end.
#pragma once

#include <span>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/body_path.h"
#include "ricochet/core/mobility.h"
#include "ricochet/dynamics/driven_body.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// The impulse of a load, with its moment about a point.
[[nodiscard]] inline Wrench wrench_of(const ColliderLoad& load, const Vec3& center) {
    return {load.impulse, cross(load.particle_center - center, load.impulse) + load.couple};
}

/// A list of impacts on a body, as they are added one after the other.
class ImpactTally {
public:
    /// id: that of its colliders; kWorldBody where it has none. All must outlive it.
    ImpactTally(const DrivenBody& body, const BodyPath& path, const MovingColliders* colliders, BodyId id)
        : body_(&body), path_(&path), colliders_(colliders), id_(id), about_(body.moment_center()) {}

    void add(const ColliderLoad& load);
    /// True when all of them, taken together at a time, s, would change the energy by much of what each by itself takes
    /// off. doubt: such a part of the energies that are exchanged counts as a change, too.
    [[nodiscard]] bool changes_energy(double time, double doubt = 0.0) const;
    /// m/s, by which an impulse with its moment about the same point as wrench() changes the velocity of the body where
    /// a load is, at its time.
    [[nodiscard]] double speed_by(Wrench wrench, const ColliderLoad& load) const;
    /// How many times as much the body yields to all of them at a time, s, as to each by itself; at least 1, and 1
    /// where that would not change the energy.
    [[nodiscard]] double share(double time) const;
    [[nodiscard]] const Wrench& wrench() const { return wrench_; }

private:
    struct BodyOnPath;
    [[nodiscard]] BodyOnPath at(double time) const;

    const DrivenBody* body_;
    const BodyPath* path_;
    const MovingColliders* colliders_;
    BodyId id_;
    Vec3 about_;  // m, that moments are about
    int count_ = 0;
    Wrench wrench_;
    double alone_ = 0.0;    // J, that the body would take from each by itself, at its time
    double dynamic_ = 0.0;  // J, of that: what it would take from each, were it at rest
    double lost_ = 0.0;     // J, that each by itself takes off
    double size_ = 0.0;     // J, of what was added up
};

/// What has come to a body of late.
struct BodyContacts {
    std::vector<std::uint64_t> before;  ///< ids of the particles that pushed it in the last step, in their order
    std::vector<std::uint64_t> now;     ///< of those that have pushed it in this one
    Wrench taken;  ///< N s, N m s about its moment_center(), that it has taken at the ends of parts of this step

    [[nodiscard]] bool has(std::uint64_t particle) const {
        return std::binary_search(before.begin(), before.end(), particle) ||
               std::binary_search(now.begin(), now.end(), particle);
    }
    /// ids: in any order.
    void add(const std::vector<std::uint64_t>& ids);
    void begin_step();
};

/// True when what a body has been given before changes its velocity where an impact is by much of what that changes.
/// Not where a particle comes back to a body that it has touched of late, not much faster than that has been changed in
/// this step: what lies on a body is let go by each jump of its velocity and lands again, and would cut the step each
/// time.
[[nodiscard]] bool changes_velocity(const ColliderLoad& impact, const Wrench& before, const ImpactTally& tally,
                                    const BodyContacts& contacts);

/// When a part ends, s, whose last impact is that of a particle that is heavy beside what it hits: as soon after it as
/// can be told, and not after the next one.
[[nodiscard]] double soon_after_impact(double time, double next);

/// When a part ends, s, in which these impacts have come, the last one at a time, before the next one: soon after it,
/// by a power of kPartAfterImpact, and the sooner the less they take off. Till then the bodies go on as if nothing had
/// hit them, and what has pushed one away goes along or waits. begin, shortest: when it begins, and how long it lasts
/// at least where much is taken off, s.
[[nodiscard]] double end_after(std::span<const ImpactTally> taken, double time, double next, double begin,
                               double shortest);

}  // namespace ricochet
