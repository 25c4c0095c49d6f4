/// \file
/// Moves one particle over one step, as a loop over named stages.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "ricochet/response/contact_phase.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/reference_frame.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Moves one particle over one step. The stages:
/// 1. Resume contact: lasting contact continues from the last step.
/// 2. Advance flight: the integrator gives a path; its first contact is found; the particle moves there in certified
///    segments and stops at a safe position.
/// 3. Resolve impact: restitution, friction and spin. mover_among_bodies.cpp has impacts on bodies.
/// 4. Begin or continue contact: if the rebound is slow, the particle slides, rolls or rests on the surfaces.
/// 5. Finish.
/// Stages 2 to 4 repeat until the time is used up. Stages 1, 2 and 4 return the next contact, if there is one.
class ParticleMover {
public:
    /// All arguments must outlive the object.
    ParticleMover(const ResponseRules& rules, const FrameRules& frame_rules, MovingParticle& particle, double duration,
                  MoveScratch& scratch)
        : rules_(rules),
          frame_rules_(frame_rules),
          particle_(particle),
          step_(rules, particle, duration, scratch),
          contact_phase_(step_) {}

    /// planned: the first flight, if the caller has computed it; only for a particle without contact.
    MoveOutcome run(const Flight* planned = nullptr);

private:
    [[nodiscard]] std::optional<Contact> resume_contact();
    /// is_first: the flight does not continue the last one.
    [[nodiscard]] std::optional<Contact> advance_flight(Flight& flight, bool is_first, const Flight* planned);
    [[nodiscard]] bool may_resolve_contact();
    [[nodiscard]] std::optional<Contact> resolve_contact(const Flight& flight, Contact& contact);
    [[nodiscard]] std::optional<Contact> resolve_contact_at_rest(const Flight& flight, const Contact& contact);
    void count_impact(const Flight& flight, bool is_impact, bool is_resumed);
    [[nodiscard]] std::optional<Contact> begin_or_continue_contact(const Flight& flight, const Contact& contact,
                                                                   const Motion& arriving);
    [[nodiscard]] std::optional<Contact> continue_contact(const Flight& flight, const Contact& contact);
    void finish();

    // Impacts on bodies.

    struct ImpactOnBody {
        Motion arriving;            ///< the motion before it
        double slowest_rebound;     ///< m/s; slower rebounds are contact
        bool ends_substep = false;  ///< a dynamic body gets another velocity at once, see ImpactResolver::reflect()
        /// Speed, in m/s, at which a body's velocity jump had released the particle, if the impact resumes that
        /// contact.
        std::optional<double> release_speed{};
    };

    [[nodiscard]] std::optional<Contact> resolve_contact_with_bodies(const Flight& flight, const Contact& contact);
    [[nodiscard]] ImpactOnBody resolve_impact_on_body(const Flight& flight, const Contact& contact);
    void retract_kick(const Flight& flight);
    void leave_flight();

    // Contact in the world and on bodies.
    [[nodiscard]] std::optional<Contact> resume_among_bodies();
    [[nodiscard]] std::optional<Contact> begin_contact(const Flight& flight, const Contact& contact,
                                                       const Motion& arriving);
    [[nodiscard]] std::optional<Contact> begin_in_frame(BodyId body, const Contact& contact, const Motion& arriving);
    [[nodiscard]] std::optional<Contact> begin_shared();
    [[nodiscard]] std::optional<Contact> follow_shared();
    template <class Follow>
    [[nodiscard]] std::optional<Contact> follow_in_frame(BodyId body, Contact* contact, const Follow& follow);
    template <class Follow>
    [[nodiscard]] std::optional<Contact> follow_in_frame_unsettled(BodyId body, Contact* contact, const Follow& follow);

    // Bodies that recede from the particle.
    [[nodiscard]] bool follows_receding_body(std::optional<Contact>& contact);
    [[nodiscard]] std::optional<Contact> follow_receding_body(const Contact& contact);
    [[nodiscard]] bool is_released_by_jump() const;

    [[nodiscard]] bool meets_moving(const Contact& contact) const {
        return std::ranges::any_of(contact.all(), [&](const ContactSurface& surface) {
            return rules_.bodies.body_of(surface.surface) != kWorldBody;
        });
    }
    [[nodiscard]] const SurfaceKinematics& surfaces() const { return step_.impact().surfaces(); }
    [[nodiscard]] ImpulseLedger& ledger() { return step_.impact().ledger(); }

    const ResponseRules& rules_;
    const FrameRules& frame_rules_;
    MovingParticle& particle_;
    ParticleStep step_;
    ContactPhase contact_phase_;
    std::uint32_t meetings_at_check_ = 0;  // of may_resolve_contact()
    double remaining_at_check_ = std::numeric_limits<double>::infinity();
    int shared_count_ = 0;         // number of contacts with several frames at once
    bool has_met_moving_ = false;  // true if it has touched a surface of a body in this step
    bool flies_anew_ = false;      // true if the next flight begins after contact on a body
    /// True if flights in the rest of the step start without a kick. Another kick would move a particle that leaves a
    /// surface back onto it at once.
    bool is_without_impulse_ = false;
    /// Set in flight after a velocity jump of a body has released the particle. See ContactState::release_speed().
    std::optional<double> release_speed_;
};

}  // namespace ricochet
