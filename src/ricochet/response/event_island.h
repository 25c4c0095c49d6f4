/// \file
/// An island: spheres that may meet each other in a step, and no others. Its impacts are solved in order of time.
///
/// Every member has its true path to the end of the step, as if it met none of the others: the polynomial pieces that
/// the response has moved it along, bounces off walls and contact with them included. The first meeting of two of those
/// paths is an impact: both are moved to that time along the same paths, exchange impulses, and are moved on anew.
/// Source: B. D. Lubachevsky, "How to simulate billiards and similar systems", J. Comput. Phys. 94 (1991).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/pair_meeting.h"
#include "ricochet/dynamics/coupled_member.h"
#include "ricochet/response/event_paths.h"
#include "ricochet/response/island_neighbours.h"
#include "ricochet/response/move_lists.h"
#include "ricochet/response/pair_impact.h"
#include "ricochet/response/pair_record.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// A member of an island. Inputs hold for the start of the step, outputs for its end.
struct IslandMember {
    std::size_t particle = 0;    ///< its number in the particles' arrays
    MovingParticle moving;       ///< at the time moving.state.time
    double end = 0.0;            ///< s, of its part of the step
    bool is_fixed = false;       ///< nothing moves it
    bool is_free = false;        ///< as long as it meets none of the others it certainly touches no wall
    std::uint32_t material = 0;  ///< its number among PairMaterials
    // Out:
    MoveOutcome outcome{};
    MoveLists lists{};
    std::uint32_t impacts = 0;    ///< on other members
    Vec3 pair_velocity_change{};  ///< m/s, that others have given it by impacts and contact
    bool is_planned = false;      ///< by the problem of all contacts of its island
    double contact_path = 0.0;    ///< m, of its way that was along walls, in arcs
    bool is_cut_off = false;      ///< it has spent its budget
    Box3 swept{};                 ///< of the whole sphere on all of its way
    /// All of its way, where it has met others, or others act on it from afar.
    std::vector<FlownPiece> trajectory{};

    /// It has ended before the step.
    [[nodiscard]] bool is_gone() const { return outcome.is_absorbed() || outcome.is_frozen(); }
    /// s, that its part of the step has left: as long as its planned flight to the last bit, where it sets out on that.
    [[nodiscard]] double time_left() const {
        const bool begins_flight = moving.planned != nullptr && moving.planned->start.time == moving.state.time;
        return begins_flight ? moving.planned->path.duration : end - moving.state.time;
    }
    /// m, as others meet it: that of the whole sphere also where it collides with walls as a core.
    [[nodiscard]] double radius() const {
        return moving.state.whole_radius > 0.0 ? moving.state.whole_radius : moving.state.radius;
    }
};

/// Impacts of members of an island on each other in a step beyond which it is given up.
struct ImpactLimit {
    std::size_t in_all = std::numeric_limits<std::size_t>::max();
    std::uint32_t of_each = std::numeric_limits<std::uint32_t>::max();  ///< of one member
    bool may_sink = true;   ///< false: it is also given up where forces drive members into each other
    bool may_press = true;  ///< false: at once where they do so with two that touch and would not rebound
};

/// Works islands off; keeps its memory for the next one. For one thread.
class EventIsland {
public:
    /// Both must outlive it.
    EventIsland(const Response& response, const PairMaterials& materials, std::uint32_t impact_budget)
        : response_(response), materials_(materials), impact_budget_(impact_budget) {}

    /// Moves the members to the end of the step. The result does not depend on their order, but for the last bits of
    /// impacts that several of them share. scratch: says what is to be recorded; its lists are used. False where there
    /// are more impacts than the limit: the members are anywhere then.
    bool run(std::vector<IslandMember>& members, MoveScratch& scratch, const ImpactLimit& limit = {});

    /// Impacts of the last run, in the order of time.
    [[nodiscard]] const std::vector<PairImpactRecord>& impacts() const { return impacts_; }
    /// The same for the verifier, where motions are recorded.
    [[nodiscard]] const std::vector<PairMeeting>& meetings() const { return meetings_; }

private:
    /// What a member does until the step's end if it meets none of the others.
    struct Prediction {
        MovingParticle moved;
        MoveOutcome outcome;
        MoveLists lists;
        std::vector<FlownPiece> flown;
    };

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
    [[nodiscard]] bool exceeds(const ImpactLimit& limit) const;
    [[nodiscard]] bool sinks() const;
    [[nodiscard]] bool presses() const;
    template <class Is>
    [[nodiscard]] bool any_sinks(const Is& is) const;

    const Response& response_;
    const PairMaterials& materials_;
    std::uint32_t impact_budget_ = 0;  // of a member in a step
    std::vector<IslandMember>* members_ = nullptr;
    MoveScratch* scratch_ = nullptr;
    std::vector<Prediction> predictions_;
    std::vector<Vec3> begin_;  // m, of the members
    std::vector<Box3> boxes_;  // of the predictions
    IslandNeighbours neighbours_;
    EarliestTime times_;                 // s, of each member's first meeting; infinite: it meets nobody
    std::vector<std::size_t> partners_;  // in it
    std::uint32_t most_of_one_ = 0;      // impacts
    std::vector<Flight> resumed_;        // of each member, where it has been kicked in this step
    std::vector<PairImpactRecord> impacts_;
    std::vector<PairMeeting> meetings_;
};

}  // namespace ricochet
