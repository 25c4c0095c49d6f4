/// \file Particles that bounce without loss in a mesh, with independent checks of their positions.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "claims/hard_meshes.h"
#include "ricochet/collision/collision_world.h"
#include "ricochet/collision/surfaces_in_time.h"
#include "ricochet/dynamics/flight.h"
#include "support/parity.h"

namespace ricochet::testing {

/// Results of a run.
struct BilliardTally {
    std::uint64_t contacts = 0;
    std::uint64_t stayed = 0;             ///< contacts after which the particle is at the start of its path
    std::uint64_t not_inside = 0;         ///< particles outside, or on the surface, at any check
    std::uint64_t checked_segments = 0;   ///< segments tested again by the exact reference
    std::uint64_t crossing_segments = 0;  ///< checked segments that intersect a triangle
    std::uint64_t budget_exhausted = 0;   ///< steps that exhausted their bounce budget
};

/// Mesh placed in the world, with its reference.
class Billiard {
public:
    Billiard(const NamedMesh& mesh, const Placement& placement);

    /// Returns points strictly inside, uniform in the volume (or in the bounding box of an open mesh). The same seed
    /// gives the same points.
    [[nodiscard]] std::vector<Vec3> start_points(int count, std::uint64_t seed) const;

    /// Flies in random directions, with about `impacts` impacts per step. `gravity` is in mean free paths per step
    /// squared (0: straight flight).
    [[nodiscard]] BilliardTally fly(int particles, int steps, double impacts, double gravity, IntegratorKind kind,
                                    std::uint64_t seed) const;

    /// Aims every flight at a vertex or a point of an edge. After an impact, the target is on the triangle just hit in
    /// two of three cases, or else on any triangle. Some flights end exactly there. The reference tests one segment in
    /// `check_every`.
    [[nodiscard]] BilliardTally aim(int particles, int impacts, int check_every, std::uint64_t seed) const;

    [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
    [[nodiscard]] bool is_closed() const { return oracle_ != nullptr; }

private:
    void check_legs(const std::vector<PathPoint>& chain, const Vec3& from, const Vec3& to, BilliardTally& tally) const;
    [[nodiscard]] bool may_be_at(const Vec3& point) const { return !oracle_ || oracle_->inside(point); }

    TriangleMesh mesh_;  // in world coordinates
    CollisionWorld world_;
    std::unique_ptr<ParityOracle> oracle_;  // null for an open mesh
    double mean_free_path_ = 0.0;
};

/// Returns true if the closed segment intersects a triangle of the mesh. The test is exact and independent of the
/// library's predicates and hierarchy. Its work is linear in the number of triangles.
[[nodiscard]] bool oracle_meets(const TriangleMesh& mesh, const Vec3& p, const Vec3& q);

}  // namespace ricochet::testing
