/// \file
/// An event-driven island: spheres that can touch each other, and no others. Impacts are solved in order of time.
///
/// Every member has a predicted path to the end of the step on which it meets no other member. The path consists of the
/// polynomial pieces along which the response moves the member, including bounces off walls and contact with them. The
/// first contact between two of these paths is an impact. Both members are moved to that time along the same paths,
/// exchange impulses, and get new paths. Source: B. D. Lubachevsky, "How to simulate billiards and similar systems", J.
/// Comput. Phys. 94 (1991).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/pair_meeting.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/coupled_member.h"
#include "ricochet/response/event_paths.h"
#include "ricochet/response/island_neighbours.h"
#include "ricochet/response/pair_impact.h"
#include "ricochet/response/pair_record.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// A member of an island. Inputs are given at the start of the step, outputs at its end.
struct IslandMember {
    std::size_t particle = 0;    ///< index in the particles' arrays
    MovingParticle moving;       ///< at the time moving.state.time
    double end = 0.0;            ///< s, end of its part of the step
    bool is_fixed = false;       ///< the member never moves
    bool is_free = false;        ///< it certainly touches no wall before it meets another member
    std::uint32_t material = 0;  ///< index in PairMaterials
    // Output:
    MoveOutcome outcome{};
    MoveLists lists{};
    std::uint32_t impacts = 0;    ///< number of impacts on other members
    Vec3 pair_velocity_change{};  ///< m/s, by impacts and contact with other members
    bool is_planned = false;      ///< its motion was planned by a contact island
    double contact_path = 0.0;    ///< m, length of the part of its trajectory in contact with walls
    bool is_cut_off = false;      ///< it has spent its impact budget
    Box3 swept{};                 ///< bounding box of the whole sphere on its whole trajectory
    bool keeps_path = false;      ///< input: `trajectory` is needed even if the member stays within its declared bounds
    bool has_left_bounds = false;          ///< it may be outside its declared bounds: it has met others, or is coupled
    std::vector<FlownPiece> trajectory{};  ///< whole trajectory, if has_left_bounds or keeps_path

    /// Appends a part of the trajectory after the member has left its bounds.
    void append_off_bounds(const std::vector<FlownPiece>& flown) {
        trajectory.insert(trajectory.end(), flown.begin(), flown.end());
        has_left_bounds = !trajectory.empty();
    }
    /// Returns true if the member no longer moves: it is absorbed or frozen.
    [[nodiscard]] bool is_gone() const { return outcome.is_absorbed() || outcome.is_frozen(); }
    /// Returns the rest of its part of the step, in s: at the start of a planned flight exactly the flight's duration.
    [[nodiscard]] double time_left() const {
        const bool begins_flight = moving.planned != nullptr && moving.planned->start.time == moving.state.time;
        return begins_flight ? moving.planned->path.duration : end - moving.state.time;
    }
    /// Returns the radius for other members, in m: that of the whole sphere, even if only a core collides with walls.
    [[nodiscard]] double radius() const {
        return moving.state.whole_radius > 0.0 ? moving.state.whole_radius : moving.state.radius;
    }
};

/// Limits of single impacts. An island that exceeds them is handed over: its contacts last, so the rest of the step is
/// one contact problem.
struct ImpactLimit {
    std::uint32_t budget = std::numeric_limits<std::uint32_t>::max();   ///< impacts of one member before it stops
    std::uint32_t of_each = std::numeric_limits<std::uint32_t>::max();  ///< impacts of one member in the step
    bool allows_sinking = true;   ///< false: handed over at the time from which forces drive members into each other
    bool allows_pressing = true;  ///< false: handed over at the start if forces press together two members that touch
    bool keeps_impacts = true;    ///< false: handed over at the start of the step, without its impacts
};

/// Solves event-driven islands, one after another, and reuses its memory. For one thread.
class EventIsland {
public:
    /// The response and the materials must outlive the object.
    EventIsland(const Response& response, const PairMaterials& materials)
        : response_(response), materials_(materials) {}

    /// Moves the members to the end of the step. The result does not depend on their order, except for the last bits of
    /// impacts that share members. scratch: selects the records to write; its lists are overwritten. If `limit` is
    /// exceeded, returns the time, in s, at which the island is handed over. The members have then been moved to this
    /// time. It is kStartOfStep if they have not been moved.
    std::optional<double> run(std::vector<IslandMember>& members, MoveScratch& scratch, const ImpactLimit& limit = {});
    static constexpr double kStartOfStep = -std::numeric_limits<double>::infinity();

