/// \file
/// The exact response: predict the time of impact on the particle's own path and reflect inside the step, as often as
/// needed.
///
/// Source: continuous collision detection of points against static triangles with exact predicates, see
/// ARCHITECTURE.md. What it guarantees: the chain of positions a particle is moved through meets no surface, exactly;
/// the time of impact is accurate to rounding. What it does not guarantee: that a bounce cascade below the resting
/// speed is resolved impact by impact (it becomes contact), that slow circling in a pit is followed to its end (it
/// becomes rest, kMostSlowContacts), nor that a particle whose bounce budget is spent uses the whole step (the rest is
/// counted).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/collision/contact_search.h"
#include "ricochet/dynamics/force.h"
#include "ricochet/dynamics/integrator.h"
#include "ricochet/response/material.h"

namespace ricochet {

/// An impulse that a particle gave to a surface.
struct SurfaceHit {
    SurfaceId surface = 0;
    double time = 0.0;   ///< s, simulation time
    Vec3 impulse;        ///< N s, given to the surface
    bool impact = true;  ///< false: the push of a stretch of resting or sliding contact
};

/// Scratch memory of one thread.
struct MoveScratch {
    ContactScratch contacts;
    std::vector<SurfaceHit> hits;  ///< appended to, in the order of impacts; cleared by the caller
};

/// What happened to one particle in one step.
struct MoveOutcome {
    std::uint32_t bounces = 0;      ///< impacts
    double unsimulated_time = 0.0;  ///< s that the budget cut off
    bool resting = false;           ///< ended the step at rest in contact
    bool frozen = false;            ///< the state left the range of the arithmetic; the particle was not moved
    std::uint32_t stayed = 0;       ///< impacts after which no certified place nearer to the surface was found
};

/// The rules of a run that the response needs. Everything must outlive the response.
struct ResponseSettings {
    IntegratorKind integrator = IntegratorKind::ballistic;
    double resting_speed = 1e-3;  ///< m/s
    std::uint32_t bounce_budget = 1000;
};

class ExactResponse {
public:
    ExactResponse(const CollisionWorld& world, const ForceField& forces, std::span<const Material> materials,
                  ResponseSettings settings)
        : world_(world), forces_(forces), materials_(materials), settings_(settings) {}

    /// Moves one particle from state.time by `duration` seconds; position, velocity and time in `state` are updated.
    MoveOutcome move(ForceInput& state, double duration, MoveScratch& scratch) const;

private:
    friend class Mover;
    const CollisionWorld& world_;
    const ForceField& forces_;
    std::span<const Material> materials_;
    ResponseSettings settings_;
};

}  // namespace ricochet
