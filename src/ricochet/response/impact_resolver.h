/// \file
/// Resolves the impacts of one particle in one move, by the materials of the surfaces.
#pragma once

#include <array>
#include <span>

#include "ricochet/core/recorded_impact.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/impact_problem.h"
#include "ricochet/response/impulse_ledger.h"
#include "ricochet/response/surface_kinematics.h"

namespace ricochet {

/// Returns false if the path's numbers are so large that the exact predicates would leave the range of doubles.
[[nodiscard]] bool can_be_followed(const Path& path);

/// Resolves impacts. It changes the particle's velocity and spin, and records the impulses. Impacts are resolved in
/// world coordinates. Lasting contact writes to the same records in any reference frame.
///
/// reflect() calls resolve(). On one surface, try_single() applies the bounce, and reverts it if the particle then
/// approaches another surface. All surfaces are then resolved together.
class ImpactResolver {
public:
    /// All arguments must outlive the object.
    ImpactResolver(const ResponseRules& rules, MovingParticle& particle, MoveScratch& scratch, MoveOutcome& outcome,
                   const ReferenceFrame& reference = ReferenceFrame::world())
        : rules_(rules),
          particle_(particle),
          scratch_(scratch),
          outcome_(outcome),
          surfaces_(rules, particle, reference),
          ledger_(rules, particle, scratch, reference, surfaces_) {}
    ImpactResolver(const ImpactResolver&) = delete;
    ImpactResolver& operator=(const ImpactResolver&) = delete;

    /// Resolves an impact on all surfaces of a contact together. Returns false, and changes nothing, if none is
    /// approached. For the particle, dynamic bodies change their velocities at once; their positions follow their paths
    /// until the move ends. ends_substep: false for surfaces at rest and for an impact that begins contact.
    bool reflect(std::span<const ContactSurface> surfaces, bool ends_substep = true);
    /// Does the same without a rebound.
    void land(std::span<const ContactSurface> surfaces);
    /// Clears `is_support` of surfaces that no longer support the particle at an impact. The particle may separate from
    /// them, or their body may return after an impulse in this move.
    void release(Contact& contact) const;
    /// Removes a slow approach of the particle to bodies that move on their old paths. A body that recedes after an
    /// impulse still follows its old path in this move. Without the removal, the particle would hit it again and again.
    void go_with_paths(std::span<const ContactSurface> surfaces);
    /// Shatters the particle if a change of velocity, in m/s, reaches its shatter impulse.
    void shatter_by(const Vec3& velocity_change);

    [[nodiscard]] const SurfaceKinematics& surfaces() const { return surfaces_; }
    [[nodiscard]] ImpulseLedger& ledger() { return ledger_; }
    [[nodiscard]] const ImpulseLedger& ledger() const { return ledger_; }

private:
    enum class Rebound { by_material, none };  // none: for a landing
    using Foremost = std::array<ContactSurface, ImpactResult::kMostSurfaces>;

    void resolve(std::span<const ContactSurface> surfaces, Rebound rebound);
    [[nodiscard]] bool try_single(std::span<const ContactSurface> surfaces, const ContactSurface& surface,
                                  Rebound rebound);
    void resolve_simultaneously(std::span<const ContactSurface> surfaces, Rebound rebound);
    void apply(const ImpactResult& result, std::span<const ContactSurface> met, std::span<const bool> is_met,
               double scale, int pass);
    void resolve_sequentially(std::span<const ContactSurface> surfaces, Rebound rebound);
    [[nodiscard]] bool leave_no_way_out(std::span<const ContactSurface> surfaces, const Vec3& velocity,
                                        double speed) const;
    [[nodiscard]] std::span<const ContactSurface> foremost(std::span<const ContactSurface> surfaces,
                                                           Foremost& chosen) const;
    [[nodiscard]] ImpactSurface in_problem(const ContactSurface& surface, Rebound rebound) const;

    [[nodiscard]] ImpactLaw law_of(const ContactSurface& surface, Rebound rebound) const;
    void apply_bounce(const ContactSurface& surface, Rebound rebound);
    void bounce_off_body(const ContactSurface& surface, const ImpactLaw& law);
    [[nodiscard]] Motion random_reflection(Motion motion, const ContactSurface& surface, const Material& material,
                                           const ImpactLaw& law);

    void settle_on_supports(std::span<const ContactSurface> surfaces);
    void stop_approach(std::span<const ContactSurface> surfaces);
    void move_out_of_corner(std::span<const ContactSurface> surfaces);

    [[nodiscard]] RecordedImpact impact_before(std::span<const ContactSurface> surfaces) const;
    void record_impact(RecordedImpact impact, std::span<const ContactSurface> surfaces, Rebound rebound);

    const ResponseRules& rules_;
    MovingParticle& particle_;
    MoveScratch& scratch_;
    MoveOutcome& outcome_;
    SurfaceKinematics surfaces_;
    ImpulseLedger ledger_;
};

}  // namespace ricochet
