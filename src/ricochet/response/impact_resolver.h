/// \file
/// Private to the responses: how one particle answers an impact, with its surfaces' materials, and how that is
/// recorded.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/response/contact_motion.h"
#include "ricochet/response/impact_problem.h"
#include "ricochet/response/impulse_recorder.h"
#include "ricochet/response/reference_frame.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// States beyond this cannot be followed: the predicates would leave the range of doubles.
[[nodiscard]] bool can_be_followed(const Path& path);

/// The impacts of one particle in one step. Impacts are answered in the world, contact that lasts in any frame.
class ImpactResolver {
public:
    ImpactResolver(const ResponseRules& rules, MovingParticle& particle, MoveScratch& scratch, MoveOutcome& outcome,
                   const ReferenceFrame& reference = ReferenceFrame::world())
        : rules_(rules),
          particle_(particle),
          scratch_(scratch),
          outcome_(outcome),
          reference_(reference),
          recorder_(rules, particle, scratch, reference),
          moment_center_(particle.state.position) {}

    /// Bounces off the surfaces that are touched, all of them together. Returns false, and does nothing, where none is
    /// approached. Bodies that yield move, for the particle, with what it has given to them in this move; where they
    /// are does not change by that before the move's end.
    bool reflect(std::span<const ContactSurface> surfaces) { return reflect(surfaces, true); }
    /// The same; is_fast: ColliderLoad::approach tells how fast it is. A slow one begins contact, and cuts no step.
    bool reflect(std::span<const ContactSurface> surfaces, bool is_fast);
    /// Clears the mark of surfaces that hold the particle no more when it comes to an impact: it leaves them, or their
    /// body comes back after an impulse that it has been given in this move.
    void release(Contact& contact) const;
    /// Whether the next impacts are hits: the contact log and the counts of hits leave out those that only resume a
    /// contact. Their impulses count all the same.
    void set_hits(bool are_hits) { are_hits_ = are_hits; }
    /// The same without a rebound.
    void land(std::span<const ContactSurface> surfaces);

    /// Records an impulse, as the change of velocity that it made, and that of the spin; without it all that has
    /// changed since the last one.
    void record_impulse(SurfaceId surface, const Vec3& velocity_change, bool impact,
                        const std::optional<Vec3>& spin_change = std::nullopt);
    /// m/s, the sum of all changes of velocity so far that are recorded as impulses, in the world.
    [[nodiscard]] const Vec3& recorded_change() const { return recorded_change_; }
    /// m^2/s, the sum of their moments about moment_center(), each at the place of the particle's centre, where loads
    /// are recorded.
    [[nodiscard]] const Vec3& angular_impulse() const { return angular_impulse_; }
    /// m, in the world: where the move began.
    [[nodiscard]] const Vec3& moment_center() const { return moment_center_; }
    /// Records a moment, as the change of the angular momentum that it made over the mass, m^2/s, beside those of all
    /// impulses.
    void turn(SurfaceId surface, const Vec3& change) { recorder_.add_couple(surface, -particle_.state.mass * change); }
    /// At the end of the move.
    void finish_recording() { recorder_.close(); }
    /// What is recorded next has surfaces that move in it.
    void note_driven() { scratch_.driven = true; }
    /// Removes the particle when an impact that changes its momentum by mass times this velocity shatters it.
    void shatter_by(const Vec3& velocity_change);
    /// Keeps an impact for the contact log; the velocity after it is the present one.
    void record(const ContactSurface& surface, const Vec3& velocity_before);

    [[nodiscard]] const Material& material_of(SurfaceId surface) const {
        return rules_.materials[rules_.world.material_of(surface)];
    }
    /// m/s, of the surface's own material where it is touched, as far as it grips; see SurfaceMotion.
    [[nodiscard]] Vec3 velocity_of(const ContactSurface& surface) const {
        return velocity_of(surface, particle_.state.position);
    }
    /// The same where the particle's centre is elsewhere.
    [[nodiscard]] Vec3 velocity_of(const ContactSurface& surface, const Vec3& center) const {
        if (is_carried(surface.surface)) return carried_velocity_of(surface, center);
        const Material& material = material_of(surface.surface);
        if (!material.drives()) return {};
        return material.motion.at(center - particle_.state.radius * surface.normal, surface.normal);
    }
    /// rad/s, of the turning of that material.
    [[nodiscard]] Vec3 angular_velocity_of(SurfaceId surface) const {
        if (is_carried(surface)) return carried_angular_velocity_of(surface);
        const Material& material = material_of(surface);
        return material.drives() ? material.motion.angular_velocity : Vec3{};
    }
    /// m/s, with which the surface itself comes towards the particle.
    [[nodiscard]] double surface_normal_speed(const ContactSurface& surface) const {
        return is_carried(surface.surface) ? dot(velocity_of(surface), surface.normal) : 0.0;
    }
    /// m/s, with which the particle leaves the surface along its normal.
    [[nodiscard]] double separation_speed(const ContactSurface& surface) const {
        return dot(particle_.state.velocity, surface.normal) - surface_normal_speed(surface);
    }

