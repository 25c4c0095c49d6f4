#include "ricochet/response/along_surfaces.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/single_contact.h"
#include "ricochet/response/sphere_contact.h"

namespace ricochet {
namespace {

/// Sets the components of a motion along directions, by default to 0. Method: modified Gram-Schmidt, applied twice.
class Remover {
public:
    /// Adds a direction. left_along: required dot product of the direction and the motion after the removal.
    void add(MotionVector direction, double left_along = 0.0) {
        const double whole = std::sqrt(dot(direction, direction));
        for (int pass = 0; pass < 2; ++pass) {
            for (std::size_t k = 0; k < count_; ++k) {
                const double along = dot(direction, basis_[k]);
                add_multiple(direction, -along, basis_[k]);
                left_along -= along * left_[k];
            }
        }
        const double left = std::sqrt(dot(direction, direction));
        if (count_ == basis_.size() || !(left > kDependentDirection * whole)) return;
        for (double& x : direction) x /= left;
        left_[count_] = left_along / left;
        basis_[count_++] = direction;
    }
    void remove_from(MotionVector& motion) const {
        for (int pass = 0; pass < 2; ++pass) {
            for (std::size_t k = 0; k < count_; ++k) {
                add_multiple(motion, left_[k] - dot(motion, basis_[k]), basis_[k]);
            }
        }
    }

    /// Returns true if the removal sets three consecutive components, starting at `first`, to zero for every motion.
    [[nodiscard]] bool takes_all(std::size_t first) const {
        if (std::any_of(left_.begin(), left_.begin() + count_, [](double left) { return left != 0.0; })) return false;
        double trace = 0.0;  // of the projector onto the directions, over these components; 3 if all are removed
        for (std::size_t k = 0; k < count_; ++k) {
            for (std::size_t c = first; c < first + 3; ++c) trace += basis_[k][c] * basis_[k][c];
        }
        if (!(trace > 2.9)) return false;
        for (std::size_t c = first; c < first + 3; ++c) {
            MotionVector unit{};
            unit[c] = 1.0;
            remove_from(unit);
            if (!(std::sqrt(dot(unit, unit)) <= kDependentDirection)) return false;
        }
        return true;
    }

private:
    std::array<MotionVector, 6> basis_{};
    std::array<double, 6> left_{};
    std::size_t count_ = 0;
};

bool sticks(const Stuck& stuck) { return stuck.to_slip || stuck.to_turning || stuck.to_spinning; }

/// Returns the velocity of the first moving surface to which the motion sticks, or zero.
Vec3 carrying_velocity(std::span<const SupportSurface> surfaces, const StuckSurfaces& stuck) {
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        if (stuck[k].to_slip && surfaces[k].velocity != Vec3{}) return surfaces[k].velocity;
    }
    return {};
}

}  // namespace

StuckSurfaces sticking_surfaces(const Motion& motion, double radius, std::span<const SupportSurface> surfaces,
                                double slow) {
    StuckSurfaces stuck{};
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        stuck[k].to_slip = surfaces[k].friction > 0.0 && length(slip_on(surfaces[k], motion, radius)) <= slow;
    }
    return stuck;
}

double speed_scale(const Motion& motion, double radius, std::span<const SupportSurface> surfaces) {
    double scale = length(motion.velocity) + radius * length(motion.spin);
    for (const SupportSurface& surface : surfaces) {
        scale += length(surface.velocity) + radius * length(surface.angular_velocity);
    }
    return scale;
}

Vec3 along_all(const Vec3& v, std::span<const Vec3> normals) {
    Remover remover;
    for (const Vec3& normal : normals) remover.add(normal_direction(normal));
    MotionVector all = motion_vector(v, {});
    remover.remove_from(all);
    return velocity_of(all);
}

void ShortestShift::add(const Vec3& normal, double distance) {
    is_empty_ = false;
    if (count_ == basis_.size()) return;
    Vec3 rest = normal;
    for (int pass = 0; pass < 2; ++pass) {
        for (std::size_t j = 0; j < count_; ++j) {
            const double along = dot(rest, basis_[j]);
            rest -= along * basis_[j];
            distance -= along * parts_[j];
        }
    }
    const double left = length(rest);
    if (!(left > kDependentDirection)) return;
    basis_[count_] = rest / left;
    parts_[count_] = distance / left;
    shift_ += parts_[count_] * basis_[count_];
    ++count_;
}

Motion along_surfaces(const Motion& motion, double radius, std::span<const SupportSurface> surfaces,
                      const StuckSurfaces& stuck, double braked_from) {
    const bool is_sphere = radius > 0.0;
    const bool is_free = std::none_of(stuck.begin(), stuck.begin() + surfaces.size(), sticks);
    if (is_free && motion.velocity == Vec3{}) return motion;
    if (is_free && surfaces.size() == 1) return along_single_surface(motion, radius, surfaces[0].normal, braked_from);
    // The motion is taken relative to the carrying surface, so that it is exactly zero for a particle at rest on it.
    const Vec3 carried = carrying_velocity(surfaces, stuck);
    Remover remover;
    for (const SupportSurface& surface : surfaces) {
        remover.add(normal_direction(surface.normal), -dot(carried, surface.normal));
    }
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        const Vec3& n = surfaces[k].normal;
        for (const Vec3& t : tangent_frame(n)) {
            if (stuck[k].to_slip)
                remover.add(sliding_direction(t, n, is_sphere), dot(surfaces[k].velocity - carried, t));
            if (stuck[k].to_turning) remover.add(turning_direction(t), radius * dot(surfaces[k].angular_velocity, t));
        }
        if (stuck[k].to_spinning) remover.add(turning_direction(n), radius * dot(surfaces[k].angular_velocity, n));
    }
    MotionVector all = motion_vector(motion.velocity - carried, (radius / kTurning) * motion.spin);
    const double before = std::max(std::sqrt(dot(all, all)), braked_from);
    remover.remove_from(all);
    if (std::sqrt(dot(all, all)) <= kStopRounding * before) return {carried, {}};
    // If the centre was at rest, rounding errors of the spin must neither move it nor turn the sphere about a tangent.
    const bool stood = motion.velocity == carried && length(velocity_of(all)) <= kStopRounding * before;
    if (stood) {
        for (const Vec3& axis : {Vec3{1.0, 0.0, 0.0}, Vec3{0.0, 1.0, 0.0}, Vec3{0.0, 0.0, 1.0}}) {
            remover.add(motion_vector(axis, {}));
        }
        remover.remove_from(all);
    }
    const bool stands = stood || remover.takes_all(0);
    const Vec3 left = stands ? Vec3{} : velocity_of(all);
    const Vec3 velocity = carried == Vec3{} ? left : left + carried;
    const bool turns = is_sphere && !remover.takes_all(3);
    return {velocity, turns ? (kTurning / radius) * turning_of(all) : Vec3{}};
}

double twice_kinetic(const Motion& motion, double radius) {
    return length_squared(motion.velocity) + 0.4 * radius * radius * length_squared(motion.spin);
}

void limit_energy(Motion& motion, double radius, double most, double offset) {
    const double moving = twice_kinetic(motion, radius);
    if (!(moving > most + kContactEnergyOffsets * offset)) return;
    const double part = most > 0.0 ? std::sqrt(most / moving) : 0.0;
    motion.velocity *= part;
    motion.spin *= part;
}

}  // namespace ricochet
