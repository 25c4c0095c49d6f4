/// \file
/// Private to the simulation: the user's function that receives the contact records of each step.
#pragma once

#include <utility>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// Calls the function of Simulation::on_contact(). The function can replace itself while it runs.
class ContactReporter {
public:
    /// Sets the function; an empty one ends the calls.
    void set(ContactCallback callback);
    [[nodiscard]] bool is_set() const { return static_cast<bool>(callback_); }
    /// Returns the function, and calls none until the next set().
    [[nodiscard]] ContactCallback take() { return std::exchange(callback_, {}); }
    /// Throws RunError if the function runs.
    void require_idle() const;
    /// Calls the function if there are records. Its exceptions leave report().
    void report(const std::vector<ContactRecord>& records);

private:
    void end(ContactCallback running);

    ContactCallback callback_;
    bool is_reporting_ = false;  // the function runs
    bool is_replaced_ = false;   // the running function has called set()
};

}  // namespace ricochet
