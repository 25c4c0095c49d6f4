/// \file
/// Private to the exact response: the way of a particle along surfaces that hold it, one contact interval or arc at a
/// time.
#pragma once

#include <limits>
#include <optional>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/contact_interval.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/curved_contact.h"
#include "ricochet/response/flat_interval.h"
#include "ricochet/response/manifold_surfaces.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Moves a particle along the surfaces of its contact manifold, and keeps the manifold to what is touched.
class ContactFollower {
public:
    /// Forces on it in an interval.
    struct Pull {
        Vec3 forces;            ///< over the mass, m/s^2
        bool acts = true;       ///< false: they have been in the velocity from the step's start on
        double pressure = 1.0;  ///< as FrictionLimits::pressure
    };
    /// Why an interval, or several, have ended before their time.
    struct Stop {
        std::optional<Contact> contact;  ///< it has come to another contact
        bool left_surface = false;       ///< the surface has ended, or holds it no more
        bool rests = false;              ///< nothing moves; no time has passed
        [[nodiscard]] bool is_early() const { return contact || left_surface; }
    };

    /// At the start of the step. Both must outlive it.
    ContactFollower(ParticleStep& step, ContactManifold& manifold);

    /// One interval of at most `duration` seconds on all that is touched.
    [[nodiscard]] Stop advance(const Pull& pull, double duration);
    /// The interval that it would be if all that is touched were flat. It loads the manifold.
    [[nodiscard]] ContactInterval plan(const Pull& pull, double duration);
    /// What holds it takes part in an impact on something else.
    void join_impact(Contact& contact) const { held_.join_impact(contact); }

private:
    /// What a particle follows in one contact interval on flat surfaces.
    struct FlatPath {
        Path path;
        bool leaves_surface = false;  ///< the surface ends at its end, before the interval does
    };
    /// What it follows on an arc.
    struct CurvedPath {
        Path path;  ///< a cubic that is no more than near the arc between its ends
        CurvedContact::State end;
        Vec3 turning_point;           ///< on the way, where another part of a surface begins; else its end
        bool leaves_surface = false;  ///< nothing holds it any more at its end
        bool jams = false;            ///< it is stuck at its end
    };

    [[nodiscard]] bool goes_nowhere(const Pull& pull, double duration);
    [[nodiscard]] bool forces_vary() const;
    [[nodiscard]] bool needs_arc() const;
    [[nodiscard]] Vec3 forces_in_middle(const ContactInterval& interval) const;
    [[nodiscard]] FlatInterval plan_by_middle(PlannedInterval begin, double pressure, double duration);
    [[nodiscard]] Stop follow_flat(const FlatInterval& flat, const Pull& pull);
    [[nodiscard]] FlatPath path_along(const FlatInterval& interval) const;
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
    double clock_ = -std::numeric_limits<double>::infinity();  // s, at the last look
    int timeless_ = 0;                                         // intervals in a row in which it stood still
};

}  // namespace ricochet
