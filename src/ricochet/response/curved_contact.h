/// \file
/// Motion of a particle along curved surfaces that hold it, as an ordinary differential equation. It covers edges,
/// vertices, both sides of balls and cylinders, and any mix with flat surfaces. Source: E. Hairer, C. Lubich, G.
/// Wanner, "Geometric Numerical Integration", 2nd ed., Springer 2006, section IV.4.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_interval.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/curved_contact_surfaces.h"
#include "ricochet/response/reference_frame.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Inputs of an arc besides the particle's state.
struct CurvedStart {
    Vec3 spin;  ///< rad/s
    FrictionLimits grip;
    bool has_forces = true;                     ///< false: the velocity contains the forces since the start of the step
    double duration = 0.0;                      ///< s, largest duration of the arc
    std::optional<ErrorTolerance> tolerance{};  ///< for a method that chooses its own steps
    const FrameForces* frame = nullptr;         ///< reference frame; null in the world
};

/// One arc of at most kMaxArcAngle. All arguments except the particle must outlive it.
class CurvedContact {
public:
    struct State {
        Vec3 position;
        Motion motion;
        double work = 0.0;    ///< m^2/s^2, work per unit mass of the forces minus that of the forces at the start
        double turned = 0.0;  ///< largest change of a touched shape's unit normal since the start: a length, 0 to 2
    };

    CurvedContact(const SurfaceGeometry& geometry, const ForceField& forces, const ForceInput& particle,
                  const ContactManifold& manifold, const ContactManifold::SupportList& materials,
                  const CurvedStart& start);

    /// Returns the plan at the start, as if the surfaces were flat: whether the particle rests, and the forces.
    [[nodiscard]] const ContactInterval& plan() const { return plan_; }
    /// Returns the state after t, in s, by the classical Runge-Kutta method or the midpoint rule. The state lies on the
    /// supporting surfaces, moves along them, and has the correct energy.
    [[nodiscard]] State at(double t) const;
    /// Change of the support since the start: none; a stuck contact slips; a slipping contact jams; a surface has
    /// turned further than an arc allows; or nothing holds the particle.
    enum class SupportChange { as_before, slipping, jammed, turned, none };
    [[nodiscard]] SupportChange support_at(const State& state, double t) const;
    /// Returns true if the particle jumps between two states at almost the same time. If a surface is too narrow for a
    /// sphere, the nearest point jumps to another side, and the sphere with it.
    [[nodiscard]] bool jumps(const State& before, const State& after) const;
    /// Returns the state at the start, with the motion along the surfaces.
    [[nodiscard]] State start() const { return {particle_.position, plan_.motion}; }
    /// Returns true if a surface carries load at the start.
    [[nodiscard]] bool is_supported() const { return std::ranges::find(has_load_, true) != has_load_.end(); }
    /// Returns the time, in s, until the particle has turned by kMaxArcAngle, or a motion is about to stick.
    [[nodiscard]] double longest() const;

    /// Returns the second derivative of the distance from a surface by its curvature at this velocity, in m/s^2.
    [[nodiscard]] static double curvature_of(const SurfaceGeometry& geometry, const ForceInput& particle,
                                             const ContactSurface& surface, const Vec3& velocity);

private:
    using SupportList = ContactManifold::SupportList;
    struct Rate {
        Vec3 velocity;
        Vec3 acceleration;
        Vec3 spin_acceleration;
        double power = 0.0;
    };

    [[nodiscard]] SupportList supports(const State& state) const;
    [[nodiscard]] SupportList supports(const State& state, double t) const;
    [[nodiscard]] Vec3 spin_change(const State& state, double t) const;
    [[nodiscard]] double spin_power(const State& state, const Vec3& change) const;
    [[nodiscard]] Vec3 forces(const State& state, double t) const;
    [[nodiscard]] ContactInterval plan_at(const State& state, double t, double duration) const;
    [[nodiscard]] Rate rate(const State& state, double t) const;
    [[nodiscard]] const Rate& rate_at_start() const;
    [[nodiscard]] State moved(const Rate& rate, double t) const;
    void put_on_surfaces(State& state) const;
    [[nodiscard]] State by_stages(double t) const;
    [[nodiscard]] double error_of(double t) const;
    [[nodiscard]] double longest_within_tolerance(double duration) const;
    [[nodiscard]] double longest_swing(double curvature) const;
    [[nodiscard]] State by_midpoint_rule(double t) const;
    template <class Is>
    [[nodiscard]] bool is_any_loaded(const Is& is) const;
    [[nodiscard]] bool has_resisted_turning(std::size_t k) const;
    [[nodiscard]] bool may_jam() const;
    [[nodiscard]] bool ends_a_slip() const;
    [[nodiscard]] bool begins_to_slip(const ContactInterval& now) const;
    [[nodiscard]] double work_until(const State& state) const;
    void restore_energy(State& state, double t) const;
    [[nodiscard]] bool dissipates() const;

    const SurfaceGeometry& geometry_;
    const ForceField& forces_;
    ForceInput particle_;  // at the start of the arc
    const SupportList& materials_;
    CurvedStart start_;
    CurvedContactSurfaces surfaces_;
    Vec3 forces_at_start_;
    ContactInterval plan_;
    std::array<bool, kMostSupports> has_load_{};  // at the start
    StuckSurfaces stuck_{};                       // from the start on
    bool jams_ = false;                           // at the start
    bool has_potential_ = false;                  // of varying forces
    bool is_driven_ = false;                      // a surface moves
    bool keeps_energy_ = false;
    bool friction_turns_fast_ = false;
    mutable std::optional<Rate> rate_at_start_;  // computed on first use
};

}  // namespace ricochet
