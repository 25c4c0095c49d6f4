#include "ricochet/simulation/statistics.h"

#include <algorithm>
#include <type_traits>

namespace ricochet {

void add_part(SimulationStatistics& run, const SimulationStatistics& part) {
    for (const Statistic& line : kStatistics) {
        const auto add = [&](auto member) {
            if constexpr (std::is_member_object_pointer_v<decltype(member)>) {
                if (line.over_parts == OverParts::sum) run.*member += part.*member;
                if (line.over_parts == OverParts::largest) run.*member = std::max(run.*member, part.*member);
            }
        };
        std::visit(add, line.member);
    }
}

}  // namespace ricochet