    /// Returns the impacts of the last run, in order of time.
    [[nodiscard]] const std::vector<PairImpactRecord>& impacts() const { return impacts_; }
    /// Returns the impacts for the verifier, if motions are recorded.
    [[nodiscard]] const std::vector<PairMeeting>& meetings() const { return meetings_; }

private:
    /// Motion of a member until the end of the step if it meets no other member.
    struct Prediction {
        MovingParticle moved;
        MoveOutcome outcome;
        MoveLists lists;
        std::vector<FlownPiece> flown;
    };

    /// Impacts of a member on the same partner that follow each other without parting.
    struct Repetition {
        std::size_t partner = std::numeric_limits<std::size_t>::max();
        std::uint32_t count = 0;
        double time = 0.0;  ///< s, of the last impact
    };

    void begin(std::vector<IslandMember>& members, MoveScratch& scratch);
    std::optional<double> solve(std::vector<IslandMember>& members, MoveScratch& scratch, const ImpactLimit& limit);
    void resolve_until(double last, const ImpactLimit& limit);
    [[nodiscard]] std::optional<double> time_of_handover(const ImpactLimit& limit) const;
    void predict(std::size_t m);
    void stay(std::size_t m);
    void fly_freely(IslandMember& member, double duration);
    void bring(std::size_t m, double time);
    [[nodiscard]] bool is_missed(const PairContact& contact, double time) const;
    [[nodiscard]] bool is_still(std::size_t m) const {
        const IslandMember& member = (*members_)[m];
        return member.is_fixed || member.is_cut_off || member.is_gone();
    }
    void go_to(std::size_t m, double time);
    [[nodiscard]] bool bounces_at(std::size_t m, double time) const;
    void commit(std::size_t m);
    void note(std::size_t m, double time, std::size_t partner);
    void note_meeting(std::size_t m, std::size_t other);
    void find_all();
    void find_next(std::size_t m);
    void predict_anew(const std::vector<std::size_t>& changed);
    [[nodiscard]] std::optional<double> meeting_of(std::size_t a, std::size_t b) const;
    [[nodiscard]] PhaseState state_of(std::size_t m, double time) const;
    [[nodiscard]] std::vector<PairContact> contacts_at(double time) const;
    void keep_fastest(std::vector<PairContact>& contacts, double time) const;
    void resolve(std::vector<PairContact>& contacts, double time);
    void write_back(std::size_t m, const PairBody& body);
    void go_on(std::size_t m);
    void resume(std::size_t m);
    void record(const PairContact& contact, const std::vector<std::size_t>& changed,
                const std::vector<PairBody>& before, const std::vector<PairBody>& after, double time);
    void record_meeting(std::span<const PairContact> contacts, const std::vector<std::size_t>& changed,
                        const std::vector<PairBody>& before, const std::vector<PairBody>& after, double time);
    [[nodiscard]] bool exceeds(const ImpactLimit& limit) const {
        return most_of_one_ > limit.of_each || (!limit.allows_sinking && is_pressed_);
    }
    void count_repetition(const PairContact& contact, double time);
    [[nodiscard]] std::optional<double> time_of_sinking() const;
    [[nodiscard]] bool presses() const;
    template <class Visit>
    void visit_sunk_pairs(const Visit& visit) const;

    const Response& response_;
    const PairMaterials& materials_;
    std::uint32_t budget_ = 0;  // ImpactLimit::budget
    std::vector<IslandMember>* members_ = nullptr;
    MoveScratch* scratch_ = nullptr;
    std::vector<Prediction> predictions_;
    std::vector<IslandMember> start_;    // the members at the start, if the run may be repeated
    std::vector<double> changed_at_;     // s, time of the last impact of each member; kStartOfStep without one
    double last_impact_ = kStartOfStep;  // s
    std::vector<Box3> boxes_;            // bounding boxes of the predictions
    IslandNeighbours neighbours_;
    EarliestTime times_;                 // s, first contact of each member; infinite without one
    std::vector<std::size_t> partners_;  // other member of each of these contacts
    std::vector<Repetition> repeated_;   // one per member
    std::uint32_t most_of_one_ = 0;      // largest number of impacts of one member
    bool is_pressed_ = false;            // forces press a pair together: its impacts repeat too often
    std::vector<Flight> resumed_;        // one per member, if a kick has acted in this step
    std::vector<PairImpactRecord> impacts_;
    std::vector<PairMeeting> meetings_;
};

}  // namespace ricochet
