/// \file
/// The surfaces near a particle.
#pragma once

#include <algorithm>
#include <vector>

#include "ricochet/collision/contact_query.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {

/// Calls found(surface) for each surface of a frame near a position in that frame. The order is planes, shapes,
/// triangles, each with ascending numbers. beside: as ContactQuery::beside.
template <class Found>
void visit_near_in(const ParticleStep& step, const SurfaceGeometry& geometry, const Vec3& position, double beside,
                   const Found& found) {
    const Path here = line_path(position, Vec3{}, 0.0);
    ContactScratch& scratch = step.scratch().contacts;
    (void)find_first_contact(geometry, {here, step.state().radius, nullptr, {}, {}, beside}, scratch);
    const CollisionWorld& world = geometry.world();
    for (const std::uint32_t k : scratch.planes) found(world.planes()[k].surface);
    for (const std::uint32_t k : scratch.shapes) {
        const CollisionWorld::ShapeSurface& shape = world.shapes()[k];
        for (SurfaceId part = 0; part < shape.shape.part_count(); ++part) found(shape.surface + part);
    }
    // Callers keep the first surfaces, so the order must not depend on the broad phase.
    std::vector<std::uint32_t>& triangles = scratch.triangles;
    std::ranges::sort(triangles);
    for (const std::uint32_t triangle : triangles) found(world.surface_of_triangle(triangle));
}

/// Calls found(surface) for each surface of the reference frame near the particle, in the same order.
template <class Found>
void visit_near(const ParticleStep& step, const Found& found) {
    const Vec3& position = step.state().position;
    const double beside =
        step.reference().is_moving() ? kTouchingOffsets * step.geometry().contact_offset(position) : 0.0;
    visit_near_in(step, step.geometry(), position, beside, found);
}

}  // namespace ricochet
