/// \file
/// Motion of a particle along surfaces that hold it, one contact interval at a time.
#pragma once

#include <limits>
#include <optional>

#include "ricochet/response/contact_interval.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/curved_contact.h"
#include "ricochet/response/flat_interval.h"
#include "ricochet/response/manifold_surfaces.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Moves a particle along the surfaces of its contact manifold, and keeps the manifold up to date.
class ContactFollower {
public:
    /// Forces on the particle in an interval.
    struct Pull {
        Vec3 forces;            ///< over the mass, m/s^2
        bool acts = true;       ///< false: the velocity contains them since the start of the step
        double pressure = 1.0;  ///< as FrictionLimits::pressure
    };
    /// Reason for which one or several intervals have ended early.
    struct Stop {
        std::optional<Contact> contact;  ///< the particle has reached another contact
        bool left_surface = false;       ///< the surface has ended, or holds it no longer
        bool rests = false;              ///< the particle rests; no time has passed
        [[nodiscard]] bool is_early() const { return contact || left_surface; }
    };

    /// Construct it at the start of the step. Both must outlive it.
    ContactFollower(ParticleStep& step, ContactManifold& manifold);

    /// Follows one interval of at most `duration`, in s, on all touched surfaces.
    [[nodiscard]] Stop advance(const Pull& pull, double duration);
    /// Plans an interval as if all touched surfaces were flat, and loads the manifold.
    [[nodiscard]] ContactInterval plan(const Pull& pull, double duration);
    /// Adds the surfaces that hold the particle to an impact on another surface.
    void join_impact(Contact& contact) const { held_.join_impact(contact); }

private:
    struct FlatPath {
        Path path;
        bool leaves_surface = false;  ///< the surface ends at the path's end, before the interval does
    };
    struct CurvedPath {
        Path path;  ///< a cubic; between its ends it only approximates the arc
        CurvedContact::State end;
        Vec3 turning_point;           ///< start of another part of a surface on the path, else its end
        bool leaves_surface = false;  ///< nothing holds the particle at the end
        bool jams = false;            ///< the particle is stuck at the end
    };

    [[nodiscard]] Stop rest_with(const Vec3& spin);
    [[nodiscard]] bool goes_nowhere(const Pull& pull, double duration);
    [[nodiscard]] bool forces_vary() const;
    [[nodiscard]] bool needs_arc() const;
    [[nodiscard]] Vec3 forces_in_middle(const ContactInterval& interval) const;
    [[nodiscard]] FlatInterval plan_by_middle(PlannedInterval begin, double pressure, double duration);
    [[nodiscard]] std::optional<FlatInterval> plan_turning_slip(const Pull& pull, double duration);
    [[nodiscard]] Stop follow_flat(const FlatInterval& flat, const Pull& pull);
    [[nodiscard]] std::optional<Contact> move_along(FlatPath& trajectory, const FlatInterval& flat);
    [[nodiscard]] FlatPath path_along(const FlatInterval& interval, double time) const;
    void keep_offset(Path& path, const FlatInterval& interval) const;
    [[nodiscard]] Stop follow_arc(const Pull& pull, double duration);
    [[nodiscard]] std::optional<CurvedPath> path_along(const CurvedContact& arc) const;
    void lead_to(const CurvedContact::State& end, double time, const CurvedContact& arc, CurvedPath& trajectory) const;
    void keep_to_pieces(const CurvedContact& arc, CurvedPath& trajectory) const;
    [[nodiscard]] double time_on_pieces(const Path& path) const;
    [[nodiscard]] std::optional<Contact> move_along(CurvedPath& trajectory, const CurvedContact& arc);
    [[nodiscard]] std::optional<ErrorTolerance> tolerance() const;

    [[nodiscard]] const ResponseRules& rules() const { return step_.rules(); }
    [[nodiscard]] MovingParticle& particle() const { return step_.particle(); }
    [[nodiscard]] ForceInput& state() const { return step_.state(); }
    [[nodiscard]] const SurfaceKinematics& surfaces() const { return step_.impact().surfaces(); }
    [[nodiscard]] ImpulseLedger& ledger() { return step_.impact().ledger(); }

    ParticleStep& step_;
    ContactManifold& manifold_;
    ManifoldSurfaces held_;
    double clock_ = -std::numeric_limits<double>::infinity();  // s, at the last call
    int timeless_ = 0;                                         // consecutive intervals without progress of the clock
};

}  // namespace ricochet
