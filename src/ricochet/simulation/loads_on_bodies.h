/// \file
/// Private to the simulation: the loads on bodies, and the search for the steady load in the plan of a body. The plan
/// must agree with the particles that rest on the body.
///
/// Particles that rest on the body follow its plan, and exert a returned load. If they are heavier than the body, a
/// smaller planned load leads to a returned load that is larger by more than that. The returned load is zero if the
/// body escapes from the particles. Repeated planning with the returned load would diverge. Instead the load is
/// searched between one that is too small and one that is too large (M. Dowell, P. Jarratt, "A modified regula falsi
/// method for computing the root of an equation", BIT 11, 1971). Until both are known, a relaxation factor from the
/// ratio of masses is used (U. Kuttler, W. A. Wall, "Fixed-point fluid-structure interaction solvers with dynamic
/// relaxation", Computational Mechanics 43, 2008).
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/mobility.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/driven_body.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Load of the particles that rest on a body in a substep.
struct RestingLoad {
    Wrench wrench;           ///< N s, and N m s about the body's moment_center()
    double heaviness = 0.0;  ///< sum of the ratios of a particle's mass to the body's effective mass at its contact
};

class LoadRelaxation {
public:
    /// Begins a substep. load: load of the first plan of the substep.
    void begin_substep(const Wrench& load) { first_ = load; }
    /// Begins a search for a load.
    void begin_search() { low_ = high_ = last_ = std::nullopt; }
    [[nodiscard]] bool is_searching() const { return low_.has_value(); }
    /// Begins a search in a shorter substep, by the factor `part`. Returns the first load to try.
    [[nodiscard]] Wrench shortened(double part);
    /// Returns the estimated load of this substep minus the load of its first plan.
    [[nodiscard]] Wrench variation(const Wrench& planned, const Wrench& back, double heaviness) const;
    /// Returns true if the resting load is heavy or was heavy in the last substep, or if a search has begun.
    [[nodiscard]] bool concerns(const RestingLoad& resting_load) const {
        return is_heavy_ || low_ || resting_load.heaviness > kHeavyLoad;
    }
    /// Returns a better load (N, N m) after a plan with the load `planned` has returned the load `back`.
    [[nodiscard]] Wrench next(const DrivenBody& body, const Wrench& planned, const Wrench& back, double heaviness);
    /// Ends a substep whose plan has been accepted.
    void end_substep(const RestingLoad& resting_load);

    template <class Archive>
    void archive(Archive& a) {
        a(is_heavy_), a(heaviness_);
    }

    /// Returns false if no run can produce the present state.
    [[nodiscard]] bool is_sound() const { return heaviness_ >= 0.0 && std::isfinite(heaviness_); }

private:
    struct Tried {
        Wrench load;
        Wrench lacks;       // returned load minus `load`
        double size = 0.0;  // norm of `lacks`; halved if only the other end of the search moves
    };
    void keep(const DrivenBody& body, const Wrench& planned, const Wrench& lacks);

    bool is_heavy_ = false;
    double heaviness_ = 0.0;  // heaviness of the last resting load
    Wrench first_;
    Wrench fitting_;  // estimate of the planned load that equals its returned load
    std::optional<Tried> low_;
    std::optional<Tried> high_;
    std::optional<Tried> last_;
};

/// View of the loads in a substep, consecutive for each particle, in the order of time. Its arguments must outlive it.
class LoadsOnBodies {
public:
    /// collider_of: see BodyPaths. slow: largest speed of impacts that begin lasting contact, in m/s.
    LoadsOnBodies(std::span<const DrivenBody> bodies, std::span<const BodyId> collider_of,
                  const MovingColliders* colliders, double slow)
        : bodies_(bodies), collider_of_(collider_of), colliders_(colliders), slow_(slow) {}

    /// Returns the dynamic body on which a load acts, or nothing if the load acts on no dynamic body.
    [[nodiscard]] std::optional<std::size_t> body_of(const ColliderLoad& load) const;
    /// Returns the sum of the loads on each body, about its moment_center(), in N s and N m s.
    [[nodiscard]] std::vector<Wrench> sums(std::span<const ColliderLoad> loads) const;
    /// Returns the load that rests on a body until a time, in s.
    [[nodiscard]] RestingLoad resting_load_on(std::size_t body, std::span<const ColliderLoad> loads,
                                              double until) const;
    /// Returns the time, in s, at which the last resting load on a body ends. Returns infinity without a resting load.
    [[nodiscard]] double left_at(std::size_t body, std::span<const ColliderLoad> loads) const;
    /// Returns the mass of a particle divided by the body's effective mass for a load's impulse; 0 without impulse.
    [[nodiscard]] double heaviness_on(std::size_t body, const ColliderLoad& load) const;

private:
    [[nodiscard]] bool lies_on(std::size_t body, const ColliderLoad& load) const;

    std::span<const DrivenBody> bodies_;
    std::span<const BodyId> collider_of_;
    const MovingColliders* colliders_;
    double slow_;
};

}  // namespace ricochet
