/// \file
/// Common to all responses: the rules of a run, and the input and output of the step of one particle.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/clear_space.h"
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
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/contact_record.h"
#include "ricochet/response/material.h"
#include "ricochet/response/settings.h"

namespace ricochet {

/// An impulse that a particle has given to a surface.
struct SurfaceHit {
    SurfaceId surface = 0;
    Vec3 impulse;        ///< N s, given to the surface
    bool impact = true;  ///< false: an impulse of a contact interval
    bool again = false;  ///< true: a further pass of an impact that has already been counted
};

/// Effect of a particle on a moving collider, or one with moving material, at one time or in one interval.
struct ColliderLoad {
    std::uint64_t particle = 0;  ///< id
    double time = 0.0;           ///< s; for an interval, its end
    SurfaceId surface = 0;
    double mass = 0.0;         ///< kg, of the particle
    Vec3 impulse;              ///< N s, given to the surface
    Vec3 moment;               ///< N m s, given about the origin of the collider's frame, in world axes
    Vec3 particle_center;      ///< m, position of the particle's centre in the world
    Vec3 couple;               ///< N m s, given in addition to the moment of the impulse at `particle_center`
    double work = 0.0;         ///< J, done on the collider
    double lost_energy = 0.0;  ///< J, lost kinetic energy of the particle; set in the last load of an impact
    double approach = 0.0;     ///< m/s, approach speed of the impact; 0 for a slow impact, which begins contact
    bool impact = true;        ///< false: lasting contact
    bool is_hit = true;        ///< false: resumes a contact that a body's jump has interrupted; no hit
};

/// Records that moves produce, in the order of events.
struct MoveLists {
    std::vector<SurfaceHit> hits;
    std::vector<ContactRecord> records;   ///< filled if record_contacts
    std::vector<Segment> segments;        ///< filled if record_segments
    std::vector<MotionPart> motions;      ///< filled if record_motions, by the exact response
    std::vector<ColliderLoad> loads;      ///< filled if record_loads
    std::vector<RecordedImpact> impacts;  ///< impacts with a rebound; filled if record_motions, by the exact response

    void clear();
    /// Moves the records out of other lists, which are empty afterwards.
    void take(MoveLists& others);
    void append(const MoveLists& more);
};

/// Scratch memory of one thread. The caller clears the lists.
struct MoveScratch : MoveLists {
    ContactScratch contacts;
    std::vector<FlownPiece> flown;        ///< filled if record_flown, by the exact response
    std::vector<SurfaceId> supported_by;  ///< surfaces of the contact interval that has just ended, for `impacts`
    bool record_contacts = false;
    bool record_segments = false;
    bool record_flown = false;
    bool record_motions = false;
    bool record_loads = false;
    bool driven = false;  ///< true if a surface that moves or has a temperature has acted since the last MotionPart
};

/// Surfaces on which a particle slides, rolls or rests, from one step to the next.
struct ContactState {
    std::array<SurfaceId, 3> surfaces{};  ///< 0 beyond count
    std::uint8_t count = 0;               ///< 0: the particle flies
    double cascade_left = 0.0;            ///< s, remaining time of a bounce cascade that the step's end has interrupted

    [[nodiscard]] std::span<const SurfaceId> all() const { return {surfaces.data(), count}; }
    /// Local: a mark in `cascade_left` of a particle that was placed in contact with these surfaces, and perhaps more.
    static constexpr double kPlaced = -1.0;
    [[nodiscard]] bool is_placed() const { return cascade_left == kPlaced; }

