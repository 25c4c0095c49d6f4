/// \file
/// What all responses share: the rules of a run, what goes in for one particle and step, and what comes out.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "ricochet/collision/contact_query.h"
#include "ricochet/core/segment.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/integrator.h"
#include "ricochet/response/material.h"

namespace ricochet {

/// The answers to "a surface is in the way", by their names in scenes.
enum class ResponseKind {
    exact,     ///< predicts the time of impact and reflects inside the step, see exact.h
    rollback,  ///< takes the step, finds that it collided, goes back to the contact, see rollback.h
    project,   ///< tests at the end of the step and puts the particle back on the surface, see project.h
    penalty,   ///< a spring and damper on the penetration, see penalty.h
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

/// What a wall does to a particle that a flow carries into it, by the names in scenes.
enum class WallRule {
    slide,  ///< it goes on along the wall
    stop,   ///< it stays there until the flow turns away from the wall
};

/// The rules of a run that a response needs.
struct ResponseSettings {
    Integrator integrator = IntegratorKind::ballistic;
    double resting_speed = 1e-3;  ///< m/s
    std::uint32_t bounce_budget = 1000;
    std::uint64_t seed = 0;
    double time_step = 1.0 / 60.0;  ///< s, of the run; single steps may be shorter
    RollbackSettings rollback = {};
    ProjectSettings project = {};
    PenaltySettings penalty = {};
    FlowPointer flow = nullptr;  ///< null pointer: forces move the particles; else this flow carries them, see advect.h
    WallRule walls = WallRule::slide;                      ///< only with a flow
    bool look_ahead = true;                                ///< find out MoveOutcome::free_for
    double end = std::numeric_limits<double>::infinity();  ///< s, when the run ends: what comes later is of no interest
};

/// An impulse that a particle gave to a surface.
struct SurfaceHit {
    SurfaceId surface = 0;
    Vec3 impulse;        ///< N s, given to the surface
    bool impact = true;  ///< false: the push of a stretch of lasting contact
};

/// One reflection off one surface, as the contact log writes it. An impact in a corner is several of them, of the same
/// time and particle, each beginning with the velocity that the one before left. The penalty response, whose contacts
/// last, records their beginnings, with the same velocity before and after.
struct ContactRecord {
    double time = 0.0;  ///< s, simulation time
    std::uint64_t particle = 0;
    SurfaceId surface = 0;
    Vec3 position;         ///< of the particle's centre, parked, m
    Vec3 normal;           ///< unit, from the surface to the particle
    Vec3 velocity_before;  ///< m/s
    Vec3 velocity_after;   ///< m/s
    double mass = 0.0;     ///< kg
    double radius = 0.0;   ///< m
};

/// Scratch memory of one thread. The lists are appended to in the order of events and cleared by the caller.
struct MoveScratch {
    ContactScratch contacts;
    std::vector<SurfaceHit> hits;
    std::vector<ContactRecord> records;  ///< filled when record_contacts
    std::vector<Segment> segments;       ///< filled when record_segments
    bool record_contacts = false;
    bool record_segments = false;
};

/// The surfaces that a particle slides, rolls or rests on.
struct Support {
    std::array<SurfaceId, 3> surfaces{};
    std::uint8_t count = 0;     ///< 0: it flies
    double cascade_left = 0.0;  ///< s of a bounce cascade that the end of the step has cut in two
};

/// What the responses that look at the end of a step only remember of a particle and a collider.
struct SideMemory {
    std::int8_t side = 0;      ///< the sign of the side that it belongs to (SurfacePoint::side); 0: not seen yet
    bool penetrating = false;  ///< it was behind the surface when it was last looked at
    bool touching = false;     ///< it was in contact then
    float depth = 0.0F;        ///< m, at least how far behind it was, if it was
};

/// One particle as the response moves it.
struct MovingParticle {
    ForceInput state;  ///< position, velocity, mass, radius, time
    Vec3 spin;         ///< rad/s
    std::uint64_t id = 0;
    std::uint32_t draws = 0;           ///< random numbers drawn so far by this particle's impacts
    Support support{};                 ///< what it is in contact with; contact goes on in the next step
    std::span<SideMemory> sides = {};  ///< one a collider, for responses that keep sides; updated in place
    /// N s: an impact that changes its momentum by as much ends its way there, as if it were absorbed.
    double shatter_impulse = std::numeric_limits<double>::infinity();
    /// The flight of the whole step, where particles act on each other and are stepped together; null: the particle's
    /// own integrator says it. It must outlive the move.
    const Flight* planned = nullptr;
    ContactCandidates candidates = {};  ///< by this step (MoveOutcome::candidates of the last one)
};

/// What happened to one particle in one step.
struct MoveOutcome {
    std::uint32_t bounces = 0;      ///< impacts
    double unsimulated_time = 0.0;  ///< s that the budget cut off
    bool resting = false;           ///< ended the step at rest on its support
    bool held = false;              ///< at rest because friction and its support hold it: it stays while forces do
    bool frozen = false;            ///< the state left the range of the arithmetic; the particle was not moved
    bool absorbed = false;          ///< an impact removed it
    bool shattered = false;         ///< it was absorbed because an impact reached its shatter_impulse
    std::uint32_t stayed = 0;       ///< impacts after which no certified place nearer to the surface was found
    std::uint32_t trials = 0;       ///< states that were tested for collision or penetration
    double depth = 0.0;             ///< m, how deep it was seen behind a surface, before anything put it right
    /// s after the end of the move for which the particle, stepped on by coast() in steps of the run, certainly meets
    /// nothing; 0 where that was not found out.
    double free_for = 0.0;
    /// s after the end of the move until which no triangles but `candidates` come near its way.
    double candidates_for = 0.0;
    ContactCandidates candidates = {};
};

/// Key of the random numbers that impacts draw; emitters use the numbers below.
inline constexpr std::uint32_t kImpactStream = 0xFFFFFFFFU;

/// What a response works with. World, forces and materials must outlive it.
struct ResponseRules {
    const CollisionWorld& world;
    const ForceField& forces;
    std::span<const Material> materials;
    ResponseSettings settings;
};

/// The flight that a step of `duration` seconds begins with: the planned one while nothing has happened to the particle
/// yet, else that of its integrator.
[[nodiscard]] Flight first_flight(const ResponseRules& rules, const MovingParticle& particle, double duration);

/// Moves particles one at a time. Safe from any number of threads.
class Response {
public:
    explicit Response(const ResponseRules& rules) : rules_(rules) {}
    virtual ~Response() = default;
    Response(const Response&) = delete;
    Response& operator=(const Response&) = delete;

    /// Moves one particle from its time by `duration` seconds and updates it.
    virtual MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const = 0;

    /// Appends the impulses, N s, that a particle held at rest gives to its support in `duration` seconds.
    virtual void add_weight(const MovingParticle& particle, double duration, std::vector<SurfaceHit>& hits) const;

    /// True when MovingParticle::sides must be there, and be set by first_sides() at birth.
    [[nodiscard]] virtual bool keeps_sides() const { return false; }
    /// The sides of all colliders that a newborn particle is on. sides.size() == number of colliders.
    virtual void first_sides(const Vec3& position, std::span<SideMemory> sides) const;

    [[nodiscard]] const ResponseRules& rules() const { return rules_; }

protected:
    ResponseRules rules_;  // NOLINT(misc-non-private-member-variables-in-classes)
};

/// The response of a kind; with a flow the one of first-order motion (advect.h), which goes by the name of exact and
/// takes no forces. Throws InputError for settings out of their range or that do not go together.
[[nodiscard]] std::unique_ptr<Response> make_response(ResponseKind kind, const ResponseRules& rules);

}  // namespace ricochet
