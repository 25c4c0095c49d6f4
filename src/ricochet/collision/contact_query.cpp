#include "ricochet/collision/contact_query.h"

namespace ricochet {
namespace {

/// True when one is hit. Otherwise the particle has passed them all, and what comes then is not known: the triangles
/// near the path have to be found by the broad phase.
bool is_candidate_hit(const ContactCandidates& candidates, NarrowPhase& narrow_phase, ContactScratch& scratch) {
    for (const std::uint32_t triangle : candidates.triangles()) (void)narrow_phase.test_triangle(triangle);
    if (!narrow_phase.has_hit()) scratch.triangles.clear();
    return narrow_phase.has_hit();
}

/// Tests the triangles near the path, and looks ahead where nothing is hit; planes and shapes have been tested.
LookAheadOutcome test_triangles(const CollisionWorld& world, const QueryMargins& margins, const ContactQuery& query,
                                NarrowPhase& narrow_phase, ContactScratch& scratch) {
    if (query.candidates.is_known() && is_candidate_hit(query.candidates, narrow_phase, scratch)) {
        return {{}, CandidateSet::near};
    }
    if (query.look_ahead != nullptr && !narrow_phase.has_hit()) {
        const LookAheadOutcome ahead = look_ahead(world, margins, query.path, *query.look_ahead, narrow_phase, scratch);
        if (ahead.tested) return ahead;
    }
    if (world.triangles().empty()) return {{}, CandidateSet::near};
    return {{}, test_triangles_near(world, margins, query.path, narrow_phase)};
}

}  // namespace

ContactQueryResult find_first_contact(const SurfaceGeometry& geometry, const ContactQuery& query,
                                      ContactScratch& scratch) {
    const CollisionWorld& world = geometry.world();
    const QueryMargins margins(world, query.path, query.radius);
    scratch.clear();
    NarrowPhase narrow_phase(geometry, query.path, margins, scratch);
    narrow_phase.test_planes();
    narrow_phase.test_shapes();
    const auto [ahead, tested] = test_triangles(world, margins, query, narrow_phase, scratch);
    ContactQueryResult result{std::nullopt, {geometry, scratch, margins, query.path.c[0], *tested}, ahead};
    if (narrow_phase.has_hit()) {
        result.contact = narrow_phase.take_first_contact();
        result.ahead = {};
    }
    return result;
}

}  // namespace ricochet