    /// Returns the state in flight of a particle that a body's velocity jump has released with a speed, in m/s.
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

/// Side of one particle relative to one collider, stored for responses that test only the end of a step.
struct SideMemory {
    std::int8_t side = 0;      ///< sign of the particle's own side (SurfacePoint::side); 0: not known yet
    bool penetrating = false;  ///< true: it was behind the surface at the last test
    bool touching = false;     ///< true: it was in contact at the last test
    float depth = 0.0F;        ///< m, upper bound of its depth behind the surface, if it was behind
};

/// State of one particle that a response moves.
struct MovingParticle {
    ForceInput state;  ///< position, velocity, mass, radius, time
    Vec3 spin;         ///< rad/s
    std::uint64_t id = 0;
    std::uint32_t draws = 0;           ///< random numbers drawn so far by this particle's impacts
    ContactState contact{};            ///< contact that continues in the next step
    std::span<SideMemory> sides = {};  ///< one per collider, for responses that keep sides; updated in place
    /// Impulse, in N s, that shatters the particle. An impact with at least this impulse removes the particle.
    double shatter_impulse = std::numeric_limits<double>::infinity();
    /// Flight of the whole step, if particles act on each other and are stepped together. Null: the particle's own
    /// integrator computes it. It must outlive the move.
    const Flight* planned = nullptr;
    ClearSpace clear = {};              ///< free space that an earlier step has found, or this one
    ContactCandidates candidates = {};  ///< candidates in this step, from MoveOutcome::candidates of the last step

    // Used only if colliders move.

    /// Time of the stored position, in s. It is earlier than state.time if the particle is stalled.
    double stored_time = 0.0;
    double step_end = 0.0;  ///< s, time at which the next move begins
    /// Impacts in earlier substeps of the time step. All substeps share one budget.
    std::uint32_t bounces_before = 0;
    /// Position and spin at rest on a body, in its frame, if the particle is attached. Set only with a contact state.
    struct Attachment {
        Vec3 position;  ///< m
        Vec3 spin;      ///< rad/s, relative to the body
    };
    std::optional<Attachment> attachment = std::nullopt;

    /// Time after the end of the move, in s, for which flights are planned. They are then cut at the end of the move.
    double beyond = 0.0;

    [[nodiscard]] Motion motion() const { return {state.velocity, spin}; }
    [[nodiscard]] RecordedMotion recorded_motion() const { return {state.position, state.velocity, spin}; }
    void set_motion(const Motion& motion) {
        state.velocity = motion.velocity;
        spin = motion.spin;
    }
};

/// State of a particle at the end of a step.
enum class MoveEnd : std::uint8_t {
    moving,     ///< in flight, sliding or rolling
    resting,    ///< at rest on its supports
    held,       ///< at rest, held by friction and supports; it stays at rest until the forces change
    frozen,     ///< the state left the range of the arithmetic; the particle was not moved
    absorbed,   ///< an impact removed it
    shattered,  ///< an impact that reached its shatter_impulse removed it
};

/// Outcome of one step of one particle.
struct MoveOutcome {
    [[nodiscard]] bool is_resting() const { return end == MoveEnd::resting || end == MoveEnd::held; }
    [[nodiscard]] bool is_frozen() const { return end == MoveEnd::frozen; }
    [[nodiscard]] bool is_absorbed() const { return end == MoveEnd::absorbed || end == MoveEnd::shattered; }
    /// Returns the number of contacts found so far, with or without an impact.
    [[nodiscard]] std::uint32_t meetings() const { return bounces + touches; }
    /// Adds the outcome of a further move of the same particle.
    void add(const MoveOutcome& next);

