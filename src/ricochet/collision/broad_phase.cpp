#include "ricochet/collision/broad_phase.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ricochet/collision/look_ahead.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

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

/// A piece of a path, in s.
struct Piece {
    double from;
    double to;
};

/// Divides a path into the pieces that may come near triangles, in the order of time. Each piece is flat enough for the
/// margin of the boxes. Method: sphere tracing in the distance field finds the starts of the pieces.
class Pieces {
public:
    Pieces(const CollisionWorld& world, const QueryMargins& margins, const Path& path)
        : world_(world), path_(path), margin_(broad_phase_margin(path, margins)), left_(most_pieces(world)) {
        if (path.degree < 2) return;
        // A chord over a time t has a sagitta of at most t^2 / 8 times the largest acceleration.
        longest_ = path.duration * std::sqrt(0.5 * margins.curvature / path.sagitta(0.0, path.duration)) * kShorter;
        if (are_too_short()) left_ = 0;
    }

    /// Returns the next piece, or nothing if the path stays clear until its end or if too many pieces are needed. A
    /// path without duration is one piece.
    std::optional<Piece> next() {
        if (is_at_end_ || !has_next()) return std::nullopt;
        double from = to_;
        if (path_.degree > 1) from = time_clear_of_field(path_, world_.distance_field(), margin_, from);
        if (from > 0.0 && from >= path_.duration) return std::nullopt;
        --left_;
        to_ = from + longest_ < path_.duration ? from + longest_ : path_.duration;
        is_at_end_ = to_ == path_.duration;
        return Piece{from, to_};
    }
    /// Returns the end of the last piece, in s.
    [[nodiscard]] double end() const { return to_; }
    /// Returns false if so many pieces have been returned that a test of all triangles is cheaper.
    [[nodiscard]] bool has_next() const { return left_ > 0; }
    /// Returns true if chords of the path cannot fit into the margin of the boxes. Otherwise chords keep to it, even if
    /// all triangles have been tested, because the chords that a particle follows must not depend on the number of
    /// triangles.
    [[nodiscard]] bool are_too_short() const { return !(longest_ > kShortest * path_.duration); }

private:
    /// Factor that covers the rounding of the longest duration. Local: an error bound of this arithmetic.
    static constexpr double kShorter = 1.0 - 0x1p-40;
    /// Least duration of a piece, as a fraction of the path's. Local, because only paths of absurd curvature reach it.
    static constexpr double kShortest = 0x1p-40;
    /// Least number of pieces before all triangles are tested instead. Local, because only the cost depends on it.
    static constexpr std::size_t kMostPieces = 64;

    static std::size_t most_pieces(const CollisionWorld& world) {
        return std::max(kMostPieces, world.triangles().size());
    }

    const CollisionWorld& world_;
    const Path& path_;
    double margin_;
    double longest_ = std::numeric_limits<double>::infinity();  ///< in s, of a piece
    std::size_t left_;
    double to_ = 0.0;
    bool is_at_end_ = false;
};

/// Tests one path against the bounding volume hierarchy, piece by piece.
struct PieceQuery {
    const CollisionWorld& world;
    const QueryMargins& margins;
    const Path& path;
    NarrowPhase& narrow_phase;

    void test_all() {
        for (std::uint32_t triangle = 0; triangle < world.triangles().size(); ++triangle) {
            (void)narrow_phase.test_triangle(triangle);
        }
    }

    // Visits pieces in the order of time, so a contact ends the query.
    CandidateSet test_near() {
        Pieces pieces(world, margins, path);
        while (pieces.end() <= narrow_phase.first_time()) {
            const std::optional<Piece> piece = pieces.next();
            if (!piece) break;
            query_piece(*piece);
        }
        if (pieces.has_next()) return CandidateSet::near;
        test_all();
        return pieces.are_too_short() ? CandidateSet::all : CandidateSet::near;
    }

    // The tube also covers chords of the path that covers_chord() accepts.
    void query_piece(const Piece& piece) {
        const double from = piece.from;  // clang before version 16 does not capture structured bindings
        const double to = piece.to;
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
    if (world.culls() && margins.boxes_hold) return query.test_near();
    const bool is_tested = !world.culls() || may_reach_triangles(world, margins, path, 0.0, path.duration);
    if (is_tested) query.test_all();
    // Without culling, the result is `near` if the boxes hold, because the chords that a particle follows must not
    // depend on culling.
    return is_tested && !margins.boxes_hold ? CandidateSet::all : CandidateSet::near;
}

namespace {

/// Computes when a path first comes near a triangle, piece by piece.
struct ClearQuery {
    const CollisionWorld& world;
    const QueryMargins& margins;
    const Path& path;
    double until;  ///< in s: end of the search before the query, result after it

    void run() {
        Pieces pieces(world, margins, path);
        while (pieces.end() < until) {
            const std::optional<Piece> piece = pieces.next();
            if (!piece) break;
            query_piece(*piece);
        }
        if (!pieces.has_next()) until = std::min(until, pieces.end());
    }

    void query_piece(const Piece& piece) {
        const double from = piece.from;  // clang before version 16 does not capture structured bindings
        const double to = piece.to;
        const double span = to - from;
        const double margin = broad_phase_margin(path, margins) + path.sagitta(from, to);
        const Tube tube(path.position(from), path.position(to), margin);
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
    query.run();
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
