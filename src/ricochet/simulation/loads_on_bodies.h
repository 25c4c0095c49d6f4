/// \file
/// Private to the simulation: the loads on bodies, and the steady load for the plan of a body, so that the plan fits
/// the particles that rest on it.
///
/// The plan of a body contains a load. Particles that rest on the body follow that plan, and give another load back. If
/// they are heavier than the body, they give the more back the less is planned, and by more than the difference. They
/// give nothing back if the planned load is so large that the body escapes from them. Planning again with the returned
/// load would diverge. Instead the load is searched between one that is too small and one that is too large (M. Dowell,
/// P. Jarratt, "A modified regula falsi method for computing the root of an equation", BIT 11, 1971). Until both are
/// known, a factor from the ratio of masses is used (U. Kuttler, W. A. Wall, "Fixed-point fluid-structure interaction
/// solvers with dynamic relaxation", Computational Mechanics 43, 2008).
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
    double heaviness = 0.0;  ///< sum of their masses, each over the body's effective mass for it
};

class LoadRelaxation {
public:
    /// Must be called with the load of the first plan of a substep.
    void begin_substep(const Wrench& load) { first_ = load; }
    /// Must be called before the search for a load.
    void begin_search() { low_ = high_ = last_ = std::nullopt; }
    [[nodiscard]] bool is_searching() const { return low_.has_value(); }
    /// Begins a search for a substep of a part of the duration, and returns the first load to try.
    [[nodiscard]] Wrench shortened(double part);
    /// Returns the difference between the load of this substep, as far as it is known, and that of its first plan.
    [[nodiscard]] Wrench variation(const Wrench& planned, const Wrench& back, double heaviness) const;
    /// Returns true if the resting load is heavy or was heavy in the last substep, or if a search has begun.
    [[nodiscard]] bool concerns(const RestingLoad& resting_load) const {
        return is_heavy_ || low_ || resting_load.heaviness > kHeavyLoad;
    }
    /// Returns a load (N, N m) that fits better, after a plan with the load `planned` has given the load `back`.
    [[nodiscard]] Wrench next(const DrivenBody& body, const Wrench& planned, const Wrench& back, double heaviness);
    /// Ends a substep that follows its plan.
    void end_substep(const RestingLoad& resting_load);

    template <class Archive>
    void archive(Archive& a) {
        a(is_heavy_), a(heaviness_);
    }

    /// Returns false for a state that no run leaves behind.
    [[nodiscard]] bool is_sound() const { return heaviness_ >= 0.0 && std::isfinite(heaviness_); }

private:
    struct Tried {
        Wrench load;
        Wrench lacks;       // returned load minus this one
        double size = 0.0;  // norm of `lacks`; halved if only the other end moves
    };
    void keep(const DrivenBody& body, const Wrench& planned, const Wrench& lacks);

    bool is_heavy_ = false;
    double heaviness_ = 0.0;  // of the last resting load
    Wrench first_;
    Wrench fitting_;  // as far as it is known
    std::optional<Tried> low_;
    std::optional<Tried> high_;
    std::optional<Tried> last_;
};

/// View of the loads in a substep; its arguments must outlive it. The loads of each particle follow each other in the
/// order of time.
class LoadsOnBodies {
public:
    /// collider_of: colliders of each body, kWorldBody if it has none. slow: speed of impacts that begin contact, in
    /// m/s.
    LoadsOnBodies(std::span<const DrivenBody> bodies, std::span<const BodyId> collider_of,
                  const MovingColliders* colliders, double slow)
        : bodies_(bodies), collider_of_(collider_of), colliders_(colliders), slow_(slow) {}

    /// Returns the body that takes a load, or nothing if the load is on no body.
    [[nodiscard]] std::optional<std::size_t> body_of(const ColliderLoad& load) const;
    /// Returns the sum of the loads on each body, about its moment_center(), in N s and N m s.
    [[nodiscard]] std::vector<Wrench> sums(std::span<const ColliderLoad> loads) const;
    /// Returns the load that rests on a body until a time, in s.
    [[nodiscard]] RestingLoad resting_load_on(std::size_t body, std::span<const ColliderLoad> loads,
                                              double until) const;
    /// Returns the time, in s, after which no resting load pushes a body any more, or infinity if none does at all.
    [[nodiscard]] double left_at(std::size_t body, std::span<const ColliderLoad> loads) const;
    /// Returns the mass of a particle over the body's effective mass for the impulse of a load; 0 without impulse.
    [[nodiscard]] double heaviness_on(std::size_t body, const ColliderLoad& load) const;

private:
    [[nodiscard]] bool lies_on(std::size_t body, const ColliderLoad& load) const;

    std::span<const DrivenBody> bodies_;
    std::span<const BodyId> collider_of_;
    const MovingColliders* colliders_;
    double slow_;
};

}  // namespace ricochet