    /// m/s, with which a surface comes towards the particle beside the path of its body: the body has been given
    /// impulses in this move, and stays on its path until the move ends.
    [[nodiscard]] double advance_beside_path(const ContactSurface& surface) const;

    /// True where the particle comes towards a surface that does not hold it yet. The contact state decides, because
    /// the normal speed on a surface that holds the particle is rounding of either sign.
    [[nodiscard]] bool is_approached(const ContactSurface& surface) const {
        return !surface.is_support && separation_speed(surface) < 0.0;
    }

    /// The surface as one on which the particle lands without a rebound.
    [[nodiscard]] ImpactSurface landing_on(const ContactSurface& surface) const;

    /// The largest speed towards one of the surfaces, m/s.
    [[nodiscard]] double approach(std::span<const ContactSurface> surfaces) const;
    /// The largest speed, m/s, towards surfaces of bodies that yield, as they move along their paths until the move's
    /// end, whatever they have been given.
    [[nodiscard]] double approach_of_paths(std::span<const ContactSurface> surfaces) const;
    /// Takes that away where it is slow: it would meet the surface, that leaves it but is still there, again and again.
    void go_with_paths(std::span<const ContactSurface> surfaces);
    /// True where it goes on towards a surface whose body has been pushed away, but is still there.
    [[nodiscard]] bool waits_for(std::span<const ContactSurface> surfaces) const;

private:
    enum class Rebound { by_material, none };

    /// True for the surfaces of bodies that move relative to the frame that the particle is given in.
    [[nodiscard]] bool is_carried(SurfaceId surface) const {
        return rules_.bodies != nullptr && rules_.bodies->body_of(surface) != reference_.body();
    }
    [[nodiscard]] double approach_of_path(const ContactSurface& surface) const;
    [[nodiscard]] Vec3 velocity_beside_path(BodyId body, const Vec3& where) const;
    [[nodiscard]] Vec3 carried_velocity_of(const ContactSurface& surface, const Vec3& center) const;
    [[nodiscard]] Vec3 carried_angular_velocity_of(SurfaceId surface) const;

    void resolve(std::span<const ContactSurface> surfaces, Rebound rebound);
    [[nodiscard]] bool resolve_single(std::span<const ContactSurface> surfaces, const ContactSurface& surface,
                                      Rebound rebound);
    void resolve_simultaneously(std::span<const ContactSurface> surfaces, Rebound rebound);
    [[nodiscard]] double fastest(std::span<const ContactSurface> surfaces) const;
    [[nodiscard]] bool close_on_it(std::span<const ContactSurface> surfaces, const Vec3& velocity, double speed) const;
    using Foremost = std::array<ContactSurface, ImpactResult::kMostSurfaces>;
    [[nodiscard]] std::span<const ContactSurface> foremost(std::span<const ContactSurface> surfaces,
                                                           Foremost& kept) const;
    void resolve_sequentially(std::span<const ContactSurface> surfaces, Rebound rebound);
    [[nodiscard]] RecordedImpact impact_before(std::span<const ContactSurface> surfaces) const;
    void note_impact_after(RecordedImpact impact, std::span<const ContactSurface> surfaces, Rebound rebound);
    [[nodiscard]] ImpactSurface in_problem(const ContactSurface& surface, Rebound rebound) const;
    void settle_on_supports(std::span<const ContactSurface> surfaces);
    void stop_approach(std::span<const ContactSurface> surfaces);
    void reflect_off(const ContactSurface& surface, const Material& material, Rebound rebound);
    void bounce_off_body(const ContactSurface& surface, const Material& material, double restitution);
    [[nodiscard]] bool is_dynamic(SurfaceId surface) const {
        return rules_.bodies != nullptr && rules_.bodies->is_dynamic(rules_.bodies->body_of(surface));
    }
    [[nodiscard]] Motion random_reflection(Motion motion, const ContactSurface& surface, const Material& material,
                                           double restitution);
    void move_out_of_corner(std::span<const ContactSurface> surfaces);

    const ResponseRules& rules_;
    MovingParticle& particle_;
    MoveScratch& scratch_;
    MoveOutcome& outcome_;
    const ReferenceFrame& reference_;
    ImpulseRecorder recorder_;
    Vec3 moment_center_;
    Vec3 recorded_change_;
    Vec3 angular_impulse_;
    struct Given {
        BodyId body;
        Wrench wrench;  // about the center of its mobility
    };
    std::vector<Given> given_;  // to bodies that yield, in this move
    bool are_hits_ = true;
};

}  // namespace ricochet
