/// \file
/// What all responses share: the rules of a run, what goes in for one particle and step, and what comes out.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/contact_query.h"
#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/motion_part.h"
#include "ricochet/core/recorded_impact.h"
#include "ricochet/core/segment.h"
#include "ricochet/core/stop_token.h"
#include "ricochet/dynamics/coupled_member.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/response/contact_record.h"
#include "ricochet/response/material.h"
#include "ricochet/response/settings.h"

namespace ricochet {

/// An impulse that a particle gave to a surface.
struct SurfaceHit {
    SurfaceId surface = 0;
    Vec3 impulse;        ///< N s, given to the surface
    bool impact = true;  ///< false: the push of a contact interval
    bool again = false;  ///< a further pass of an impact that has been counted
};

/// What a particle does to a collider that moves, or whose material does, at one time or in one interval.
struct ColliderLoad {
    std::uint64_t particle = 0;  ///< id
    double time = 0.0;           ///< s; of an interval, its end
    SurfaceId surface = 0;
    double mass = 0.0;         ///< kg, of the particle
    Vec3 impulse;              ///< N s, given to the surface
    Vec3 moment;               ///< N m s, given about the origin of the collider's frame, in world axes
    Vec3 particle_center;      ///< m, of the particle's centre in the world
    Vec3 couple;               ///< N m s, given besides the moment that the impulse has at `place`
    double work = 0.0;         ///< J, given
    double lost_energy = 0.0;  ///< J, kinetic, that the particle has lost by the impact; with the impact's last load
    double approach = 0.0;     ///< m/s, of the impact; 0 where it is slow, and begins contact
    bool impact = true;        ///< false: of a contact that lasts
    bool is_hit = true;        ///< false: ColliderTotals::hits leaves it out: contact that a body's jump has cut in two
};

/// Scratch memory of one thread. The lists are appended to in the order of events and cleared by the caller.
struct MoveScratch {
    ContactScratch contacts;
    std::vector<SurfaceHit> hits;
    std::vector<ContactRecord> records;   ///< filled when record_contacts
    std::vector<Segment> segments;        ///< filled when record_segments
    std::vector<FlownPiece> flown;        ///< filled when record_flown, by the exact response
    std::vector<MotionPart> motions;      ///< filled when record_motions, by the exact response
    std::vector<ColliderLoad> loads;      ///< filled when record_loads
    std::vector<RecordedImpact> impacts;  ///< impacts with a rebound; filled when record_motions, by the exact response
    std::vector<SurfaceId> supported_by;  ///< surfaces of the contact interval that has just ended, for `impacts`
    bool record_contacts = false;
    bool record_segments = false;
    bool record_flown = false;
    bool record_motions = false;
    bool record_loads = false;
    bool driven = false;  ///< a surface that moves or has a temperature has pushed since the last MotionPart
};

/// Surfaces that a particle slides, rolls or rests on, from one step to the next.
struct ContactState {
    std::array<SurfaceId, 3> surfaces{};  ///< 0 beyond count
    std::uint8_t count = 0;               ///< 0: it flies
    double cascade_left = 0.0;            ///< s of a bounce cascade that the end of the step has cut in two

    /// Marks a particle that was placed in contact with these surfaces, and perhaps with more. Local: a mark, not a
    /// distance.
    static constexpr double kPlaced = -1.0;
    [[nodiscard]] bool is_placed() const { return cascade_left == kPlaced; }

    /// Returns the state of a particle in flight that a velocity jump of a body has released. `speed`: separation speed
    /// from the body, in m/s.
    [[nodiscard]] static ContactState release_at(double speed) { return {{}, 0, kLetGo - speed}; }
    [[nodiscard]] std::optional<double> release_speed() const {
        if (count > 0 || !(cascade_left <= kLetGo)) return std::nullopt;
        return kLetGo - cascade_left;
    }

