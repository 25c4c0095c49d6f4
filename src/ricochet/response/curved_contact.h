/// \file
/// Private to the exact response: the motion of a particle along curved surfaces that hold it, as an ordinary
/// differential equation: around edges and vertices, on and in balls and cylinders, and any mix with flat surfaces.
/// Source: integration with projection onto the invariants, E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical
/// Integration", 2nd ed., Springer 2006, section IV.4.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_interval.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/curved_contact_surfaces.h"
#include "ricochet/response/reference_frame.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// What an arc starts from, besides the particle.
struct CurvedStart {
    Vec3 spin;                   ///< rad/s
    double pressure = 1.0;       ///< as FrictionLimits::pressure
    bool has_forces = true;      ///< false: the forces have been in the velocity from the step's start on
    double shortest = 0.0;       ///< s, as FrictionLimits::shortest
    double negligible_path = 0;  ///< m, as FrictionLimits::negligible_path
    double duration = 0.0;       ///< s, that it may last at most
    std::optional<ErrorTolerance> tolerance{};  ///< of a method that chooses its own steps
    const FrameForces* frame = nullptr;         ///< that all is seen from; null in the world
};

/// One arc, at most kMaxArcAngle long. Everything it is given but the particle must outlive it.
class CurvedContact {
public:
    struct State {
        Vec3 position;
        Motion motion;
        double work = 0.0;    ///< over the mass, m^2/s^2, of what the forces have changed by since the start
        double turned = 0.0;  ///< rad, by which shapes have turned under a sphere since the start, at most
    };

    CurvedContact(const SurfaceGeometry& geometry, const ForceField& forces, const ForceInput& particle,
                  const ContactManifold& manifold, const ContactManifold::SupportList& materials,
                  const CurvedStart& start);

    /// What it starts with, as if the surfaces were flat: whether it rests, and the forces.
    [[nodiscard]] const ContactInterval& plan() const { return plan_; }
    /// The state after t seconds, by the classical Runge-Kutta method, or the midpoint rule: on the surfaces that hold,
    /// along them, and with the energy that it has to have.
    [[nodiscard]] State at(double t) const;
    /// How it is held there: as at the start; or something that stuck there slips; or what slips there jams; or a
    /// surface has turned further than it does in an arc; or by nothing any more.
    enum class SupportChange { as_before, slipping, jammed, turned, none };
    [[nodiscard]] SupportChange support_at(const State& state, double t) const;
    /// Between two times of which one is hardly later than the other: where a surface is too narrow for a sphere, the
    /// nearest point jumps to another side, and takes the sphere with it.
    [[nodiscard]] bool jumps(const State& before, const State& after) const;
    /// The particle, moving along the surfaces.
    [[nodiscard]] State start() const { return {particle_.position, plan_.motion}; }
    /// True if a surface carries load at the start.
    [[nodiscard]] bool is_supported() const {
        return std::any_of(has_load_.begin(), has_load_.end(), [](bool has_load) { return has_load; });
    }
    /// s, until it has turned by kMaxArcAngle, or something is about to stick.
    [[nodiscard]] double longest() const;

    /// What a surface's curvature takes from the distance to it at this velocity, m/s^2.
    [[nodiscard]] static double curvature_of(const SurfaceGeometry& geometry, const ForceInput& particle,
                                             const ContactSurface& surface, const Vec3& velocity);

private:
    using SupportList = ContactManifold::SupportList;
    /// Derivatives of the state.
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
    [[nodiscard]] FrictionLimits grip() const;
    [[nodiscard]] ContactInterval plan_at(const State& state, double t, double duration,
                                          const StuckSurfaces& stuck = {}) const;
    [[nodiscard]] Rate rate(const State& state, double t) const;
    [[nodiscard]] const Rate& rate_at_start() const;
    void put_on_surfaces(State& state) const;
    [[nodiscard]] State by_stages(double t) const;
    [[nodiscard]] double error_of(double t) const;
    [[nodiscard]] double longest_within_tolerance(double duration) const;
    [[nodiscard]] double longest_swing(double curvature) const;
    [[nodiscard]] State by_midpoint_rule(double t) const;
    [[nodiscard]] bool may_jam() const;
    [[nodiscard]] bool ends_a_slip() const;
    [[nodiscard]] bool begins_to_slip(const ContactInterval& now) const;
    [[nodiscard]] double work_until(const State& state) const;
    void restore_energy(State& state, double t) const;
    [[nodiscard]] bool dissipates() const;

    const SurfaceGeometry& geometry_;
    const ForceField& forces_;
    ForceInput particle_;  // at the start, wherever it has got to since
    const SupportList& materials_;
    CurvedStart start_;
    CurvedContactSurfaces surfaces_;
    Vec3 forces_at_start_;
    ContactInterval plan_;
    std::array<bool, kMostSupports> has_load_{};  // at the start
    StuckSurfaces stuck_{};                       // from the start on
    bool jams_ = false;                           // at the start
    bool has_potential_ = false;                  // of forces that vary
    bool is_driven_ = false;                      // by a surface that moves
    bool keeps_energy_ = false;
    bool friction_turns_fast_ = false;
    mutable std::optional<Rate> rate_at_start_;  // computed when it is first needed
};

}  // namespace ricochet
