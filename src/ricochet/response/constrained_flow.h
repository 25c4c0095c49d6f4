/// \file
/// Private to the responses: the paths on which a flow carries a particle that touches surfaces.
///
/// Of the surfaces touched those hold the particle that the flow presses it onto (see normal_accelerations()). A path
/// follows the flow without its part along their normals and ends where the flow turns away from one of them, where
/// the first of them ends, or where a curved one has turned: by kMaxArcAngle along the side of a ball or a cylinder,
/// where it is an arc with the method's order; by kMaxChordAngle round edges, and by more where the step has seen many
/// such chords already.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "ricochet/geometry/sweep/path.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// The contact points that hold a particle, by their numbers in the manifold.
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

/// The flow for one particle in one step. The particle's state and its manifold are read as they are at each call.
class ConstrainedFlow {
public:
    /// All must outlive it. step: duration of the whole step, s.
    ConstrainedFlow(const ResponseRules& rules, const SurfaceGeometry& geometry, const ForceInput& state,
                    ContactManifold& manifold, double step)
        : rules_(rules),
          flow_(*rules.settings.flow),
          geometry_(geometry),
          state_(state),
          manifold_(manifold),
          step_(step) {}

    /// The flow's velocity where the particle is, m/s.
    [[nodiscard]] Vec3 free_velocity() const { return flow_.velocity(state_.position, state_.time); }
    /// The flow's velocity without its part into the surfaces touched, m/s.
    [[nodiscard]] Vec3 velocity() const;
    /// True when the flow presses the particle onto a surface, or would lead it into one within kShortestRelease of the
    /// step, from where it is at this time.
    [[nodiscard]] bool leads_in(double time) const;
    /// s, at most `remaining`: how long it does.
    [[nodiscard]] double time_to_release(double remaining) const;

    /// True when it leads so little along surfaces in that time, s, that a path is not worth making, see kNoProgress.
    [[nodiscard]] bool is_negligible_path(double duration) const;

    /// The next path, at most `duration` long, s, and at most `reach`, m, beyond the rim of a flat surface. Contact
    /// points that the particle is past are removed.
    [[nodiscard]] Path next_path(double duration, double reach);
    /// True when an adaptive method has made all sub-steps that a step may have.
    [[nodiscard]] bool has_spent_substeps() const { return substeps_ >= kMostSubsteps; }
    /// True when it could not keep its tolerance.
    [[nodiscard]] bool is_coarse() const { return is_coarse_; }
    /// True when the last path was along surfaces.
    [[nodiscard]] bool is_held() const { return !holders_.empty(); }
    /// The round shapes along which the last path bends: it does not hit those, see ContactQuery::supports.
    [[nodiscard]] std::span<const SurfaceId> followed() const { return {followed_.data(), followed_count_}; }
    /// True when a path is back, after this time along it, at a flat surface that the particle has just left: the
    /// cubic dips into the surface where the flow does not.
    [[nodiscard]] bool dips(const Path& path, double time) const;

private:
    /// What a path ends at, and the holder that ends it.
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
    double next_duration_ = 0.0;  // s, of an adaptive method
    std::uint32_t substeps_ = 0;  // paths that have been asked of the integrator
    bool is_coarse_ = false;
    SupportSet holders_;  // of the last path
    std::array<SurfaceId, kMostSupports> followed_{};
    std::size_t followed_count_ = 0;
    int chords_ = 0;  // round edges so far
};

}  // namespace ricochet
