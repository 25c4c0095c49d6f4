/// \file
/// A contact island. One contact problem determines the motion of all its spheres over a step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/dynamics/neighbour_grid.h"
#include "ricochet/response/contact_solver/iterative_contact_solver.h"
#include "ricochet/response/contact_solver/planned_move.h"
#include "ricochet/response/contact_solver/wall_contacts.h"
#include "ricochet/response/contact_solver/warm_start_memory.h"
#include "ricochet/response/pair_materials.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// A sphere of the island.
struct ContactIslandMember {
    MovingParticle* moving = nullptr;
    double radius = 0.0;         ///< radius for contacts with other spheres, in m
    bool is_fixed = false;       ///< true if no impulse or force moves it
    double duration = 0.0;       ///< duration of its step, in s
    bool is_pinched = false;     ///< true if its time is stalled; other spheres collide with it at its present position
    bool is_asleep = false;      ///< fixed while asleep; overlaps with it are not separated
    double reach = 0.0;          ///< search distance for contacts from its surface, in m
    std::uint32_t material = 0;  ///< index in PairMaterials
    // Output:
    MoveOutcome outcome{};

    [[nodiscard]] bool stays() const { return is_fixed || is_pinched; }
};

/// Impulse of a contact on a sleeping sphere in a step.
struct SleeperImpulse {
    std::uint64_t particle = 0;  ///< id of the sleeping sphere
    Vec3 impulse;                ///< in N s
};

/// Energies of the impacts of a plan, in J. Impacts approach faster than the resting speed, and did not press before.
struct PlannedImpacts {
    double energy = 0.0;  ///< kinetic energy of the members in impacts, before the plan
    double loss = 0.0;    ///< energy that all impacts lose beyond their restitution
};

/// Solves and moves one contact island after the other, and reuses its memory. The forces first give each sphere its
/// velocity at the end of the step (symplectic Euler). Then all contacts are found and solved, and each sphere moves
/// along its plan.
class ContactIsland {
public:
    /// Both arguments must outlive the object.
    ContactIsland(const ResponseRules& rules, const PairMaterials& materials) : rules_(rules), materials_(materials) {}

    /// Returns the search distance for the first plan, in m: more than the length of the member's free path.
    [[nodiscard]] double first_reach(const ContactIslandMember& member) const;
    /// Plans `duration` seconds, which are this part of the step. pairs: members within reach of each other. memory:
    /// contacts of the last step.
    SolverReport plan(std::span<const ContactIslandMember> members, std::span<const NeighbourPair> pairs,
                      double duration, double part, const WarmStartMemory& memory, MoveScratch& scratch);
    /// Moves the member with this index as planned. Several threads may move different members.
    void move(std::size_t index, ContactIslandMember& member, MoveScratch& scratch) const;

    /// Returns the planned motion of the member with this index.
    [[nodiscard]] const SolverBody& planned(std::size_t index) const { return bodies_[index]; }
    /// Replaces the plan of a member by rest, without spin.
    void put_to_rest(std::size_t index) { bodies_[index].velocity = bodies_[index].spin = Vec3{}; }
    /// Returns the velocity change of a member by other spheres in the step, in m/s.
    [[nodiscard]] Vec3 given_by_others(std::size_t index, const ContactIslandMember& member) const;
    /// Returns the effects of walls on a member in the step.
    [[nodiscard]] std::vector<WallImpulse> impulses_of(std::size_t index) const;
    /// Returns the contacts of the last plan, for the memory of the next step.
    [[nodiscard]] std::vector<WarmStartMemory::Entry> entries() const;
    /// Returns the pairs of members that press on each other, by their indices.
    [[nodiscard]] std::vector<NeighbourPair> pressing() const;
    /// Returns the impulses that awake spheres exert on sleeping spheres, one per contact.
    [[nodiscard]] std::vector<SleeperImpulse> impulses_on_sleepers() const;
    /// Returns the energy of the impacts of the last plan, with surfaces and between members.
    [[nodiscard]] PlannedImpacts impacts() const;
    /// Returns the pairs with at most a very small gap, whether they press or not.
    [[nodiscard]] std::vector<ContactKey> touching() const;
    /// Increases the search distance of members whose plan leads beyond it. Returns their indices in ascending order.
    /// If there are none, all contacts of the plan are known.
    [[nodiscard]] std::vector<std::uint32_t> reach_farther(std::span<ContactIslandMember> members) const;

private:
    /// Data of a member that contacts need, stored together.
    struct MemberState {
        Vec3 position;  ///< in m
        Vec3 velocity;  ///< at the start of the step, in m/s
        std::uint64_t id = 0;
        double radius = 0.0;  ///< in m
        double reach = 0.0;   ///< in m
        double pull = 0.0;    ///< acceleration by the forces on it, in m/s^2
        std::uint32_t material = 0;
        bool stays = false;
        bool is_asleep = false;
    };

    /// Scales of the tolerances.
    struct Pace {
        double fastest = 0.0;         ///< largest speed at the start of the step, in m/s
        double force_velocity = 0.0;  ///< largest velocity change by forces in the step, in m/s
        double smallest = INFINITY;   ///< smallest radius, in m
    };

    [[nodiscard]] double parted(double gap) const { return gap < 0.0 ? part_ * gap : gap; }
    [[nodiscard]] bool add_bodies(std::span<const ContactIslandMember> members, const WarmStartMemory& memory);
    void add_pairs(std::span<const NeighbourPair> pairs);
    void add_pair(std::uint32_t first, std::uint32_t second);
    void add_walls(std::span<const ContactIslandMember> members, MoveScratch& scratch);
    void add_wall(std::uint32_t index, const ContactIslandMember& member, const WallContact& wall);
    void carry(SolverContact& contact, const WallContact& wall, const Material& material,
               const ForceInput& state) const;
    void add_key(const ContactKey& key);
    void warm_start(std::size_t at);
    [[nodiscard]] double rebound(double restitution, double approach) const;
    [[nodiscard]] Vec3 velocity_in_flight(const ContactIslandMember& member) const;
    [[nodiscard]] Pace pace_of(std::span<const ContactIslandMember> members) const;
    [[nodiscard]] SolverSettings settings(const Pace& pace) const;
    void set_exactness(const Pace& pace, double enough);

    const ResponseRules& rules_;
    const PairMaterials& materials_;
    double duration_ = 0.0;
    double part_ = 1.0;  // fraction of the time step, below 1 after impacts in the step and in substeps
    std::vector<SolverBody> bodies_;
    std::vector<MemberState> members_;                   // one per member
    std::vector<WarmStartMemory::OfParticle> memories_;  // one per member
    std::vector<SolverContact> contacts_;                // between spheres, then with walls
    std::vector<ContactKey> keys_;                       // one per contact
    std::vector<const SolverImpulse*> before_;           // last impulse of each contact, or null
    std::vector<std::size_t> edges_of_sleep_;            // contacts of a sleeping sphere with one that is awake
    std::vector<WallContact> walls_;                     // scratch memory of add_walls()
    std::vector<std::size_t> first_wall_;  // index of each member's first contact with a wall, and the end
    std::vector<double> clear_;            // distance of each member in which there is certainly no wall, in m
    IterativeContactSolver solver_;
};

}  // namespace ricochet
