#include "ricochet/collision/contact_query.h"

namespace ricochet {
namespace {

// Where none of the candidates is hit the particle has passed them, and what comes then is not known: the broad phase
// is asked.
void test_candidates(const ContactCandidates& candidates, NarrowPhase& narrow_phase, ContactScratch& scratch) {
    for (const std::uint32_t triangle : candidates.triangles()) (void)narrow_phase.test_triangle(triangle);
    if (!narrow_phase.has_hit()) scratch.triangles.clear();
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
    if (query.candidates.is_known()) test_candidates(query.candidates, narrow_phase, scratch);

    CandidateSet candidates = CandidateSet::near;
    LookAheadResult ahead;
    if (!query.candidates.is_known() || !narrow_phase.has_hit()) {
        bool is_tested = world.triangles().empty();
        if (query.look_ahead != nullptr && !narrow_phase.has_hit()) {
            LookAheadQuery look_ahead(world, margins, query.path, *query.look_ahead, narrow_phase, scratch);
            is_tested = look_ahead.run() || is_tested;
            candidates = look_ahead.candidates();
            ahead = look_ahead.result();
        }
        if (!is_tested) candidates = test_triangles_near(world, margins, query.path, narrow_phase);
    }
    ContactQueryResult result{std::nullopt, {geometry, scratch, margins, query.path.c[0], candidates}, ahead};
    if (narrow_phase.has_hit()) {
        result.contact = narrow_phase.take_first_contact();
        result.ahead = {};
    }
    return result;
}

}  // namespace ricochet
