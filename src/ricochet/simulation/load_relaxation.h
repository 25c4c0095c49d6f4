/// \file
/// Private to the simulation: the steady load with which the plan of a body fits to what lies on it.
///
/// The body's plan takes a load; what lies on the body goes along with that plan, and gives it another load back. What
/// is heavier than the body gives the more back the less it is given, by more than that, and nothing where it is given
/// so much that the body runs away from it: planned again and again with what came back, the load would grow without
/// bound. So it is found between one that is too small and one that is too large, where there are both (M. Dowell,
/// P. Jarratt, "A modified regula falsi method for computing the root of an equation", BIT 11, 1971), and before with a
/// factor by how much heavier what lies there is (U. Kuttler, W. A. Wall, "Fixed-point fluid-structure interaction
/// solvers with dynamic relaxation", Computational Mechanics 43, 2008).
#pragma once

#include <cmath>
#include <optional>

#include "ricochet/core/mobility.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/driven_body.h"

namespace ricochet {

/// What lies on a body in a part of a step.
struct RestingLoad {
    Wrench wrench;           ///< N s, and N m s about the body's moment_center()
    double heaviness = 0.0;  ///< its masses, each over that with which the body yields to it
};

class LoadRelaxation {
public:
    /// To be called with the load of the first plan of a part of a step.
    void begin_substep(const Wrench& load) { first_ = load; }
    /// To be called before a load is looked for.
    void begin_search() { low_ = high_ = last_ = std::nullopt; }
    [[nodiscard]] bool is_searching() const { return low_.has_value(); }
    /// The load that would be looked for next in such a part of the duration: the search for it begins.
    [[nodiscard]] Wrench shortened(double part);
    /// By how much the load of this part differs from that of its first plan, as far as is known.
    [[nodiscard]] Wrench variation(const Wrench& planned, const Wrench& back, double heaviness) const;
    /// True where what lies on the body is heavy, or has been in the last part.
    [[nodiscard]] bool concerns(const RestingLoad& resting_load) const {
        return is_heavy_ || low_ || resting_load.heaviness > kHeavyLoad;
    }
    /// The load (N, N m) that is nearer to what fits, after a plan with one load came back with another.
    [[nodiscard]] Wrench next(const DrivenBody& body, const Wrench& planned, const Wrench& back, double heaviness);
    /// The part is as planned.
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
        Wrench lacks;       // what came back more
        double size = 0.0;  // of that; halved where the other end alone moves
    };
    void keep(const DrivenBody& body, const Wrench& planned, const Wrench& lacks);

    bool is_heavy_ = false;
    double heaviness_ = 0.0;  // when something lay there last
    Wrench first_;
    Wrench fitting_;  // as far as is known
    std::optional<Tried> low_;
    std::optional<Tried> high_;
    std::optional<Tried> last_;
};

}  // namespace ricochet
