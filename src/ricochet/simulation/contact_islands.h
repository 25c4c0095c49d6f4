/// \file
/// Private to the simulation: islands of spheres with lasting contacts or with too many impacts. ContactIsland plans
/// all contacts of such an island as one problem. Then each member moves alone.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "ricochet/response/contact_solver/contact_island.h"
#include "ricochet/response/event_island.h"
#include "ricochet/simulation/lasting_contacts.h"
#include "ricochet/simulation/member_pairs.h"
#include "ricochet/simulation/pair_parts.h"

namespace ricochet {

class ContactIslands {
public:
    /// contacts must outlive the object.
    ContactIslands(const PairParts& parts, const LastingContacts& contacts) : parts_(parts), contacts_(contacts) {}

    /// Returns true if two members pressed on each other in the last step. Such a contact usually lasts, so the island
    /// is a contact island from the start of the step.
    [[nodiscard]] bool begins_as_contact_island(const std::vector<IslandMember>& members) const;
    /// Returns the limit beyond which event-driven islands are handed over to run(). With every method, two spheres
    /// that collide only with each other in a step collide at the exact time of impact.
    [[nodiscard]] ImpactLimit limit_of_impacts() const;
    /// Moves the members of an island from the time `begin`, in s, to the end of the step. Members have been moved to
    /// that time, unless their life in the step begins later. Several threads may run different islands.
    [[nodiscard]] ContactIslandTrace run(std::vector<IslandMember>& members, const TimeSpan& step, double begin);

private:
    /// Working memory for planning an island, reused for later islands.
    struct Work {
        Work(const ResponseRules& rules, const PairMaterials& materials) : island(rules, materials) {}
        ContactIsland island;
        MemberPairs near;
        std::vector<Box3> boxes;
        std::vector<ContactIslandMember> members;
    };
    [[nodiscard]] std::unique_ptr<Work> acquire_work();
    void collect_members(std::vector<IslandMember>& members, Work& work) const;
    static void find_pairs(std::span<const IslandMember> members, Work& work);
    static void find_pairs(Work& work, std::span<const std::uint32_t> changed);
    [[nodiscard]] static std::vector<std::uint32_t> expect_reactions(Work& work);
    [[nodiscard]] SolverReport plan(std::span<const IslandMember> members, Work& work, double duration,
                                    double part) const;
    void move(std::vector<IslandMember>& members, Work& work, const ContactIslandTrace& trace) const;

    PairParts parts_;
    const LastingContacts& contacts_;
    std::mutex spare_mutex_;
    std::vector<std::unique_ptr<Work>> spare_;
};

}  // namespace ricochet
