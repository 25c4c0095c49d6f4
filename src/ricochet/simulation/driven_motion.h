/// \file
/// Private to the simulation: dynamic bodies, which impulses of particles move, and their planned paths.
///
/// In a substep, bodies move along paths that are planned at its start, as if nothing hit them. Each impact is resolved
/// with the inverse mass and inertia of its body. At the end of the substep, all impulses are applied to the body, in
/// the order of particles. Many impulses together could add energy. The substep therefore ends before the first impact
/// that would add energy. A preview of the particles' motion gives the time of this impact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
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
    /// frames: with those of the bodies. colliders: empty if none moves. All arguments must outlive the object.
    BodyPaths(const std::vector<DrivenBody>& bodies, FrameTree* frames, MovingColliders& colliders,
              const ForceField& forces);

    /// Returns the paths of a body, from the oldest path that may still be needed to the planned path.
    [[nodiscard]] const std::vector<BodyPath>& of(std::size_t body) const { return frames_->paths(frame_of_[body]); }
    [[nodiscard]] const BodyPath& planned(std::size_t body) const { return of(body).back(); }
    /// Returns the load that the planned path of a body contains, in N and N m.
    [[nodiscard]] const Wrench& load(std::size_t body) const { return loads_[body]; }

    /// Plans the paths over [begin, end], in s, with a load on each body. Replaces a plan that was not followed.
    void plan(const std::vector<Wrench>& loads, double begin, double end);
    /// Ends the plan at an earlier time, in s.
    void end_at(double time);
    /// Marks the plan as followed.
    void set_followed() { is_planned_ = false; }
    /// Selects the substep that begins at a time, in s, for children, which repeat substeps. Returns its end, in s.
    double repeat(double time);
    /// Sets the time, in s, before which paths are no longer needed.
    void set_oldest(double time) { oldest_ = time; }

    /// Sets factors on the bodies' inverse masses and inertias, 1 beyond the list. Impacts that are too close in time
    /// to be separated share their effect: the body reacts to each of them as if all of them acted together.
    void set_shares(std::vector<double> shares);
    [[nodiscard]] const std::vector<double>& shares() const { return shares_; }
    /// Returns one empty impact tally per body, for its planned path.
    [[nodiscard]] std::vector<ImpactTally> no_impacts() const;
    /// Returns a view of loads. slow: largest speed of impacts that begin lasting contact, in m/s.
    [[nodiscard]] LoadsOnBodies loads_on_bodies(double slow) const { return {bodies_, collider_of_, colliders_, slow}; }

    /// Saves or restores the paths. a: an archive of core/binary_archive.h.
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
    /// Returns false if no run can produce the present state and paths of a body.
    [[nodiscard]] bool is_sound(std::size_t body) const;

private:
    void publish_velocity_jump(std::size_t body, std::size_t path) const;

    const std::vector<DrivenBody>& bodies_;
    std::vector<std::size_t> frame_of_;  // of each body
    std::vector<BodyId> collider_of_;    // per body: body id of its colliders
    FrameTree* frames_;
    MovingColliders* colliders_;
    const ForceField& forces_;
    std::vector<Wrench> loads_;   // per body: load in the planned path, N and N m
    std::vector<double> shares_;  // per body: factor on its inverse mass and inertia in this substep
    double oldest_ = 0.0;         // s
    bool is_planned_ = false;     // true if the last plan has not been followed yet
};

class DrivenMotion {
public:
    /// frames: contains the frames of the bodies; null without frames. colliders: contains the colliders of the bodies.
    /// All arguments must outlive the object. Throws InputError for invalid descriptions.
    DrivenMotion(std::vector<BodyDescription> bodies, FrameTree* frames, MovingColliders& colliders,
                 const ForceField& forces, const ResponseSettings& settings);

    [[nodiscard]] bool is_active() const { return !bodies_.empty(); }
    [[nodiscard]] const std::vector<DrivenBody>& bodies() const { return bodies_; }

    /// Returns the latest possible end, in s, of a substep from `begin` on; at most `end`, in s.
    [[nodiscard]] double next_substep_end(double begin, double end) const;
    /// Plans the bodies' paths over [begin, end], in s. Replaces a plan that was not followed. oldest: see BodyPaths.
    void plan(double begin, double end, double oldest);
    /// Returns the time, in s, at which impacts end the planned substep. preview: loads in it.
    [[nodiscard]] double cut_by(std::vector<ColliderLoad> preview) const;
    /// Plans the substep again if a load that rests on a body is heavy compared with the body. The new plan contains
    /// the resting loads of the preview, and ends earlier if they change a body's velocity by much. cut: result of
    /// cut_by(). round: number of earlier calls for this substep. Returns false if the plan, up to the cut, is
    /// accepted.
    [[nodiscard]] bool plan_again(std::span<const ColliderLoad> preview, double cut, int round);
    /// Returns the end of the plan, in s.
    [[nodiscard]] double planned_end() const { return paths_.planned(0).end; }
    /// Moves the bodies along their paths, and applies the loads of the substep.
    void follow(std::span<const ColliderLoad> loads);
    /// Applies loads of an earlier substep of the step.
    void take(std::span<const ColliderLoad> loads);
    /// Begins a step. The loads that rested on the bodies in the last step become planned loads.
    void begin_step();
    /// Returns the energy, in J, that a body gains by its change of velocity, in addition to ColliderLoad::work.
    [[nodiscard]] double work_by_yielding(const ColliderLoad& load) const;
    /// See BodyPaths::repeat().
    double repeat_substep(double time) { return paths_.repeat(time); }

    /// Saves or restores the motion of the bodies. a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        for (DrivenBody& body : bodies_) body.archive(a);
        paths_.archive(a);
        for (Wrench& wrench : resting_loads_) a(wrench.impulse), a(wrench.moment);
        for (BodyContacts& contacts : contacts_) archive_entries(a, contacts.now, [&](std::uint64_t& id) { a(id); });
        a(resting_time_);
        for (LoadRelaxation& relaxation : relaxations_) relaxation.archive(a);
        paths_.archive_plan(a);
        a(longest_substep_);
    }

    /// Returns false if no run can produce the present state of the bodies at a time, in s.
    [[nodiscard]] bool is_sound(double time) const;

private:
    /// Comparison of a planned load with the load that a preview of the plan returns.
    struct Fit {
        Wrench back;           // load of the preview, N and N m
        double longest = 1.0;  // fraction of the duration in which the load changes the body's motion by little
        bool fits = true;
        bool is_near = true;  // true if the difference of the loads changes the body's motion by little
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
    double slow_;              // m/s, largest speed of impacts that end bouncing
    double time_step_;         // s
    double shortest_substep_;  // s
    double longest_substep_ = std::numeric_limits<double>::infinity();  // s, largest duration of the next substep
    bool was_shortened_ = false;                                        // true if resting loads shortened this substep
    bool was_cut_ = false;                     // true if an impact has cut the last plan while loads rest on bodies
    bool has_given_up_ = false;                // true if no load fits in this substep
    std::vector<Wrench> loads_;                // per body: resting load for the next plan, N and N m
    std::vector<Wrench> resting_loads_;        // per body: impulse of lasting contact in this step, N s and N m s
    double resting_time_ = 0.0;                // s, duration of the substeps of this step so far
    std::vector<BodyContacts> contacts_;       // of each body
    std::vector<LoadRelaxation> relaxations_;  // of each body
    int substeps_ = 0;                         // number of substeps of this step so far
};

}  // namespace ricochet
