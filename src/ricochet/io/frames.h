/// \file
/// Frames of a run: particles and colliders as VTK data.
#pragma once

#include "ricochet/collision/collider.h"
#include "ricochet/core/box3.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/io/vtk.h"
#include "ricochet/simulation.h"

namespace ricochet {

// All functions throw InputError if related lists differ in length or refer to missing entries.

/// Returns the particles at a time, in the order of their ids.
/// Arrays: id, velocity, mass, radius, age, contacts, resting, frozen and unsimulated_time, and also spin if
/// `has_spheres` is true. All frames of a series must use the same value; see Simulation::has_spheres().
[[nodiscard]] VtkPolyData particle_frame(const Particles& particles, double time, bool has_spheres = false);
/// Returns the same frame with an additional array for every attribute.
/// attributes: see Simulation::shown_attributes().
[[nodiscard]] VtkPolyData particle_frame(const Particles& particles, const AttributeTable& attributes, double time,
                                         bool has_spheres = false);
/// Fills a frame and reuses its memory, because allocation is most of the cost of a frame.
void fill_particle_frame(VtkPolyData& frame, const Particles& particles, const AttributeTable& attributes, double time,
                         bool has_spheres);

/// Adds the array cloud_parent to a frame of these particles.
/// parents: see Simulation::cloud_parents().
void add_cloud_parents(VtkPolyData& frame, const Particles& particles, const std::vector<std::int64_t>& parents);

/// Adds the intact springs to a frame of these particles.
/// A piece of cloth becomes a triangle if its three springs are intact; all other springs become lines. Springs that
/// only resist bending are left out. Cell arrays:
/// - spring: number of the spring; -1 for triangles and points.
/// - stretch: length over rest length minus 1; for a triangle the largest value of its springs; 0 without a rest
///   length.
void add_springs(VtkPolyData& frame, const Particles& particles, const SpringNetwork& springs,
                 const std::vector<SpringFace>& faces);

/// Returns a mesh in world coordinates with the cell arrays hits, impulse and lasting_impulse (N s). The arrays are
/// left out if the totals are empty.
[[nodiscard]] VtkPolyData mesh_collider_frame(const TriangleMesh& mesh, const TriangleTotals& totals, double time);

/// Returns a plane as a square of two triangles, with the fields plane_point and plane_normal (unit length).
/// The square is centred at the projection of the region's centre onto the plane. Its edge is four times the region's
/// diagonal, at least 2 m. Both triangles carry the plane's totals; the arrays are left out if the totals are empty.
[[nodiscard]] VtkPolyData plane_collider_frame(const PlaneShape& plane, const Box3& region,
                                               const TriangleTotals& totals, double time);

/// Returns the moving colliders at their current positions, as one mesh. The cell array `collider` gives the collider
/// index of each triangle.
/// region: see plane_collider_frame().
[[nodiscard]] VtkPolyData moving_collider_frame(const Simulation& simulation, const Box3& region);
/// Returns true if the collider is attached to a reference frame or deforms.
[[nodiscard]] bool is_moving(const ColliderDescription& collider);

}  // namespace ricochet
