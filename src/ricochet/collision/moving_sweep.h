/// \file
/// The first contact of a path among colliders that move: piece by piece, in the frame of each body that comes near.
///
/// In the coordinates of a body that turns the path is no polynomial. It is cut into pieces on which the cubic through
/// both ends, with the velocities there, is within kMovingPathTolerance of it (h^4 / 384 times a bound of the fourth
/// derivative; E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", section II.6). Those
/// are swept as all paths are; the time of an impact is then found again on the true way. What is left of the
/// approximation moves a graze; it lets nothing through, since every link is certified for stored positions.
///
/// Where that takes many pieces, a longer cubic is looked at first, with as much more room about it as it may lie
/// beside the true way. Until something comes near that, the path is one piece, which meets nothing of other frames.
///
/// Meshes that deform are met in the world, where path and vertices are polynomials. Pieces end at their keys, whose
/// times are those that positions are stored with: no link leads over one.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "ricochet/collision/contact_query.h"
#include "ricochet/collision/path_point.h"
#include "ricochet/collision/surfaces_in_other_frames.h"
#include "ricochet/core/box3.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Where bodies may touch what moves along a path in the world.
[[nodiscard]] Box3 reach_of(const Path& path, double radius);

/// The pieces of one path. What it is given must outlive it; scratch memory of one thread.
class MovingSweep {
public:
    /// query: of a path in the frame of view.home(); geometry: of the colliders there. start: of the path, stored.
    MovingSweep(const MovingView& view, const SurfaceGeometry& geometry, const ContactQuery& query,
                const PathPoint& start, ContactScratch& scratch);
    ~MovingSweep() { scratch_.sweep = std::move(lists_); }
    MovingSweep(const MovingSweep&) = delete;
    MovingSweep& operator=(const MovingSweep&) = delete;

    /// True when all of the path has been swept.
    [[nodiscard]] bool is_done() const { return next_ >= lists_.cuts.size(); }
    /// When the next piece begins, s along the path; its duration when all is done.
    [[nodiscard]] double begin() const { return begin_; }

    /// Sweeps the next piece, unless all is done. start: where it begins, stored. The result is in times of the piece,
    /// and is valid until the next call; path() is then the piece in the frame of the query.
    [[nodiscard]] ContactQueryResult sweep(const PathPoint& start);
    [[nodiscard]] const Path& path() const { return piece_; }
    [[nodiscard]] const PathClock& clock() const { return clock_; }

    /// The first contact of the whole path, in its times, of one that goes on as it is.
    [[nodiscard]] std::optional<Contact> first_contact();

private:
    void find_near();
    void find_deforming(const Box3& box);
    void cut();
    void find_rates();
    void cut_finely();
    [[nodiscard]] double end_of_piece(const PathPoint& start);
    [[nodiscard]] double clear_until(const PathPoint& start, double fine);
    void set_piece(double to, const PathPoint& start);
    void meet_bodies(const MovingView& view, const PathPoint& start, std::optional<Contact>& first);
    [[nodiscard]] double pieces_within(double span) const;
    [[nodiscard]] double beside_path() const;
    [[nodiscard]] double beside_in_bodies() const { return 2.0 * (query_.beside + beside_path_); }
    void set_times();
    [[nodiscard]] std::vector<double> deforming_keys() const;
    [[nodiscard]] double path_time_of(double key) const;
    [[nodiscard]] double fourth_derivative(BodyId body, const DerivativeBounds& world) const;
    [[nodiscard]] double tolerance_in(BodyId body) const;
    [[nodiscard]] double tolerance_of(BodyId body) const;
    [[nodiscard]] double rounding() const;
    [[nodiscard]] DerivativeBounds world_bounds() const;
    [[nodiscard]] Path path_in(BodyId body, const MovingView& view, const PathPoint& start) const;
    void take(const Contact& found, BodyId body, const SurfaceGeometry& geometry, const MovingView& view,
              std::optional<Contact>& first) const;
    void merge(Contact contact, std::optional<Contact>& first) const;
    void meet_deforming(const MovingView& view, const PathPoint& start, double beside, std::optional<Contact>& first);
    void find_true_time(Contact& contact, BodyId body, const SurfaceGeometry& geometry, const MovingView& view) const;

    MovingView view_;
    const SurfaceGeometry& geometry_;
    const ContactQuery& query_;
    PathPoint start_;
    ContactScratch& scratch_;
    ContactScratch::Sweep lists_;
    std::vector<SurfaceId> deforming_;  // triangles of meshes that deform, near the whole path
    std::vector<double> times_;         // s, simulation times of the cuts; only where something that deforms is near
    double rate_ = 0.0;                 // pieces a second
    double beside_path_ = 0.0;          // m, of beside_path()
    double deforming_offset_ = 0.0;     // m, the largest contact offset of meshes that deform and may be near
    std::size_t next_ = 1;              // the cut at which the next piece ends, or after it
    double begin_ = 0.0;                // s, of the next piece
    bool is_clear_ = false;             // nothing of other frames comes near the piece
    int fine_left_ = 0;                 // pieces until a longer one is tried again
    int fine_after_next_ = 1;           // that many after the next one that is of no use
    std::optional<SurfacesInOtherFrames> other_frames_;
    Path piece_;
    PathClock clock_;
};

}  // namespace ricochet
