/// \file
/// Division of a path among moving colliders into pieces, and the bodies and deforming triangles near it.
///
/// In the coordinates of a rotating body the path is no polynomial. The path is cut into pieces on which the cubic
/// Hermite path is within kMovingPathTolerance of the true path. The bound is h^4 / 384 times a bound of the fourth
/// derivative (E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", section II.6).
///
/// Pieces end exactly at the keys of deforming meshes, and at the keys' times. So no segment contains a key.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/collision/contact_query.h"
#include "ricochet/core/box3.h"

namespace ricochet {

/// Returns the box in which bodies may touch a sphere that moves along a path in the world.
[[nodiscard]] Box3 reach_of(const Path& path, double radius);

/// Returns the largest duration, in s, over which a cubic Hermite path of 4th derivative `fourth` errs by `error`, in
/// m.
[[nodiscard]] double longest_cubic(double error, double fourth);

/// The surroundings of one path, and the times at which it is cut. All arguments must outlive the object.
class MovingPieces {
public:
    using NearBody = ContactScratch::Sweep::NearBody;

    /// query: for a path in the frame of `surfaces` from the stored `start`. Owns the scratch lists in its lifetime.
    MovingPieces(const SurfacesInTime& surfaces, const ContactQuery& query, const PathPoint& start,
                 ContactScratch& scratch);
    ~MovingPieces() { scratch_.sweep = std::move(lists_); }
    MovingPieces(const MovingPieces&) = delete;
    MovingPieces& operator=(const MovingPieces&) = delete;

    /// Returns the bodies near the path, in ascending order.
    [[nodiscard]] std::span<NearBody> bodies() { return lists_.bodies; }
    /// Returns the triangles of deforming meshes near the path, in ascending order.
    [[nodiscard]] std::span<const SurfaceId> deforming() const { return deforming_; }
    /// Returns the largest allowed deviation, in m, of a piece from the true path in the coordinates of a body.
    [[nodiscard]] double tolerance_of(BodyId body) const;
    /// Returns the distance from the path, in m, to query, which covers the error of the cubics and rounding.
    [[nodiscard]] double beside() const { return beside_; }

    /// Returns the times along the path at which it is cut, in s, from 0 to its duration.
    [[nodiscard]] std::span<const double> cuts() const { return lists_.cuts; }
    /// Returns the number of fine pieces into which a span of time, in s, is divided.
    [[nodiscard]] double count_within(double span) const;
    /// Returns the clock of a piece of the path. `next`: index of the first cut at or after its end.
    [[nodiscard]] PathClock clock_of(double from, double to, std::size_t next) const;

private:
    void find_bodies();
    void find_deforming(const Box3& box);
    void cut();
    void find_rates();
    void cut_finely();
    void set_times();
    [[nodiscard]] std::vector<double> deforming_keys() const;
    [[nodiscard]] double path_time_of(double key) const;
    [[nodiscard]] double fourth_derivative(BodyId body, const DerivativeBounds& world) const;
    [[nodiscard]] double tolerance_in(BodyId body) const;
    [[nodiscard]] double rounding() const;

    const SurfacesInTime& surfaces_;
    const ContactQuery& query_;
    PathPoint start_;
    ContactScratch& scratch_;
    ContactScratch::Sweep lists_;
    std::vector<SurfaceId> deforming_;
    std::vector<double> times_;      // simulation times of the cuts, in s; empty without deforming meshes nearby
    double rate_ = 0.0;              // fine pieces per second
    double deforming_offset_ = 0.0;  // largest contact offset of deforming meshes that may be near, in m
    double beside_ = 0.0;            // in m, result of beside()
};

}  // namespace ricochet