    friend bool operator==(const ContactState&, const ContactState&) = default;

private:
    // Local: a mark, not a distance.
    static constexpr double kLetGo = -2.0;
};

/// What the responses that test only the end of a step remember of a particle and a collider.
struct SideMemory {
    std::int8_t side = 0;      ///< the sign of the side that it belongs to (SurfacePoint::side); 0: not seen yet
    bool penetrating = false;  ///< it was behind the surface when it was last tested
    bool touching = false;     ///< it was in contact then
    float depth = 0.0F;        ///< m, at least how far behind it was, if it was
};

/// One particle as the response moves it.
struct MovingParticle {
    ForceInput state;  ///< position, velocity, mass, radius, time
    Vec3 spin;         ///< rad/s
    std::uint64_t id = 0;
    std::uint32_t draws = 0;           ///< random numbers drawn so far by this particle's impacts
    ContactState contact{};            ///< contact that continues in the next step
    std::span<SideMemory> sides = {};  ///< one a collider, for responses that keep sides; updated in place
    /// N s: an impact that changes its momentum by as much removes it there, as if it were absorbed.
    double shatter_impulse = std::numeric_limits<double>::infinity();
    /// The flight of the whole step, where particles act on each other and are stepped together; null: the particle's
    /// own integrator says it. It must outlive the move.
    const Flight* planned = nullptr;
    ContactCandidates candidates = {};  ///< by this step (MoveOutcome::candidates of the last one)

    // Where colliders move.

    /// s, of the position as it is stored: before state.time where the particle was squeezed, and its clock stood
    /// still.
    double stored_time = 0.0;
    double step_end = 0.0;  ///< s, the time that the next move begins at
    /// Impacts of it in earlier parts of the time step, where something cuts that into parts: one budget for all.
    std::uint32_t bounces_before = 0;
    /// How it rests on a body, in the body's frame, where it rides on one; with a contact that is kept.
    struct Attachment {
        Vec3 position;  ///< m
        Vec3 spin;      ///< rad/s, relative to the body
    };
    std::optional<Attachment> attachment = std::nullopt;

    /// s after the end of the move for which flights are planned on: they are cut where the move ends, so that their
    /// paths are those of a longer one.
    double beyond = 0.0;
};

/// How a particle ends a step.
enum class MoveEnd : std::uint8_t {
    moving,     ///< in flight, sliding or rolling
    resting,    ///< at rest on what it touches
    held,       ///< at rest because friction and its support hold it: it stays while the forces do
    frozen,     ///< the state left the range of the arithmetic; the particle was not moved
    absorbed,   ///< an impact removed it
    shattered,  ///< an impact that reached its shatter_impulse removed it
};

/// What happened to one particle in one step.
struct MoveOutcome {
    [[nodiscard]] bool is_resting() const { return end == MoveEnd::resting || end == MoveEnd::held; }
    [[nodiscard]] bool is_frozen() const { return end == MoveEnd::frozen; }
    [[nodiscard]] bool is_absorbed() const { return end == MoveEnd::absorbed || end == MoveEnd::shattered; }
    /// Contacts found so far, with an impact or without one.
    [[nodiscard]] std::uint32_t meetings() const { return bounces + touches; }