    MoveEnd end = MoveEnd::moving;
    std::uint32_t bounces = 0;      ///< number of impacts
    std::uint32_t touches = 0;      ///< number of contacts without an approach; only the budget counts them
    double unsimulated_time = 0.0;  ///< s, omitted because a budget is exhausted
    bool is_coarse = false;         ///< true if an adaptive method could not keep its tolerance
    std::uint32_t stayed = 0;       ///< number of impacts without a certified position nearer to the surface
    std::uint32_t squeezed = 0;     ///< 1: it was stalled between closing surfaces
    std::uint32_t trials = 0;       ///< number of states tested for collision or penetration
    double depth = 0.0;             ///< m, largest depth behind a surface before a correction
    /// Time after the end of the move, in s, for which the particle certainly touches nothing. This is valid for free
    /// flight in steps of the run's length. 0 if it was not computed.
    double free_for = 0.0;
    /// Time after the end of the move, in s, for which no triangles except `candidates` come near its path.
    double candidates_for = 0.0;
    ContactCandidates candidates = {};
};

/// Key of the random numbers of impacts. Emitters use smaller numbers.
inline constexpr std::uint32_t kImpactStream = 0xFFFFFFFFU;

/// Present acceleration of a particle, by forces and by the surfaces with which it is in contact.
struct SupportedAcceleration {
    Vec3 acceleration{};                  ///< m/s^2, including the reactions of the surfaces
    Vec3 spin_acceleration{};             ///< rad/s^2
    std::array<SurfaceId, 3> surfaces{};  ///< the first `count` are set
    std::array<Vec3, 3> reaction{};       ///< m/s^2, of each surface
    std::uint8_t count = 0;
};

class FrameForces;

/// Start of a particle that another particle spawns.
struct ChildStart {
    Vec3 parent_start;     ///< m, at the start of the parent's move
    Vec3 position;         ///< m
    double radius = 0.0;   ///< m
    bool goes_on = false;  ///< true for a fragment, which is already in contact with the surfaces that it touches
};

/// Rules of a run for a response. World, bodies, forces and materials must outlive the object.
struct ResponseRules {
    const CollisionWorld& world;    ///< colliders of the reference frame
    const MovingColliders& bodies;  ///< colliders of all frames
    const ForceField& forces;
    std::span<const Material> materials;
    ResponseSettings settings;
    double end = std::numeric_limits<double>::infinity();  ///< s, end of the run; later times do not matter
    bool look_ahead = true;                                ///< compute MoveOutcome::free_for
    /// Frame of a body, in which `world` and `forces` are given; null in the world.
    const FrameForces* frame = nullptr;
    const StopToken* stop = nullptr;  ///< null: the step cannot be stopped

    /// Throws if the step is to be stopped. Call it between pieces of work.
    void poll() const {
        if (stop != nullptr) stop->poll();
    }
};

/// Returns the first flight of a step of `duration`, in s: the planned flight if the particle still has the state at
/// its start, otherwise a flight by the integrator.
[[nodiscard]] Flight first_flight(const ResponseRules& rules, const MovingParticle& particle, double duration,
                                  const Integrator& integrator);
[[nodiscard]] inline Flight first_flight(const ResponseRules& rules, const MovingParticle& particle, double duration) {
    return first_flight(rules, particle, duration, rules.settings.integrator);
}

/// Moves particles one at a time. It can be used by any number of threads at once.
class Response {
public:
    explicit Response(const ResponseRules& rules) : rules_(rules) {}
    virtual ~Response() = default;
    Response(const Response&) = delete;
    Response& operator=(const Response&) = delete;

    /// Moves one particle from its time by `duration`, in s, and updates it.
    virtual MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const = 0;

    /// Appends the impulses, in N s, that a particle held at rest gives to its support in `duration`, in s.
    virtual void add_weight(const MovingParticle& particle, double duration, std::vector<SurfaceHit>& hits) const;

    /// Returns true if MovingParticle::sides must exist, with values from first_sides() at birth.
    [[nodiscard]] virtual bool keeps_sides() const { return false; }
    /// Sets the sides of all colliders for a new particle. sides.size() == number of colliders.
    virtual void first_sides(const Vec3& position, std::span<SideMemory> sides) const;
    /// Sets the sides of a spawned particle. sides: on input those of the parent at the start of its move.
    virtual void inherit_sides(const ChildStart& start, std::span<SideMemory> sides) const;

    /// Returns the particle's acceleration under this response, in its present contact, if forces accelerate it by
    /// `pull`, in m/s^2. Moving surfaces do not count as supports here.
    [[nodiscard]] virtual SupportedAcceleration supported_acceleration(const MovingParticle& particle,
                                                                       const Vec3& pull) const;
    /// Applies a velocity correction, in m/s, to a particle at the end of its step of `duration`, in s. The correction
    /// acts as if it had been part of the forces in that step. The impulses of the surfaces are recorded.
    void apply_correction(MovingParticle& particle, const Vec3& change, double duration, MoveScratch& scratch) const;

    [[nodiscard]] const ResponseRules& rules() const { return rules_; }

protected:
    ResponseRules rules_;  // NOLINT(misc-non-private-member-variables-in-classes)
};

/// Returns a response of a kind. With a flow, it is the response of first-order motion (advect.h), whose kind is exact
/// and which takes no forces. Throws an InputError if settings are out of range or incompatible.
[[nodiscard]] std::unique_ptr<Response> make_response(ResponseKind kind, const ResponseRules& rules);

}  // namespace ricochet
