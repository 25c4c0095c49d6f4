#include "ricochet/verify/energy.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet::verify {
namespace {

/// A type with more digits than double, on machines that have one. The rounding errors of this check are then
/// negligible.
using Long = long double;

Long product(const Vec3& a, const Vec3& b) {
    return static_cast<Long>(a.x) * b.x + static_cast<Long>(a.y) * b.y + static_cast<Long>(a.z) * b.z;
}

/// Returns the kinetic energy per unit mass, in m^2/s^2.
Long kinetic(const RecordedMotion& motion, double radius) {
    const Long inertia = static_cast<Long>(radius) * radius * 2 / 5;
    return (product(motion.velocity, motion.velocity) + inertia * product(motion.spin, motion.spin)) / 2;
}

/// Returns the work per unit mass, in m^2/s^2, of a constant force in a part of the motion. force: force per unit mass.
Long work(const Vec3& force, const MotionPart& part) {
    return product(force, part.end.position) - product(force, part.begin.position);
}

/// Returns an upper bound of the length of the path between both ends, in m. The bound assumes that only the forces can
/// raise the speed above the larger end speed.
double longest_path(const MotionPart& part, double largest_force) {
    const double speed = std::max(length(part.begin.velocity), length(part.end.velocity));
    return part.duration * (speed + part.duration * largest_force);
}

}  // namespace

bool gains_energy(const MotionPart& part) {
    if (part.kind == MotionPart::Kind::flight || part.kind == MotionPart::Kind::driven) return false;
    const Long before = kinetic(part.begin, part.radius);
    const Long after = kinetic(part.end, part.radius);
    const auto& [first, middle, last] = part.forces;
    const double largest_force = std::max({length(first), length(middle), length(last)});
    Long most = work(first, part);
    if (!part.forces_are_steady) {
        const double change = length(middle - first) + length(last - middle);
        most = (most + 4 * work(middle, part) + work(last, part)) / 6 +
               static_cast<Long>(change) * longest_path(part, largest_force);
    }
    const double offset = std::max(contact_offset(part.begin.position), contact_offset(part.end.position));
    const double rounding =
        kEnergyGain * static_cast<double>(std::max(before, after)) + kEnergyOffsets * largest_force * offset;
    return !(after - before - most <= rounding);
}

}  // namespace ricochet::verify
