/// \file
/// The paths on which a flow carries a particle that touches surfaces.
///
/// A touched surface is a holder if the flow presses the particle onto it (see normal_accelerations()). A path follows
/// the flow without its components along the normals of the holders. The path ends when:
/// - the flow turns away from a holder,
/// - the particle reaches the end of a holder,
/// - the normal of a curved holder has turned by a limit. Along the side of a ball or a cylinder the limit is
///   kMaxArcAngle, and the path is an arc with the order of the method. Round edges the path is a chord, and the limit
///   is kMaxChordAngle. After many chords in the step this limit grows.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "ricochet/geometry/sweep/path.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// The holders of a particle, as numbers of their contact points in the manifold.
class SupportSet {
public:
    void add(std::size_t point, const Vec3& normal);
    /// k < size().
    void remove(std::size_t k);
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] std::size_t point(std::size_t k) const { return points_[k]; }
    [[nodiscard]] bool has(std::size_t point) const;
    [[nodiscard]] std::span<const Vec3> normals() const { return {normals_.data(), count_}; }

private:
    std::array<std::size_t, kMostSupports> points_{};
    std::array<Vec3, kMostSupports> normals_;
    std::size_t count_ = 0;
};

/// The flow for one particle in one step. Each call reads the current state of the particle and its manifold.
class ConstrainedFlow {
public:
    /// All referenced arguments must outlive the object. step: duration of the whole step, in s.
    ConstrainedFlow(const ResponseRules& rules, const SurfaceGeometry& geometry, const ForceInput& state,
                    ContactManifold& manifold, double step)
        : rules_(rules),
          flow_(*rules.settings.flow),
          geometry_(geometry),
          state_(state),
          manifold_(manifold),
          step_(step) {}

    /// Returns the velocity of the flow at the particle, in m/s.
    [[nodiscard]] Vec3 free_velocity() const { return flow_.velocity(state_.position, state_.time); }
    /// Returns the velocity of the flow without its component into the touched surfaces, in m/s.
    [[nodiscard]] Vec3 velocity() const;
    /// Returns true if the flow at a time, in s, presses the particle onto a surface. Also returns true if it would
    /// carry the particle into one within the fraction kShortestRelease of a step.
    [[nodiscard]] bool leads_in(double time) const;
    /// Returns the time, in s, until leads_in() becomes false, at most `remaining`.
    [[nodiscard]] double time_to_release(double remaining) const;

    /// Returns true if a path of a duration, in s, would make no progress, see kNoProgress.
    [[nodiscard]] bool is_negligible_path(double duration) const;

    /// Returns the next path. It lasts at most `duration`, in s, and ends at most `reach`, in m, beyond the rim of a
    /// flat surface. Removes contact points that the particle has passed.
    [[nodiscard]] Path next_path(double duration, double reach);
    /// Returns true if an adaptive method has made all sub-steps that a step may have.
    [[nodiscard]] bool has_spent_substeps() const { return substeps_ >= kMostSubsteps; }
    /// Returns true if an adaptive method could not keep its tolerance.
    [[nodiscard]] bool is_coarse() const { return is_coarse_; }
    /// Returns true if the last path was along surfaces.
    [[nodiscard]] bool is_held() const { return !holders_.empty(); }
    /// Returns the round shapes that the last path follows on an arc, for ContactQuery::supports.
    [[nodiscard]] std::span<const SurfaceId> followed() const { return {followed_.data(), followed_count_}; }
    /// Returns true if, at this time on the path, in s, the path is behind a flat surface that the particle has just
    /// left. Such a cubic dips into the surface although the flow does not.
    [[nodiscard]] bool dips(const Path& path, double time) const;

private:
    /// A path, and the number of the holder that ends it.
    struct Part {
        Path path;
        std::size_t ended_by = 0;
    };

    [[nodiscard]] SupportSet holders_now() const;
    [[nodiscard]] Path free_path(double duration);
    using Surfaces = std::array<ContactSurface, kMostSupports>;

    void find_followed();
    [[nodiscard]] std::span<const ContactSurface> supports(Surfaces& surfaces) const;
    [[nodiscard]] Part arc_until_release(const Path& path) const;
    [[nodiscard]] Path arc(double duration) const;
    [[nodiscard]] std::optional<std::size_t> released_by(const Vec3& position, double time) const;
    [[nodiscard]] double longest_arc(double duration) const;
    [[nodiscard]] Part until_release(const Path& path) const;
    [[nodiscard]] std::size_t weakest(const Vec3& g) const;
    [[nodiscard]] Part until_rim(const Path& path, double reach) const;
    [[nodiscard]] Path lifted(Path path) const;
    [[nodiscard]] Path along_curved(const ContactSurface& support, Path path);
    [[nodiscard]] bool is_no_progress(double duration, const Vec3& velocity) const;

    const ResponseRules& rules_;
    const FlowField& flow_;
    const SurfaceGeometry& geometry_;
    const ForceInput& state_;
    ContactManifold& manifold_;
    double step_;
    double next_duration_ = 0.0;  // s, first trial of an adaptive method for the next path
    std::uint32_t substeps_ = 0;  // paths requested from the integrator
    bool is_coarse_ = false;
    SupportSet holders_;  // holders of the last path
    std::array<SurfaceId, kMostSupports> followed_{};
    std::size_t followed_count_ = 0;
    int chords_ = 0;  // chords round edges in this step
};

}  // namespace ricochet
