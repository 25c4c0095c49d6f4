#include "ricochet/simulation/contact_reporter.h"

#include <utility>

#include "ricochet/core/error.h"

namespace ricochet {

void ContactReporter::set(ContactCallback callback) {
    is_replaced_ = is_reporting_;
    callback_ = std::move(callback);
}

void ContactReporter::require_idle() const {
    if (is_reporting_) throw RunError("a contact callback must not step its simulation");
}

void ContactReporter::report(const std::vector<ContactRecord>& records) {
    if (!callback_ || records.empty()) return;
    // The function can replace itself, and must not be destroyed by that while it runs.
    ContactCallback running = take();
    is_reporting_ = true;
    is_replaced_ = false;
    try {
        running(records);
    } catch (...) {
        end(std::move(running));
        throw;
    }
    end(std::move(running));
}

void ContactReporter::end(ContactCallback running) {
    is_reporting_ = false;
    if (!is_replaced_) callback_ = std::move(running);
}

}  // namespace ricochet
