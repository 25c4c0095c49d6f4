/// \file Particles that bounce elastically in a mesh, with independent checks of their positions.
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
    std::uint64_t stayed = 0;             ///< contacts at which the particle did not move
    std::uint64_t not_inside = 0;         ///< particles that were outside or on the surface at some check
    std::uint64_t checked_segments = 0;   ///< segments that the exact reference tested
    std::uint64_t crossing_segments = 0;  ///< checked segments that intersect a triangle
    std::uint64_t budget_exhausted = 0;   ///< steps that exhausted their bounce budget
};

/// A mesh placed in the world, with an exact reference.
class Billiard {
public:
    Billiard(const NamedMesh& mesh, const Placement& placement);

    /// Returns points strictly inside, uniform in the volume (or in the bounding box of an open mesh). The same seed
    /// gives the same points.
    [[nodiscard]] std::vector<Vec3> start_points(int count, std::uint64_t seed) const;

    /// Lets particles fly in random directions, with about `impacts` impacts per step. `gravity` is an acceleration in
    /// mean free paths per step squared; 0 gives straight flights.
    [[nodiscard]] BilliardTally fly(int particles, int steps, double impacts, double gravity, IntegratorKind kind,
                                    std::uint64_t seed) const;

    /// Aims every flight at a vertex or at a point of an edge. After an impact, two of three targets are on the
    /// triangle just hit. Other targets are on a random triangle. Some flights end exactly at the target. The reference
    /// tests the segments of one flight in `check_every`.
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
/// library's predicates and BVH. Its time is linear in the number of triangles.
[[nodiscard]] bool oracle_meets(const TriangleMesh& mesh, const Vec3& p, const Vec3& q);

}  // namespace ricochet::testing
