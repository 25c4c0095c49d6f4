/// \file
/// Private to the simulation: the bodies that impulses of particles move, and their planned paths.
///
/// In a substep the bodies move as planned at its start, as if nothing hit them. Each impact is resolved with the
/// inverse mass and inertia of its body. At the end of the substep a body takes all its impulses, in the order of
/// particles. Many impulses together could add energy, so the substep is cut before the first impact that would. A
/// preview gives that time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/binary_archive.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/mobility.h"
#include "ricochet/dynamics/driven_body.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/impact_tally.h"
#include "ricochet/simulation/loads_on_bodies.h"

namespace ricochet {

/// Paths of bodies in the frame tree, and the mobility of their colliders. All bodies have the same substeps.
class BodyPaths {
public:
    /// frames: contains the frames of the bodies. colliders: null if no collider moves. All must outlive it.
    BodyPaths(const std::vector<DrivenBody>& bodies, FrameTree* frames, MovingColliders& colliders,
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
    /// Returns false for a body and paths that no run leaves behind.
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

class DrivenMotion {
public:
    /// frames and colliders: contain the bodies' frames and colliders; null if there are none. All must outlive it.
    /// Throws InputError for invalid descriptions.
    DrivenMotion(std::vector<BodyDescription> bodies, FrameTree* frames, MovingColliders& colliders,
                 const ForceField& forces, const ResponseSettings& settings);

    [[nodiscard]] bool is_active() const { return !bodies_.empty(); }
    [[nodiscard]] const std::vector<DrivenBody>& bodies() const { return bodies_; }

    /// Returns the latest end, in s, of a substep that begins at a time; at most `end`, in s.
    [[nodiscard]] double next_substep_end(double begin, double end) const;
    /// Plans the bodies' paths over [begin, end], in s. They replace a plan that was not followed. Paths before
    /// `oldest`, in s, are no longer needed.
    void plan(double begin, double end, double oldest);
    /// Returns the time, in s, at which the planned substep must end if these are the loads on the bodies in it.
    [[nodiscard]] double cut_by(std::vector<ColliderLoad> preview) const;
    /// Plans the substep again if a load that rests on a body is heavy compared with it. The new plan contains the load
    /// of a preview. It ends earlier if that load would change the body's velocity by much. cut: result of cut_by().
    /// round: number of earlier calls for this substep. Returns false if the plan is kept, which then ends at the cut.
    [[nodiscard]] bool plan_again(std::span<const ColliderLoad> preview, double cut, int round);
    /// Returns the end of the plan, in s.
    [[nodiscard]] double planned_end() const { return paths_.planned(0).end; }
    /// Moves the bodies along their paths, and applies the loads of that time.
    void follow(std::span<const ColliderLoad> loads);
    /// Applies loads of an earlier substep of the step.
    void take(std::span<const ColliderLoad> loads);
    /// Must be called at the start of a step. The loads that rested on the bodies in the last step become planned
    /// loads.
    void begin_step();
    /// Returns the energy, in J, that a body gets from a load in addition to ColliderLoad::work, because the load
    /// changes its velocity.
    [[nodiscard]] double work_by_yielding(const ColliderLoad& load) const;
    /// Selects the substep that begins at a time, in s, for particles that move through this step later. Returns its
    /// end, in s.
    double repeat_substep(double time) { return paths_.repeat(time); }

    /// Saves or restores the motion of the bodies; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        for (DrivenBody& body : bodies_) body.archive(a);
        paths_.archive(a);
        for (Wrench& wrench : resting_loads_) a(wrench.impulse), a(wrench.moment);
        for (BodyContacts& contacts : contacts_) archive_entries(a, contacts.now, [&](std::uint64_t& id) { a(id); });
        a(resting_time_);
        for (LoadRelaxation& relaxation : relaxations_) relaxation.archive(a);
        paths_.archive_plan(a);
        a(longest_part_);
    }

    /// Returns false if no run leaves the bodies in this state at a time, in s.
    [[nodiscard]] bool is_sound(double time) const;

private:
    /// Comparison of a planned load with the load that a preview of the plan gives.
    struct Fit {
        Wrench back;           // load of the preview, N, N m
        double longest = 1.0;  // part of the duration in which the load changes the body's motion by little
        bool fits = true;
        bool is_near = true;  // the difference of the loads changes the body's motion by little
    };

    [[nodiscard]] std::vector<double> shares_of(std::span<const ColliderLoad> preview, double end) const;
    [[nodiscard]] LoadsOnBodies loads_on_bodies() const { return paths_.loads_on_bodies(slow_); }
    [[nodiscard]] RestingLoad resting_load_on(std::size_t body, std::span<const ColliderLoad> preview,
                                              double until) const;
    [[nodiscard]] bool begin_round(std::span<const ColliderLoad> preview, double end, int round);
    [[nodiscard]] bool is_cut_in_contact(std::span<const ColliderLoad> preview, double end) const;
    [[nodiscard]] double substep_with_load(std::size_t body, std::span<const ColliderLoad> preview, double begin,
                                           double duration) const;
    [[nodiscard]] double end_of_waits(std::span<const ColliderLoad> preview, double end) const;
    [[nodiscard]] double most_change(std::size_t body) const;
    [[nodiscard]] double change_by(std::size_t body, const Wrench& load, double duration) const;
    [[nodiscard]] bool gains_energy(std::size_t body, std::span<const ColliderLoad> preview, double end) const;
    void accept(std::span<const ColliderLoad> preview, double end);
    [[nodiscard]] bool plan_without_loads(std::span<const ColliderLoad> preview, double begin, double end);
    void limit_next_substep(double duration);
    [[nodiscard]] Fit fit_of(std::size_t body, const RestingLoad& resting_load, double duration) const;

    std::vector<DrivenBody> bodies_;
    BodyPaths paths_;
    double slow_;                                                    // m/s, of impacts that end bounces
    double time_step_;                                               // s
    double shortest_part_;                                           // s
    double longest_part_ = std::numeric_limits<double>::infinity();  // s, of the next substep
    bool was_shortened_ = false;                                     // this substep, because of resting loads
    bool was_cut_ = false;                     // the last plan of this substep, by an impact while loads rest on bodies
    bool has_given_up_ = false;                // no load fits in this substep
    std::vector<Wrench> loads_;                // of each body, N and N m: resting load for the next plan
    std::vector<Wrench> resting_loads_;        // of each body, N s and N m s, by lasting contact in this step so far
    double resting_time_ = 0.0;                // s, of this step so far
    std::vector<BodyContacts> contacts_;       // of each body
    std::vector<LoadRelaxation> relaxations_;  // of each body
    int parts_ = 0;                            // substeps of this step so far
};

}  // namespace ricochet
