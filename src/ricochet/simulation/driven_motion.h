/// \file
/// Private to the simulation: the bodies that impulses of particles move.
///
/// In a part of a step the bodies move as planned at its begin, as if nothing hit them; each impact is answered with
/// what its body yields. At the part's end a body takes all impulses of it, in the order of particles. So that many of
/// them together put no energy in, the part is cut before the first impact that would: a preview says when that is.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/mobility.h"
#include "ricochet/dynamics/driven_body.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/impact_tally.h"
#include "ricochet/simulation/load_relaxation.h"
#include "ricochet/simulation/loads_on_bodies.h"

namespace ricochet {

class DrivenMotion {
public:
    /// frames and colliders: in which the bodies move; null where there are none. All must outlive it. Throws
    /// InputError for descriptions that cannot be.
    DrivenMotion(std::vector<BodyDescription> bodies, FrameTree* frames, MovingColliders* colliders,
                 const ForceField& forces, const ResponseSettings& settings);

    [[nodiscard]] bool is_active() const { return !bodies_.empty(); }
    [[nodiscard]] const std::vector<DrivenBody>& bodies() const { return bodies_; }

    /// When the part that begins at a time has to end, s, at the latest; not after `end`, s.
    [[nodiscard]] double next_substep_end(double begin, double end) const;
    /// Plans the bodies' paths over [begin, end], s, instead of what was planned last and not followed. Nothing asks
    /// for where they were before `oldest`, s, any more.
    void plan(double begin, double end, double oldest);
    /// When the planned part has to end, s, where these are the loads on the bodies in it.
    [[nodiscard]] double cut_by(std::vector<ColliderLoad> preview) const;
    /// What is planned ends at an earlier time, s.
    void end_at(double time);
    /// Where what lies on a body is heavy beside it: plans the part once more with the load that a preview of it shows,
    /// and ends it earlier where that load would change the body's velocity by much. cut: of cut_by(); round: how often
    /// this part has been planned again. False when the plan fits; it ends at the cut then.
    [[nodiscard]] bool plan_again(std::span<const ColliderLoad> preview, double cut, int round);
    /// When what is planned ends, s.
    [[nodiscard]] double planned_end() const { return planned(0).end; }
    /// The bodies go along their paths, and take the loads of that time.
    void follow(std::span<const ColliderLoad> loads);
    /// They take loads of an earlier part of the step.
    void take(std::span<const ColliderLoad> loads);
    /// To be called at the begin of a step: what has lain on the bodies in the last one lies on them in this one, too.
    void begin_step();
    /// J, that a body takes from a load besides ColliderLoad::work: by what it yields meanwhile.
    [[nodiscard]] double became_dynamic(const ColliderLoad& load) const;
    /// For what is moved through this step once more: the part that begins at a time. Returns when it ends, s.
    double repeat_substep(double time);

    /// Saves or restores how they move; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        for (DrivenBody& body : bodies_) body.archive(a);
        for (const std::size_t frame : frame_of_) {
            std::vector<BodyPath> paths = frames_->paths(frame);
            archive_entries(a, paths, [&](BodyPath& path) { path.archive(a); });
            if (!paths.empty()) frames_->set_paths(frame, std::move(paths));
        }
        for (Wrench& wrench : resting_loads_) a(wrench.impulse), a(wrench.moment);
        for (BodyContacts& contacts : contacts_) archive_entries(a, contacts.now, [&](std::uint64_t& id) { a(id); });
        a(resting_time_);
        for (LoadRelaxation& relaxation : relaxations_) relaxation.archive(a);
        a(is_planned_), a(longest_part_);
    }

    /// Returns false for bodies that no run leaves behind at a time, s.
    [[nodiscard]] bool is_sound(double time) const;

private:
    /// How the load of a plan fits to what came back from it.
    struct Fit {
        Wrench back;           // N, N m
        double longest = 1.0;  // part of the duration in which the load changes the body's motion by little
        bool fits = true;
        bool is_near = true;  // so that the body's motion changes by little where it takes what was not planned
    };

    /// Of a body, as far back as may be asked for; the last is planned.
    [[nodiscard]] const std::vector<BodyPath>& paths_of(std::size_t body) const {
        return frames_->paths(frame_of_[body]);
    }
    [[nodiscard]] const BodyPath& planned(std::size_t body) const { return paths_of(body).back(); }
    [[nodiscard]] bool has_sound_paths(std::size_t body) const;
    [[nodiscard]] std::vector<ImpactTally> no_impacts() const;
    void plan_paths(double begin, double end);
    void set_shares(std::vector<double> shares);
    [[nodiscard]] std::vector<double> shares_of(std::span<const ColliderLoad> preview, double end) const;
    void publish_velocity_jump(std::size_t body, std::size_t path) const;
    [[nodiscard]] LoadsOnBodies loads_on_bodies() const { return {bodies_, collider_of_, colliders_, slow_}; }
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
    std::vector<std::size_t> frame_of_;  // of each body
    std::vector<BodyId> collider_of_;    // of each body: its colliders
    FrameTree* frames_;
    MovingColliders* colliders_;
    const ForceField& forces_;
    double slow_;                                                    // m/s, of impacts that end bounces
    double time_step_;                                               // s
    double shortest_part_;                                           // s
    double longest_part_ = std::numeric_limits<double>::infinity();  // s, of the next part
    bool was_shortened_ = false;                                     // this part, by what lies on bodies
    bool was_cut_ = false;                // the last plan of this part, by an impact on what lies on bodies
    bool has_given_up_ = false;           // this part: no load fits
    std::vector<Wrench> loads_;           // of each body, N and N m: what lies on it, as it will be planned next
    std::vector<Wrench> planned_loads_;   // with which the planned paths were planned
    std::vector<Wrench> resting_loads_;   // of each body, N s and N m s, of contact that lasted in this step so far
    double resting_time_ = 0.0;           // s, of this step so far
    std::vector<BodyContacts> contacts_;  // of each body
    std::vector<LoadRelaxation> relaxations_;  // of each body
    std::vector<double> shares_;               // of each body: how many times as much it yields in this part
    double oldest_ = 0.0;                      // s, of plan()
    int parts_ = 0;                            // of this step so far
    bool is_planned_ = false;                  // the last of them has not been followed
};

}  // namespace ricochet
