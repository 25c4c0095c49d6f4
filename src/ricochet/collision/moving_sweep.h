/// \file
/// First contact of a path among moving colliders: piece by piece, in the frame of each body near the path.
///
/// In the coordinates of a turning body the path is no polynomial. It is cut into pieces on which the cubic Hermite
/// path is within kMovingPathTolerance of the true path. The bound is h^4 / 384 times a bound of the fourth derivative
/// (E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", section II.6). The cubics are
/// swept like all paths, and the time of an impact is then found again on the true path. The remaining error can only
/// move a grazing contact. Nothing passes through a surface, because every segment is certified for stored positions.
///
/// If this takes many pieces, a longer cubic is tested first, with a margin for its larger error. The path is one piece
/// until a surface of another frame comes near this cubic.
///
/// Deforming meshes are tested in the world, where path and vertices follow polynomials. Pieces end exactly at the keys
/// of these meshes, and positions there are stored with the key's time. No segment therefore contains a key.
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

/// Returns the box in which bodies may touch a sphere that moves along a path in the world.
[[nodiscard]] Box3 reach_of(const Path& path, double radius);

/// Sweep of one path, piece by piece. All arguments must outlive the object, and `scratch` must belong to its thread.
class MovingSweep {
public:
    /// `query` is for a path in the frame of view.home(), and `geometry` for the colliders of that frame. `start` is
    /// the stored start of the path.
    MovingSweep(const MovingView& view, const SurfaceGeometry& geometry, const ContactQuery& query,
                const PathPoint& start, ContactScratch& scratch);
    ~MovingSweep() { scratch_.sweep = std::move(lists_); }
    MovingSweep(const MovingSweep&) = delete;
    MovingSweep& operator=(const MovingSweep&) = delete;

    /// Returns true if the whole path has been swept.
    [[nodiscard]] bool is_done() const { return next_ >= lists_.cuts.size(); }
    /// Returns the start of the next piece, in s along the path. If is_done(), it is the path's duration.
    [[nodiscard]] double begin() const { return begin_; }

    /// Sweeps the next piece, from its stored start. Requires !is_done(). The result is in times of the piece and valid
    /// until the next call. Afterwards path() is the piece in the frame of the query.
    [[nodiscard]] ContactQueryResult sweep(const PathPoint& start);
    [[nodiscard]] const Path& path() const { return piece_; }
    [[nodiscard]] const PathClock& clock() const { return clock_; }

    /// Returns the first contact of the whole path, in its times, for a particle that never leaves the path.
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
    std::vector<SurfaceId> deforming_;  // triangles of deforming meshes near the whole path
    std::vector<double> times_;         // simulation times of the cuts, in s; empty without deforming meshes nearby
    double rate_ = 0.0;                 // pieces per second
    double beside_path_ = 0.0;          // result of beside_path(), in m
    double deforming_offset_ = 0.0;     // largest contact offset of deforming meshes that may be near, in m
    std::size_t next_ = 1;              // index of the first cut at or after the end of the next piece
    double begin_ = 0.0;                // start of the next piece, in s
    bool is_clear_ = false;             // true if no surface of other frames comes near the piece
    int fine_left_ = 0;                 // number of fine pieces before a longer one is tried again
    int fine_after_next_ = 1;           // the same number after the next failure of a longer piece
    std::optional<SurfacesInOtherFrames> other_frames_;
    Path piece_;
    PathClock clock_;
};

}  // namespace ricochet
