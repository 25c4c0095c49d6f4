#include "ricochet/collision/broad_phase.h"

#include <algorithm>

#include "ricochet/collision/look_ahead.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Largest number of times that a path is halved to find pieces flat enough for the boxes. Only pieces near the
/// triangles are halved. A path that is still too curved then is tested against every triangle. Local, because only the
/// cost depends on it.
constexpr int kPieceDepth = 40;

// Returns true if a piece of the path may come near the triangles. The margin for curvature is included because a chord
// can begin on this piece and end on the next one.
bool may_reach_triangles(const CollisionWorld& world, const QueryMargins& margins, const Path& path, double from,
                         double to) {
    Box3 box;
    box.include(path.position(from));
    box.include(path.position(to));
    const double margin = path.sagitta(from, to) + margins.slack + margins.curvature + margins.radius;
    const Vec3 by{margin, margin, margin};
    const Box3& triangles = world.triangle_bounds();
    const Vec3 gap = max(box.lower - by - triangles.upper, triangles.lower - (box.upper + by));
    return !(gap.x > 0.0 || gap.y > 0.0 || gap.z > 0.0);
}

/// Tests one path against the bounding volume hierarchy, piece by piece.
struct PieceQuery {
    const CollisionWorld& world;
    const QueryMargins& margins;
    const Path& path;
    NarrowPhase& narrow_phase;
    CandidateSet candidates = CandidateSet::near;

    void test_all() {
        candidates = CandidateSet::all;
        for (std::uint32_t triangle = 0; triangle < world.triangles().size(); ++triangle) {
            (void)narrow_phase.test_triangle(triangle);
        }
    }

    // Visits pieces in the order of time, so a contact ends the query.
    void test_piece(double from, double to, int depth) {
        if (from > narrow_phase.first_time() || candidates == CandidateSet::all) return;
        if (path.degree == 2) {
            const double clear =
                time_clear_of_field(path, world.distance_field(), broad_phase_margin(path, margins), from);
            if (clear > from && clear >= to) return;
            from = clear;
        }
        if (covers_chord(world, margins, path, from, to)) {
            query_chord(from, to);
        } else if (depth == 0) {
            test_all();
        } else {
            const double middle = 0.5 * (from + to);
            test_piece(from, middle, depth - 1);
            test_piece(middle, to, depth - 1);
        }
    }

    // The tube also covers chords of the path that covers_chord() accepts.
    void query_chord(double from, double to) {
        const double span = to - from;
        const bool is_parabola = path.degree == 2;
        const double beside_piece = is_parabola ? 0.0 : path.sagitta(from, to);
        const double margin = broad_phase_margin(path, margins) + beside_piece;
        const Tube tube(path.position(from), path.position(to), margin, is_parabola ? span * span * path.c[2] : Vec3{});
        margins.bvh->query_tube(tube, [&](std::uint32_t triangle, double /*enter*/, double /*leave*/) {
            (void)narrow_phase.test_triangle(triangle);
            const double first = narrow_phase.first_time();
            return first < to ? std::max(0.0, (first - from) / span) : 1.0;
        });
    }
};

}  // namespace

// If the boxes do not cover the surroundings of a path that may reach triangles, the path is tested against every
// triangle.
CandidateSet test_triangles_near(const CollisionWorld& world, const QueryMargins& margins, const Path& path,
                                 NarrowPhase& narrow_phase) {
    PieceQuery query{world, margins, path, narrow_phase};
    if (world.culls() && margins.boxes_hold) {
        query.test_piece(0.0, path.duration, kPieceDepth);
    } else if (!world.culls() || may_reach_triangles(world, margins, path, 0.0, path.duration)) {
        query.test_all();
    }
    // Without culling, the result is `near` too, because the chords that a particle follows must not depend on culling.
    if (!world.culls() && margins.boxes_hold) return CandidateSet::near;
    return query.candidates;
}

namespace {

/// Computes when a path first comes near a triangle, piece by piece.
struct ClearQuery {
    const CollisionWorld& world;
    const QueryMargins& margins;
    const Path& path;
    double until;  ///< in s: end of the search before the query, result after it

    void test_piece(double from, double to, int depth) {
        if (from >= until) return;
        const double margin = broad_phase_margin(path, margins);
        if (path.degree > 1) from = std::max(from, time_clear_of_field(path, world.distance_field(), margin, from));
        if (from >= std::min(to, until)) return;
        if (covers_chord(world, margins, path, from, to)) {
            query_chord(from, to, margin);
        } else if (depth == 0) {
            until = from;
        } else {
            const double middle = 0.5 * (from + to);
            test_piece(from, middle, depth - 1);
            test_piece(middle, to, depth - 1);
        }
    }

    void query_chord(double from, double to, double margin) {
        const double span = to - from;
        const Tube tube(path.position(from), path.position(to), margin + path.sagitta(from, to));
        margins.bvh->query_tube(tube, [&](std::uint32_t triangle, double enter, double /*leave*/) {
            if (!world.is_degenerate(triangle)) until = std::min(until, from + enter * span);
            return until < to ? std::max(0.0, (until - from) / span) : 1.0;
        });
    }
};

double time_clear_of_triangles(const CollisionWorld& world, const QueryMargins& margins, const Path& path,
                               double until) {
    if (world.triangles().empty() || !may_reach_triangles(world, margins, path, 0.0, until)) return until;
    if (!margins.boxes_hold) return 0.0;
    ClearQuery query{world, margins, path, until};
    query.test_piece(0.0, until, kPieceDepth);
    return query.until;
}

}  // namespace

double broad_phase_margin(const Path& path, const QueryMargins& margins) {
    return margins.radius + 2.0 * margins.slack + std::min(path.sagitta(0.0, path.duration), 0.5 * margins.curvature);
}

// A point of a chord is at most the chord's sagitta away from the path. The nearest point of the path is at most the
// sagitta of its piece away from the chord of that piece. The sum must not exceed the margin that the boxes leave for
// curvature.
bool covers_chord(const CollisionWorld& world, const QueryMargins& margins, const Path& path, double from, double to) {
    return path.degree < 2 || world.triangles().empty() || 2.0 * path.sagitta(from, to) <= margins.curvature ||
           !may_reach_triangles(world, margins, path, from, to);
}

double time_clear_of(const CollisionWorld& world, const QueryMargins& margins, const Path& path, double least) {
    double until = path.duration;
    const double margin = margins.radius + margins.slack;
    for (const auto& [plane, surface] : world.planes()) {
        while (until >= least && !stays_on_one_side(shortened(path, until), plane, margin)) until *= 0.5;
    }
    for (const CollisionWorld::ShapeSurface& shape : world.shapes()) {
        while (until >= least && !shape.shape.can_cull(shortened(path, until), margin)) until *= 0.5;
    }
    if (until >= least) until = time_clear_of_triangles(world, margins, path, until);
    return until < least ? 0.0 : until;
}

}  // namespace ricochet
