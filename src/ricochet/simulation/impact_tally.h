/// \file
/// Private to the simulation: the effect of a substep's impacts on a body, and the end of the substep that they
/// require.
#pragma once

#include <span>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/body_path.h"
#include "ricochet/core/mobility.h"
#include "ricochet/dynamics/driven_body.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Returns the impulse of a load, with its moment about a point.
[[nodiscard]] inline Wrench wrench_of(const ColliderLoad& load, const Vec3& center) {
    return {load.impulse, cross(load.particle_center - center, load.impulse) + load.couple};
}

/// Sums over impacts on a body, which are added one after the other.
class ImpactTally {
public:
    /// id: body id of its colliders, kWorldBody if it has none. All must outlive it.
    ImpactTally(const DrivenBody& body, const BodyPath& path, const MovingColliders* colliders, BodyId id)
        : body_(&body), path_(&path), colliders_(colliders), id_(id), about_(body.moment_center()) {}

    void add(const ColliderLoad& load);
    /// Returns true if the impacts, all applied at a time, in s, would change the energy by much. The change is
    /// compared with the energy that each of them alone dissipates. doubt: part of the exchanged energies that also
    /// counts as a change.
    [[nodiscard]] bool changes_energy(double time, double doubt = 0.0) const;
    /// Returns the velocity change of the body, in m/s, at the time and position of a load, by an impulse. The moment
    /// of the impulse is about the same point as that of wrench().
    [[nodiscard]] double speed_by(Wrench wrench, const ColliderLoad& load) const;
    /// Returns how many times as much the body reacts to all impacts at a time, in s, as to each alone. The result is a
    /// ratio of energies, at least 1. It is 1 if applying all at that time would not change the energy.
    [[nodiscard]] double share(double time) const;
    [[nodiscard]] const Wrench& wrench() const { return wrench_; }

private:
    struct BodyOnPath;
    [[nodiscard]] BodyOnPath at(double time) const;

    const DrivenBody* body_;
    const BodyPath* path_;
    const MovingColliders* colliders_;
    BodyId id_;
    Vec3 about_;  // m, reference point of moments
    int count_ = 0;
    Wrench wrench_;
    double alone_ = 0.0;    // J, that the body would get from each impact alone, at its time
    double dynamic_ = 0.0;  // J, part of alone_: energy that each impact would give the body at rest
    double lost_ = 0.0;     // J, that each impact alone dissipates
    double size_ = 0.0;     // J, sum of the magnitudes of the terms
};

/// Recent contacts of a body.
struct BodyContacts {
    std::vector<std::uint64_t> before;  ///< ids of the particles that pushed it in the last step, in their order
    std::vector<std::uint64_t> now;     ///< ids of the particles that have pushed it in this one
    Wrench taken;  ///< N s, N m s about its moment_center(), applied to it at the ends of substeps of this step

    [[nodiscard]] bool has(std::uint64_t particle) const {
        return std::binary_search(before.begin(), before.end(), particle) ||
               std::binary_search(now.begin(), now.end(), particle);
    }
    /// Adds ids in any order.
    void add(const std::vector<std::uint64_t>& ids);
    void begin_step();
};

/// Returns true if the impulses before an impact change the velocity of the body there by much compared with the
/// impact. Returns false if a particle comes back slowly to a body that it touched recently. Slowly means: not much
/// faster than the body's velocity has changed in this step. Each velocity jump of a body releases resting particles,
/// which land again. They would cut the step each time.
[[nodiscard]] bool changes_velocity(const ColliderLoad& impact, const Wrench& before, const ImpactTally& tally,
                                    const BodyContacts& contacts);

/// Returns the end of a substep, in s, whose last impact is that of a particle that is heavy compared with the body. It
/// is as soon after the impact as can be told apart, and not after the next one.
[[nodiscard]] double soon_after_impact(double time, double next);

/// Returns the end of a substep, in s, with the impacts `taken`, the last one at a time, before the next one. The delay
/// after the last impact is a power of kPartAfterImpact, times the time to the next impact. It ends the sooner, the
/// less energy the impacts dissipate. Until then the bodies move as if nothing had hit them, and the particles that hit
/// them follow them or wait. begin: start of the substep, in s. shortest: least duration, in s, if much energy is
/// dissipated.
[[nodiscard]] double end_after(std::span<const ImpactTally> taken, double time, double next, double begin,
                               double shortest);

}  // namespace ricochet
