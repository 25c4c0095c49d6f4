/// \file
/// The exact response: predict the time of impact on the particle's own path and reflect inside the step, as often as
/// needed.
///
/// Source: continuous collision detection against static surfaces with exact predicates, see ARCHITECTURE.md.
/// What it guarantees: the chain of positions a particle is moved through crosses no surface, exactly; spheres overlap
/// nothing by more than sphere_tolerance(); the time of impact is accurate to rounding on the path.
/// What it does not guarantee: that a bounce cascade below the resting speed is resolved impact by impact (it is summed
/// in closed form), that slow circling in a pit is followed to its end (it becomes rest, kMostSlowContacts), nor that a
/// particle whose bounce budget is spent uses the whole step (the rest is counted).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/collision/contact_search.h"
#include "ricochet/core/leg.h"
#include "ricochet/dynamics/force.h"
#include "ricochet/dynamics/integrator.h"
#include "ricochet/response/bounce.h"
#include "ricochet/response/material.h"

namespace ricochet {

/// An impulse that a particle gave to a surface.
struct SurfaceHit {
    SurfaceId surface = 0;
    Vec3 impulse;        ///< N s, given to the surface
    bool impact = true;  ///< false: the push of a stretch of sliding contact
};

/// One reflection off one surface, as the contact log writes it. An impact in a corner is several of them, of the same
/// time and particle, each beginning with the velocity that the one before left.
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
    std::vector<Leg> legs;               ///< filled when record_legs
    bool record_contacts = false;
    bool record_legs = false;
};

/// The surfaces that a particle slides, rolls or rests on.
struct Support {
    std::array<SurfaceId, 3> surfaces{};
    std::uint8_t count = 0;     ///< 0: it flies
    double cascade_left = 0.0;  ///< s of a bounce cascade that the end of the step has cut in two
};

/// One particle as the response moves it.
struct MovingParticle {
    ForceInput state;  ///< position, velocity, mass, radius, time
    Vec3 spin;         ///< rad/s
    std::uint64_t id = 0;
    std::uint32_t draws = 0;  ///< random numbers drawn so far by this particle's impacts
    Support support{};        ///< what it is in contact with; contact goes on in the next step
};

/// What happened to one particle in one step.
struct MoveOutcome {
    std::uint32_t bounces = 0;      ///< impacts
    double unsimulated_time = 0.0;  ///< s that the budget cut off
    bool resting = false;           ///< ended the step at rest on its support
    bool held = false;              ///< at rest because friction and its support hold it: it stays while forces do
    bool frozen = false;            ///< the state left the range of the arithmetic; the particle was not moved
    bool absorbed = false;          ///< an impact removed it
    std::uint32_t stayed = 0;       ///< impacts after which no certified place nearer to the surface was found
};

/// The rules of a run that the response needs.
struct ResponseSettings {
    IntegratorKind integrator = IntegratorKind::ballistic;
    double resting_speed = 1e-3;  ///< m/s
    std::uint32_t bounce_budget = 1000;
    std::uint64_t seed = 0;
};

/// Key of the random numbers that impacts draw; emitters use the numbers below.
inline constexpr std::uint32_t kImpactStream = 0xFFFFFFFFU;

/// Moves particles one at a time. World, forces and materials must outlive it. Safe from any number of threads.
class ExactResponse {
public:
    ExactResponse(const CollisionWorld& world, const ForceField& forces, std::span<const Material> materials,
                  ResponseSettings settings)
        : world_(world), forces_(forces), materials_(materials), settings_(settings) {}

    /// Moves one particle from its time by `duration` seconds and updates it.
    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const;

    /// Appends the impulses, N s, that a particle held at rest gives to its support in `duration` seconds.
    void add_weight(const MovingParticle& particle, double duration, std::vector<SurfaceHit>& hits) const;

private:
    friend class Mover;
    const CollisionWorld& world_;
    const ForceField& forces_;
    std::span<const Material> materials_;
    ResponseSettings settings_;
};

}  // namespace ricochet
