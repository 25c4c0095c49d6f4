#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/mover.h"

namespace ricochet {

/// Responds to an impact. Returns the next contact when the particle slid into one.
std::optional<Contact> Mover::answer(const Flight& flight, const Contact& contact) {
    ++outcome_.bounces;
    manifold_.meet(contact.all());
    const Motion arriving{state_.velocity, particle_.spin};
    impact_.reflect(contact.all());
    if (outcome_.absorbed) return std::nullopt;
    const ContactSurface* const support = support_of(flight, contact, arriving);
    const bool is_stuck = std::exchange(remaining_at_contact_, remaining_) == remaining_;
    const bool is_slow = support != nullptr && (is_stuck || length(arriving.velocity) < rules_.settings.resting_speed);
    slow_contacts_ = is_slow ? slow_contacts_ + 1 : 0;
    if (support == nullptr) return std::nullopt;
    manifold_.replace(contact.all(), TouchRule::at(state_.position));
    if (slow_contacts_ > kMaxSlowContacts) {
        manifold_.unload();
        rest(flight.kick_duration > 0.0 ? Vec3{} : acceleration_now(flight), false);
        return std::nullopt;
    }
    return stay_in_contact(flight, *support, arriving);
}

}  // namespace ricochet
