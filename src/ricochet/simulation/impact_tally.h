/// \file
/// Private to the simulation: effect of a substep's impacts on a body, and the end of the substep that they require.
#pragma once

#include <span>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/body_path.h"
#include "ricochet/core/mobility.h"
#include "ricochet/dynamics/driven_body.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Returns the impulse of a load and its moment about the point `center`.
[[nodiscard]] inline Wrench wrench_of(const ColliderLoad& load, const Vec3& center) {
    return {load.impulse, cross(load.particle_center - center, load.impulse) + load.couple};
}

/// Sums over the impacts on a body. The impacts are added one by one.
class ImpactTally {
public:
    /// id: of the body's colliders; kWorldBody without them. All arguments must outlive the object.
    ImpactTally(const DrivenBody& body, const BodyPath& path, const MovingColliders* colliders, BodyId id)
        : body_(&body), path_(&path), colliders_(colliders), id_(id), about_(body.moment_center()) {}

    void add(const ColliderLoad& load);
    /// Returns true if applying all impacts together at a time, in s, would change the energy considerably. The change
    /// is compared with the energy that the impacts dissipate if each acts alone. doubt: safety margin that is added to
    /// the change, as a fraction of the exchanged energies.
    [[nodiscard]] bool changes_energy(double time, double doubt = 0.0) const;
    /// Returns a body's velocity change, in m/s, by a wrench at the time and position of a load, about the same point.
    [[nodiscard]] double speed_by(const Wrench& wrench, const ColliderLoad& load) const;
    /// Returns the factor, at least 1, by which the body reacts more strongly to all impacts together at a time, in s,
    /// than to each impact alone: a ratio of energies. It is 1 if applying them together would not change the energy by
    /// much.
    [[nodiscard]] double reaction_factor(double time) const;
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
    double alone_ = 0.0;    // J, that the body would gain if each impact acted alone at its time
    double dynamic_ = 0.0;  // J, part of alone_ that the body would also gain at rest
    double lost_ = 0.0;     // J, that the impacts would dissipate if each acted alone
    double size_ = 0.0;     // J, sum of the magnitudes of works and lost energies
};

/// Recent contacts of a body.
struct BodyContacts {
    std::vector<std::uint64_t> before;  ///< ids of the particles that pushed the body in the last step, ascending
    std::vector<std::uint64_t> now;     ///< ids of the particles that have pushed the body in this step, ascending
    Wrench taken;  ///< impulses applied at the ends of substeps of this step, N s, and N m s about moment_center()

    [[nodiscard]] bool has(std::uint64_t particle) const {
        return std::ranges::binary_search(before, particle) || std::ranges::binary_search(now, particle);
    }
    /// Adds ids. They can be in any order.
    void add(const std::vector<std::uint64_t>& ids);
    void begin_step();
};

/// Returns true if the impulses before an impact change the body's velocity at the point of impact by much, compared
/// with the particle's velocity change in the impact. Returns false if a particle returns slowly to a body that it
/// touched recently, not much faster than the velocity change of the body in this step. Reason: each velocity jump of a
/// body releases resting particles, which then land again, and each landing would end the substep.
[[nodiscard]] bool changes_velocity(const ColliderLoad& impact, const Wrench& before, const ImpactTally& tally,
                                    const BodyContacts& contacts);

/// Returns the end of a substep, in s, whose last impact is by a particle that is heavy compared with the body: shortly
/// after the impact, but not after the next impact. time, next: times of both impacts, in s.
[[nodiscard]] double soon_after_impact(double time, double next);

/// Returns the end of a substep, in s, that contains the impacts `taken`. The last of these impacts is at `time`, and
/// the first impact after them is at `next`, both in s. The delay after the last impact is a power of kPartAfterImpact,
/// times the time to the next impact. If the impacts dissipate less energy, the delay is shorter. During the delay, the
/// bodies move as if nothing had hit them, and the particles that hit them follow the bodies or wait. begin: start of
/// the substep, in s. shortest: least duration, in s, if much energy is dissipated.
[[nodiscard]] double end_after(std::span<const ImpactTally> taken, double time, double next, double begin,
                               double shortest);

}  // namespace ricochet
