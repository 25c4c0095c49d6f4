/// \file
/// The responses to impacts by name, and their settings.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/integrator.h"
#include "ricochet/response/impact_law.h"

namespace ricochet {

/// Response to a particle that reaches a surface, by the names in scenes. docs/responses.md compares them.
enum class ResponseKind {
    exact,     ///< finds the time of impact and reflects within the step
    rollback,  ///< takes the step, finds the collision, and goes back to the contact
    project,   ///< tests at the end of the step and puts the particle back on the surface
    penalty,   ///< a spring and damper on the penetration
};

[[nodiscard]] std::optional<ResponseKind> response_from_name(std::string_view name);
[[nodiscard]] std::string_view name_of(ResponseKind kind);
/// Returns all kinds, in the order of the enumeration.
[[nodiscard]] std::span<const ResponseKind> response_kinds();

/// Settings of the rollback response.
struct RollbackSettings {
    double time_tolerance = 1e-9;  ///< s, > 0: width of the bracket of the time of contact
    bool global = false;           ///< true: the whole system goes back to the earliest contact, as in the course notes
};

/// Settings of the project response.
struct ProjectSettings {
    double offset = 1e-6;  ///< m, > 0: thickness of the layer on a surface in which a particle counts as in contact
};

/// Settings of the penalty response.
struct PenaltySettings {
    /// Spring constant, in N/m, > 0. Without a value, each particle has the spring constant with which an undamped
    /// contact lasts `contact_steps` sub-steps: m (pi / (contact_steps h))^2. Contacts then become stiffer as steps
    /// become shorter.
    std::optional<double> stiffness = std::nullopt;
    double contact_steps = 20.0;   ///< sub-steps, > 0; only without a stiffness
    std::uint32_t substeps = 10;   ///< equal parts of a step, >= 1
    double friction_speed = 1e-3;  ///< m/s, > 0: friction grows linearly with slip up to this speed
};

/// Method for the contacts of spheres, by the names in scenes.
enum class PairMethod {
    automatic,  ///< "auto": as `contacts` if spheres press on each other or impacts follow closely, else as `events`
    events,     ///< impact by impact, in the order of time
    contacts,   ///< all contacts of a step at once
};

/// Parameters of a contact between two spheres.
struct PairMaterial {
    double restitution = 1.0;             ///< separation speed over approach speed along the normal, 0..1
    double friction = 0.0;                ///< Coulomb coefficient, >= 0
    double rolling_friction = 0.0;        ///< resisting moment / (reduced radius * normal impulse), >= 0
    double tangential_restitution = 0.0;  ///< share of the slip that a sticking impact reverses, 0..1
    /// Approach speed, in m/s, > 0, above which the restitution falls as a power of the approach speed.
    std::optional<double> restitution_speed = std::nullopt;
    double restitution_exponent = kElasticPlasticExponent;  ///< exponent of this power, 0..1

    /// Returns the restitution at an approach speed, in m/s.
    [[nodiscard]] double restitution_at(double approach) const {
        return restitution_speed ? falling_restitution(restitution, restitution_speed, restitution_exponent, approach)
                                 : restitution;
    }
};

/// Contact parameters for spheres of two materials, in either order, or of one material if both names are equal.
struct MaterialPair {
    std::string first;
    std::string second;
    PairMaterial material{};
};

/// Name of the column with a particle's material, a number in PairContactSettings::materials. If there are materials,
/// the column must be declared with one component.
inline constexpr std::string_view kMaterialAttribute = "material";

/// Settings of contacts between spheres.
struct PairContactSettings {
    // As in PairMaterial, for all pairs that are not in `pairs`.
    double restitution = 1.0;
    double friction = 0.0;
    double rolling_friction = 0.0;
    double tangential_restitution = 0.0;
    std::optional<double> restitution_speed = std::nullopt;
    double restitution_exponent = kElasticPlasticExponent;
    PairMethod method = PairMethod::automatic;
    std::uint32_t impact_budget = 1000;       ///< impacts on other spheres per particle and step, >= 1
    std::vector<std::string> materials = {};  ///< names; none: all spheres have the same material
    std::vector<MaterialPair> pairs = {};     ///< each pair of materials at most once, in either order
};

/// Motion of a particle that a flow carries into a wall, by the names in scenes.
enum class WallRule {
    slide,  ///< the particle moves along the wall
    stop,   ///< the particle stops until the flow turns away from the wall
};

/// Settings of a run for a response.
struct ResponseSettings {
    double time_step = 1.0 / 60.0;  ///< s, > 0, of the run; single steps may be shorter
    Integrator integrator = IntegratorKind::ballistic;
    std::uint64_t seed = 0;
    /// Rebounds slower than this, in m/s, >= 0, become resting or sliding contact if restitution < 1 and the particle
    /// is pressed onto the surface.
    double resting_speed = 1e-3;
    std::uint32_t bounce_budget = 1000;  ///< impacts per particle and step, >= 1
    RollbackSettings rollback = {};
    ProjectSettings project = {};
    PenaltySettings penalty = {};
    /// Null: forces move the particles. Otherwise this flow carries them (first-order motion, x' = g(x, t)). That
    /// requires the exact response, no forces, and forward_euler, midpoint, rk4 or dormand_prince, else an InputError
    /// is thrown.
    FlowPointer flow = nullptr;
    WallRule walls = WallRule::slide;  ///< for particles that the flow carries into walls
};

}  // namespace ricochet
