/// \file
/// How impacts are answered: the responses by name, and their settings.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/integrator.h"

namespace ricochet {

/// What happens when a particle reaches a surface, by the names in scenes; docs/responses.md compares them.
enum class ResponseKind {
    exact,     ///< finds the time of impact and reflects inside the step
    rollback,  ///< takes the step, finds that it collided, goes back to the contact
    project,   ///< tests at the end of the step and puts the particle back on the surface
    penalty,   ///< a spring and damper on the penetration
};

[[nodiscard]] std::optional<ResponseKind> response_from_name(std::string_view name);
[[nodiscard]] std::string_view name_of(ResponseKind kind);
/// All kinds, in the order of the enumeration.
[[nodiscard]] std::span<const ResponseKind> response_kinds();

/// Settings of the rollback response.
struct RollbackSettings {
    double time_tolerance = 1e-9;  ///< s, > 0: how closely the time of contact is bracketed
    bool global = false;           ///< the whole system goes back to the earliest contact, as the lectures teach it
};

/// Settings of the project response.
struct ProjectSettings {
    double offset = 1e-6;  ///< m, > 0: thickness of the layer on a surface in which a particle counts as in contact
};

/// Settings of the penalty response.
struct PenaltySettings {
    /// Spring constant, N/m, > 0. Nothing: for each particle the one with which an undamped contact lasts
    /// `contact_steps` sub-steps, m (pi / (contact_steps h))^2, so that contacts harden as steps shrink.
    std::optional<double> stiffness = std::nullopt;
    double contact_steps = 20.0;   ///< sub-steps, > 0; only without a stiffness
    std::uint32_t substeps = 10;   ///< equal parts of a step, >= 1
    double friction_speed = 1e-3;  ///< m/s, > 0: friction grows linearly with slip up to this speed
};

/// How spheres that meet each other are moved, by the names in scenes.
enum class PairMethod {
    automatic,  ///< "auto": as fits
    events,     ///< impact by impact, in the order of time
    contacts,   ///< all contacts of a step at once
};

/// What two spheres do to each other where they touch.
struct PairMaterial {
    double restitution = 1.0;       ///< speed of parting over speed of approach along the normal, 0..1
    double friction = 0.0;          ///< Coulomb coefficient, >= 0
    double rolling_friction = 0.0;  ///< resisting moment over reduced radius times normal impulse, >= 0
};

/// What spheres of two materials do to each other, in either order; of one material, where both names are the same.
struct MaterialPair {
    std::string first;
    std::string second;
    PairMaterial material{};
};

/// Name of the column of a particle's material, a number in PairContactSettings::materials; to be declared, with one
/// component, where there are materials.
inline constexpr std::string_view kMaterialAttribute = "material";

/// What spheres do when they meet each other.
struct PairContactSettings {
    // As of PairMaterial, of all pairs that are not in `pairs`.
    double restitution = 1.0;
    double friction = 0.0;
    double rolling_friction = 0.0;
    PairMethod method = PairMethod::automatic;
    std::uint32_t impact_budget = 1000;       ///< impacts on other spheres per particle and step, >= 1
    std::vector<std::string> materials = {};  ///< names; none: all spheres are of one
    std::vector<MaterialPair> pairs = {};     ///< of two of the materials each, in either order at most once
};

/// What a wall does to a particle that a flow carries into it, by the names in scenes.
enum class WallRule {
    slide,  ///< it goes on along the wall
    stop,   ///< it stays there until the flow turns away from the wall
};

/// What a response needs to know of a run.
struct ResponseSettings {
    double time_step = 1.0 / 60.0;  ///< s, > 0, of the run; single steps may be shorter
    Integrator integrator = IntegratorKind::ballistic;
    std::uint64_t seed = 0;
    /// Rebounds slower than this become resting or sliding contact where restitution < 1 and something presses on, m/s,
    /// >= 0.
    double resting_speed = 1e-3;
    std::uint32_t bounce_budget = 1000;  ///< impacts per particle and step, >= 1
    RollbackSettings rollback = {};      ///< of the rollback response
    ProjectSettings project = {};        ///< of the project response
    PenaltySettings penalty = {};        ///< of the penalty response
    /// Null pointer: forces move the particles. Otherwise this flow carries them (first-order motion, x' = g(x, t)):
    /// with the exact response, no forces, and forward_euler, midpoint, rk4 or dormand_prince, else an InputError.
    FlowPointer flow = nullptr;
    WallRule walls = WallRule::slide;  ///< what walls do to particles that the flow carries into them
};

}  // namespace ricochet
