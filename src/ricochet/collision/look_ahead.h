/// \file
/// Looking ahead: for how long may a particle go on along its path before any surface comes near, and which triangles
/// are those?
///
/// What is found serves speed only. A particle whose path is certainly free needs no query, and its state after the
/// step is what a query would have left: the end of the same path.
#pragma once

#include "ricochet/collision/broad_phase.h"
#include "ricochet/core/box3.h"

namespace ricochet {

/// Where a particle is going beyond the path of a query, if nothing stands in its way.
struct LookAhead {
    Path path;            ///< a line or parabola that begins with the query's path
    double margin = 0.0;  ///< m, > 0: nothing may come nearer than the radius plus this but what is left behind. It
                          ///< covers by how much the true trajectory, the query's path too, and its chords of a step
                          ///< may lie beside `path`
    double least = 0.0;   ///< s along the path, a step: less free time than this is not worth the work
    double beyond = 0.0;  ///< s: what comes near within this time after the free time is of interest too
};

/// Times are s along the look-ahead's path.
struct LookAheadResult {
    /// Until then no surface is nearer to the path than the radius plus the margin, but for those that a sphere leaves
    /// behind for good. At most the query's duration where looking ahead is not worth the work.
    double free_until = 0.0;
    /// The triangles, other than those left behind, that come near between the end of the query's path and
    /// candidates_until, which is at most `beyond` after free_until.
    ContactCandidates candidates = {};
    double candidates_until = 0.0;
};

/// Looks ahead and tests the triangles near the query's own path by the narrow phase on the way.
class LookAheadQuery {
public:
    /// All must outlive it. narrow_phase has tested planes and shapes, and none is hit.
    LookAheadQuery(const CollisionWorld& world, const QueryMargins& margins, const Path& path,
                   const LookAhead& look_ahead, NarrowPhase& narrow_phase, ContactScratch& scratch)
        : world_(world),
          margins_(margins),
          path_(path),
          ahead_(look_ahead),
          narrow_phase_(narrow_phase),
          scratch_(scratch) {}

    /// False when the triangles near the path still have to be tested; nothing is known of what comes after it then.
    [[nodiscard]] bool run();

    [[nodiscard]] const LookAheadResult& result() const { return result_; }
    [[nodiscard]] CandidateSet candidates() const { return candidates_; }

private:
    void pass_planes_and_shapes();
    [[nodiscard]] bool pass_triangles();
    [[nodiscard]] bool query_line();
    [[nodiscard]] bool query_parabola();
    void query_piece(double from, double to);
    void add_approach(std::uint32_t triangle, double enter, double last);
    void keep_candidates(double until);
    [[nodiscard]] double time_of_approach(std::uint32_t triangle, double enter, double last) const;
    [[nodiscard]] bool is_left_behind(double separating_speed) const;
    [[nodiscard]] Box3 box_of_interest() const;
    [[nodiscard]] bool boxes_hold(double duration) const;
    [[nodiscard]] double margin_until(double time) const;
    [[nodiscard]] double end_of_query() const;
    [[nodiscard]] double end_of_interest() const;

    const CollisionWorld& world_;
    const QueryMargins& margins_;
    const Path& path_;
    const LookAhead& ahead_;
    NarrowPhase& narrow_phase_;
    ContactScratch& scratch_;
    LookAheadResult result_;
    CandidateSet candidates_ = CandidateSet::near;
};

}  // namespace ricochet
