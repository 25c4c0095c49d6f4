/// \file
/// What a run's frames hold: particles and colliders as VTK data.
#pragma once

#include "ricochet/collision/collider.h"
#include "ricochet/core/box3.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/io/vtk.h"
#include "ricochet/simulation.h"

namespace ricochet {

// Where lists that belong together have other lengths, or name what is not there: InputError.

/// The particles at a time, in the order of their ids, with the arrays id, velocity, mass, radius, age, contacts,
/// resting, frozen and unsimulated_time, and with spin where `has_spheres` says so: all frames of a series must agree
/// on it, see Simulation::has_spheres().
[[nodiscard]] VtkPolyData particle_frame(const Particles& particles, double time, bool has_spheres = false);
/// The same with an array for every attribute, as it is shown (Simulation::shown_attributes()).
[[nodiscard]] VtkPolyData particle_frame(const Particles& particles, const AttributeTable& attributes, double time,
                                         bool has_spheres = false);
/// The same, reusing the memory of a frame that is no longer needed: allocation is most of the cost of a frame.
void fill_particle_frame(VtkPolyData& frame, const Particles& particles, const AttributeTable& attributes, double time,
                         bool has_spheres);

/// Adds the array cloud_parent to a frame of these particles: Simulation::cloud_parents().
void add_cloud_parents(VtkPolyData& frame, const Particles& particles, const std::vector<std::int64_t>& parents);

/// Adds the intact springs to a frame of these particles: as triangles where all three springs of a piece of cloth are
/// intact, as lines otherwise; springs that only resist bending are not shown. Cell arrays: spring (its number, -1 for
/// triangles and points) and stretch (length over rest length minus 1; of a triangle the largest of its springs; 0
/// where there is no rest length).
void add_springs(VtkPolyData& frame, const Particles& particles, const SpringNetwork& springs,
                 const std::vector<SpringFace>& faces);

/// A mesh in world coordinates with the cell arrays hits, impulse and lasting_impulse (N s); without them when the
/// totals are empty.
[[nodiscard]] VtkPolyData mesh_collider_frame(const TriangleMesh& mesh, const TriangleTotals& totals, double time);

/// A plane as a square of two triangles around the foot point of the region's centre, its edge four times the region's
/// diagonal (at least 2 m), with the fields plane_point and plane_normal (of unit length). Both triangles carry the
/// plane's totals; there are no arrays when the totals are empty.
[[nodiscard]] VtkPolyData plane_collider_frame(const PlaneShape& plane, const Box3& region,
                                               const TriangleTotals& totals, double time);

/// The colliders that move as they stand now, as one mesh; the array `collider` of its triangles says which each
/// belongs to. region: as of plane_collider_frame().
[[nodiscard]] VtkPolyData moving_collider_frame(const Simulation& simulation, const Box3& region);
/// True for a collider that stands in a frame, or deforms.
[[nodiscard]] bool is_moving(const ColliderDescription& collider);

}  // namespace ricochet