    MoveEnd end = MoveEnd::moving;
    std::uint32_t bounces = 0;      ///< impacts
    std::uint32_t touches = 0;      ///< contacts found without an approach; only the budget counts them
    double unsimulated_time = 0.0;  ///< s that a budget cut off
    bool is_coarse = false;         ///< an adaptive method could not keep its tolerance
    std::uint32_t stayed = 0;       ///< impacts after which no certified position nearer to the surface was found
    std::uint32_t squeezed = 0;     ///< 1: its clock stood still, between surfaces that close on it
    std::uint32_t trials = 0;       ///< states that were tested for collision or penetration
    double depth = 0.0;             ///< m, how deep it was seen behind a surface, before anything put it right
    /// s after the end of the move for which the particle, in free flight by steps of the run, certainly touches
    /// nothing; 0 where that was not found out.
    double free_for = 0.0;
    /// s after the end of the move until which no triangles but `candidates` come near its path.
    double candidates_for = 0.0;
    ContactCandidates candidates = {};
};

/// Key of the random numbers that impacts draw; emitters use the numbers below.
inline constexpr std::uint32_t kImpactStream = 0xFFFFFFFFU;

/// What forces make of the motion of a particle where it is now, with the surfaces that it is in contact with.
struct SupportedAcceleration {
    Vec3 acceleration{};                  ///< m/s^2, with what the surfaces give
    Vec3 spin_acceleration{};             ///< rad/s^2
    std::array<SurfaceId, 3> surfaces{};  ///< the first `count`
    std::array<Vec3, 3> reaction{};       ///< m/s^2, of each
    std::uint8_t count = 0;
};

class FrameForces;

/// Where a particle spawned by another begins.
struct ChildStart {
    Vec3 parent_start;     ///< m, where the parent's move began
    Vec3 position;         ///< m
    double radius = 0.0;   ///< m
    bool goes_on = false;  ///< it is in contact already with what it touches, as a fragment; else contact begins
};

/// What a response works with. World, forces and materials must outlive it.
struct ResponseRules {
    const CollisionWorld& world;
    const ForceField& forces;
    std::span<const Material> materials;
    ResponseSettings settings;
    double end = std::numeric_limits<double>::infinity();  ///< s, of the run: what comes later is of no interest
    bool look_ahead = true;                                ///< find out MoveOutcome::free_for
    const MovingColliders* bodies = nullptr;               ///< null where no collider moves
    /// Of the frame of one of them, in which `world` and `forces` are seen; null in the world.
    const FrameForces* frame = nullptr;
    const StopToken* stop = nullptr;  ///< of steps that may be stopped

    /// Throws when the step is to end: to be called between pieces of work.
    void poll() const {
        if (stop != nullptr) stop->poll();
    }
};

/// The flight that a step of `duration` seconds begins with: the planned one while nothing has happened to the particle
/// yet, else that of its integrator.
[[nodiscard]] Flight first_flight(const ResponseRules& rules, const MovingParticle& particle, double duration,
                                  const Integrator& integrator);
[[nodiscard]] inline Flight first_flight(const ResponseRules& rules, const MovingParticle& particle, double duration) {
    return first_flight(rules, particle, duration, rules.settings.integrator);
}

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
    /// The sides of all colliders that a new particle is on. sides.size() == number of colliders.
    virtual void first_sides(const Vec3& position, std::span<SideMemory> sides) const;
    /// The same of a particle that another spawns. sides: in, those of the parent where its move began.
    virtual void inherit_sides(const ChildStart& particle_center, std::span<SideMemory> sides) const;

    /// What forces that accelerate it by `pull`, m/s^2, leave it under this response in the contact that it is in.
    /// Surfaces that move hold nothing here.
    [[nodiscard]] virtual SupportedAcceleration supported_acceleration(const MovingParticle& particle,
                                                                       const Vec3& pull) const;
    /// Gives a particle at the end of its step of `duration` seconds a change of velocity, m/s, that is still owed to
    /// it: as if it had been a part of the forces in that step. What surfaces take of it is recorded.
    void apply_correction(MovingParticle& particle, const Vec3& change, double duration, MoveScratch& scratch) const;

    [[nodiscard]] const ResponseRules& rules() const { return rules_; }

protected:
    ResponseRules rules_;  // NOLINT(misc-non-private-member-variables-in-classes)
};

/// The response of a kind; with a flow the one of first-order motion (advect.h), which goes by the name of exact and
/// takes no forces. Throws InputError for settings out of their range or that do not go together.
[[nodiscard]] std::unique_ptr<Response> make_response(ResponseKind kind, const ResponseRules& rules);

}  // namespace ricochet
