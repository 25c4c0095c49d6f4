/// \file
/// Private to the simulation: the planned paths of bodies that impulses of particles move.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/binary_archive.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/mobility.h"
#include "ricochet/dynamics/driven_body.h"
#include "ricochet/simulation/impact_tally.h"
#include "ricochet/simulation/loads_on_bodies.h"

namespace ricochet {

/// Paths of bodies in the frame tree, and the mobility of their colliders. All bodies have the same substeps.
class BodyPaths {
public:
    /// frames: contains the frames of the bodies. colliders: null if no collider moves. All must outlive it.
    BodyPaths(const std::vector<DrivenBody>& bodies, FrameTree* frames, MovingColliders* colliders,
              const ForceField& forces);

    /// Returns the paths of a body, as far back as they may be needed. The last one is planned.
    [[nodiscard]] const std::vector<BodyPath>& of(std::size_t body) const { return frames_->paths(frame_of_[body]); }
    [[nodiscard]] const BodyPath& planned(std::size_t body) const { return of(body).back(); }
    /// Returns the load in the planned path of a body, in N and N m.
    [[nodiscard]] const Wrench& load(std::size_t body) const { return loads_[body]; }

    /// Plans the paths over [begin, end], in s, with a load on each body. They replace a plan that was not followed.
    void plan(const std::vector<Wrench>& loads, double begin, double end);
    /// Ends the plan at an earlier time, in s.
    void end_at(double time);
    /// Marks the plan as followed.
    void set_followed() { is_planned_ = false; }
    /// Selects the substep that begins at a time, in s, for particles that move through this step later. Returns its
    /// end, in s.
    double repeat(double time);
    /// Paths before a time, in s, are no longer needed.
    void set_oldest(double time) { oldest_ = time; }

    /// Sets factors on the bodies' inverse masses and inertias. Impacts at one time, or too near in time to be told
    /// apart, share their effect: the body reacts to each of them as to all together. An empty list: all are 1.
    void set_shares(std::vector<double> shares);
    [[nodiscard]] const std::vector<double>& shares() const { return shares_; }
    /// Returns tallies without impacts for the planned paths.
    [[nodiscard]] std::vector<ImpactTally> no_impacts() const;
    /// Returns a view of loads. slow: speed of impacts that begin contact, in m/s.
    [[nodiscard]] LoadsOnBodies loads_on_bodies(double slow) const { return {bodies_, collider_of_, colliders_, slow}; }

    /// Saves or restores the paths; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        for (const std::size_t frame : frame_of_) {
            std::vector<BodyPath> paths = frames_->paths(frame);
            archive_entries(a, paths, [&](BodyPath& path) { path.archive(a); });
            if (!paths.empty()) frames_->set_paths(frame, std::move(paths));
        }
    }
    template <class Archive>
    void archive_plan(Archive& a) {
        a(is_planned_);
    }
    /// Returns false for paths of a body that no run leaves behind.
    [[nodiscard]] bool is_sound(std::size_t body) const;

private:
    void publish_velocity_jump(std::size_t body, std::size_t path) const;

    const std::vector<DrivenBody>& bodies_;
    std::vector<std::size_t> frame_of_;  // of each body
    std::vector<BodyId> collider_of_;    // of each body: its colliders
    FrameTree* frames_;
    MovingColliders* colliders_;
    const ForceField& forces_;
    std::vector<Wrench> loads_;   // of each body, N and N m, in the planned paths
    std::vector<double> shares_;  // of each body: factor on its inverse mass and inertia in this substep
    double oldest_ = 0.0;         // s
    bool is_planned_ = false;     // the last plan has not been followed
};

}  // namespace ricochet
