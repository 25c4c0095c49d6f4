/// \file
/// First contact of a path among moving colliders: piece by piece, in the frame of each body near the path.
///
/// MovingPieces divides the path into pieces, which are cubics in the coordinates of each body. The cubics are swept
/// like all paths, and the time of an impact is then refined on the true path. The remaining error can only affect
/// grazing contacts. Nothing passes through a surface, because every segment is certified for stored positions.
///
/// If this takes many pieces, a longer cubic is tested first, with a margin for its larger error. The path is then
/// swept as one piece up to the time at which a surface of another frame comes near this cubic.
///
/// Deforming meshes are tested in the world, where path and vertices follow polynomials.
#pragma once

#include <cstddef>
#include <optional>

#include "ricochet/collision/moving_pieces.h"
#include "ricochet/collision/surfaces_in_other_frames.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Sweep of one path, piece by piece. All arguments must outlive the object, and `scratch` must belong to its thread.
class MovingSweep {
public:
    /// query: for a path in the frame of `surfaces` and `geometry`, from the stored `start`.
    MovingSweep(const SurfacesInTime& surfaces, const SurfaceGeometry& geometry, const ContactQuery& query,
                const PathPoint& start, ContactScratch& scratch)
        : surfaces_(surfaces),
          geometry_(geometry),
          query_(query),
          start_(start),
          scratch_(scratch),
          pieces_(surfaces, query, start, scratch) {}

    /// Returns true if the whole path has been swept.
    [[nodiscard]] bool is_done() const { return next_ >= pieces_.cuts().size(); }
    /// Returns the start of the next piece, in s along the path. If is_done(), it is the path's duration.
    [[nodiscard]] double begin() const { return begin_; }

    /// Sweeps the next piece, from its stored start. Requires !is_done(). The result is in times of the piece and valid
    /// until the next call. Afterwards path() is the piece in the frame of the query.
    [[nodiscard]] ContactQueryResult sweep(const PathPoint& start);
    [[nodiscard]] const Path& path() const { return piece_; }
    [[nodiscard]] const PathClock& clock() const { return clock_; }

    /// Returns the first contact, in times of the whole path, of a particle that never leaves the path.
    [[nodiscard]] std::optional<Contact> first_contact();

private:
    [[nodiscard]] double end_of_piece(const PathPoint& start);
    [[nodiscard]] double clear_until(const PathPoint& start, double fine);
    void set_piece(double to, const PathPoint& start);
    [[nodiscard]] SurfacesInTime at_piece() const { return {surfaces_.bodies(), surfaces_.reference(), clock_}; }
    [[nodiscard]] Path path_in(BodyId body, const SurfacesInTime& surfaces, const PathPoint& start) const;
    void meet_bodies(const SurfacesInTime& surfaces, const PathPoint& start, std::optional<Contact>& first);
    void meet_deforming(const SurfacesInTime& surfaces, const PathPoint& start, std::optional<Contact>& first);
    void find_true_time(Contact& contact, BodyId body, const SurfaceGeometry& geometry,
                        const SurfacesInTime& surfaces) const;
    void take(Contact contact, BodyId body, const SurfacesInTime& surfaces, std::optional<Contact>& first) const;
    [[nodiscard]] double beside_in_bodies() const { return 2.0 * (query_.beside + pieces_.beside()); }

    const SurfacesInTime& surfaces_;
    const SurfaceGeometry& geometry_;
    const ContactQuery& query_;
    PathPoint start_;
    ContactScratch& scratch_;
    MovingPieces pieces_;
    std::size_t next_ = 1;     // index of the first cut at or after the end of the next piece
    double begin_ = 0.0;       // start of the next piece, in s
    bool is_clear_ = false;    // true if no surface of other frames comes near the piece
    int fine_left_ = 0;        // number of fine pieces before a longer one is tried again
    int fine_after_next_ = 1;  // value of fine_left_ after the next failure of a longer piece
    std::optional<SurfacesInOtherFrames> other_frames_;
    Path piece_;
    PathClock clock_;
};

}  // namespace ricochet
