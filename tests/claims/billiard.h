/// \file
/// Particles that bounce without loss in a mesh, and independent checks of where they get to.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "claims/hard_meshes.h"
#include "ricochet/collision/collision_world.h"
#include "ricochet/collision/way_point.h"
#include "ricochet/dynamics/flight.h"
#include "support/parity.h"

namespace ricochet::testing {

/// What came of a run.
struct BilliardTally {
    std::uint64_t contacts = 0;
    std::uint64_t stayed = 0;             ///< contacts after which the particle stood where its path began
    std::uint64_t not_inside = 0;         ///< particles outside, or on the surface, at any check
    std::uint64_t checked_segments = 0;   ///< segments tested again by the exact oracle
    std::uint64_t crossing_segments = 0;  ///< of these, segments that intersect a triangle
    std::uint64_t budget_exhausted = 0;   ///< steps that spent their bounces
};

/// A mesh placed in the world, with its oracle.
class Billiard {
public:
    Billiard(const NamedMesh& mesh, const Placement& placement);

    /// Points strictly inside, uniform in the volume (for an open mesh: in its box). The same for the same seed.
    [[nodiscard]] std::vector<Vec3> start_points(int count, std::uint64_t seed) const;

    /// Random directions, about `impacts` impacts a step; `gravity` in mean free paths per step squared (0: straight
    /// flight).
    [[nodiscard]] BilliardTally fly(int particles, int steps, double impacts, double gravity, IntegratorKind kind,
                                    std::uint64_t seed) const;

    /// Every flight is aimed at a vertex or a point of an edge; after an impact of the triangle just hit (two times in
    /// three) or of any. Some flights end exactly there. One segment in `check_every` is tested by the oracle.
    [[nodiscard]] BilliardTally aim(int particles, int impacts, int check_every, std::uint64_t seed) const;

    [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
    [[nodiscard]] bool is_closed() const { return oracle_ != nullptr; }

private:
    void check_legs(const std::vector<WayPoint>& chain, const Vec3& from, const Vec3& to, BilliardTally& tally) const;
    [[nodiscard]] bool may_be_at(const Vec3& point) const { return !oracle_ || oracle_->inside(point); }

    TriangleMesh mesh_;  // in world coordinates
    CollisionWorld world_;
    std::unique_ptr<ParityOracle> oracle_;  // none for an open mesh
    double mean_free_path_ = 0.0;
};

/// True when the closed segment intersects a triangle of the mesh: exact, and independent of the library's predicates
/// and hierarchy. Linear in the number of triangles.
[[nodiscard]] bool oracle_meets(const TriangleMesh& mesh, const Vec3& p, const Vec3& q);

}  // namespace ricochet::testing
