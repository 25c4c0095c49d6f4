#include "cli/violation_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace ricochet::cli {
namespace {

const char* text_of(ViolationKind kind) {
    switch (kind) {
        case ViolationKind::crossing:
            return "a segment meets";
        case ViolationKind::gap:
            return "its segments do not join";
        case ViolationKind::wrong_side:
            return "is on another side than at birth of";
        case ViolationKind::overlap:
            return "overlaps";
    }
    return "";
}

std::string line_of(const Violation& violation, const std::vector<ColliderDescription>& colliders) {
    std::string line =
        fmt::format("leak: particle {} at ({:.17g}, {:.17g}, {:.17g}) m, time {:.17g} s: {}", violation.particle,
                    violation.place.x, violation.place.y, violation.place.z, violation.time, text_of(violation.kind));
    if (violation.collider) line += fmt::format(" collider \"{}\"", colliders[*violation.collider].name);
    if (violation.triangle) line += fmt::format(", triangle {}", *violation.triangle);
    return line;
}

}  // namespace

std::vector<std::string> violation_lines(std::span<const Violation> violations, std::uint64_t count,
                                         const std::vector<ColliderDescription>& colliders) {
    std::vector<std::string> lines;
    for (const Violation& violation : violations.first(std::min(violations.size(), kMostListedViolations))) {
        lines.push_back(line_of(violation, colliders));
    }
    if (count > lines.size()) lines.push_back(fmt::format("leak: and {} more", count - lines.size()));
    return lines;
}

}  // namespace ricochet::cli
