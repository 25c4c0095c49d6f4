/// \file
/// Output frames of a run: particles and colliders as VTK data.
#pragma once

#include "ricochet/collision/collider.h"
#include "ricochet/core/box3.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/io/vtk.h"
#include "ricochet/simulation.h"

namespace ricochet {

// All functions throw InputError if related lists differ in length or refer to missing entries.

/// Returns the particles at a time, in the order of their ids. The arrays are id, velocity, mass, radius, age,
/// contacts, resting, frozen and unsimulated_time. If `has_spheres` is true, there is also the array spin. All frames
/// of a series must use the same value of `has_spheres`, see Simulation::has_spheres().
[[nodiscard]] VtkPolyData particle_frame(const Particles& particles, double time, bool has_spheres = false);
/// Returns the particles at a time, in the order of their ids, with an additional array for every attribute.
/// attributes: see Simulation::shown_attributes().
[[nodiscard]] VtkPolyData particle_frame(const Particles& particles, const AttributeTable& attributes, double time,
                                         bool has_spheres = false);
/// Fills a frame like particle_frame() and reuses its memory, because most of the cost of a new frame is memory
/// allocation.
void fill_particle_frame(VtkPolyData& frame, const Particles& particles, const AttributeTable& attributes, double time,
                         bool has_spheres);

/// Adds the array cloud_parent to a frame of these particles.
/// parents: see Simulation::cloud_parents().
void add_cloud_parents(VtkPolyData& frame, const Particles& particles, const std::vector<std::int64_t>& parents);

/// Adds the intact springs to a frame of these particles. A face of cloth becomes a triangle if its three springs are
/// intact. Springs that only resist bending are omitted. All other springs become lines. The cell arrays are:
/// - spring: number of the spring; -1 for triangles and points.
/// - stretch: length divided by rest length, minus 1. A triangle has the largest value of its springs. The value is 0
///   if the rest length is 0.
void add_springs(VtkPolyData& frame, const Particles& particles, const SpringNetwork& springs,
                 const std::vector<SpringFace>& faces);

/// Returns a mesh in world coordinates with the cell arrays hits, impulse and lasting_impulse (N s). The arrays are
/// omitted if the totals are empty.
[[nodiscard]] VtkPolyData mesh_collider_frame(const TriangleMesh& mesh, const TriangleTotals& totals, double time);

/// Returns a plane as a square of two triangles, with the fields plane_point and plane_normal (unit length). The square
/// is centred at the projection of the region's centre onto the plane. Its edge is four times the region's diagonal, at
/// least 2 m. Both triangles have the plane's totals. The arrays are omitted if the totals are empty.
[[nodiscard]] VtkPolyData plane_collider_frame(const PlaneShape& plane, const Box3& region,
                                               const TriangleTotals& totals, double time);

/// Returns the moving colliders at their current positions, as one mesh. The cell array `collider` contains the
/// collider index of each triangle. region: see plane_collider_frame().
[[nodiscard]] VtkPolyData moving_collider_frame(const Simulation& simulation, const Box3& region);
/// Returns true if the collider is attached to a reference frame or deforms.
[[nodiscard]] bool is_moving(const ColliderDescription& collider);

}  // namespace ricochet
