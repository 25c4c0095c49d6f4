/// \file
/// Private to the simulation: the saved state of a run.
#pragma once

#include <variant>

#include "ricochet/core/byte_stream.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/simulation/modules.h"

namespace ricochet {

/// Archives an expected value. When reading, throws InputError if another value is found.
template <class Archive, class T>
void expect(Archive& a, const T& expected, const char* complaint) {
    T value = expected;
    a(value);
    if (value != expected) throw InputError(complaint);
}

/// Adds numbers to a fingerprint.
void add_numbers(StateHash& hash, auto... values) { (hash.add(static_cast<double>(values)), ...); }

/// Adds the settings of a table to a fingerprint. Absent settings count as 0.
void add_settings(StateHash& hash, const auto& object, const auto& table) {
    const auto add = [&](auto member) {
        const auto& value = object.*member;
        if constexpr (requires { value.x; }) {
            hash.add(value);
        } else if constexpr (requires { value.value_or(0.0); }) {
            hash.add(value.value_or(0.0));
        } else {
            hash.add(static_cast<double>(value));
        }
    };
    for (const auto& line : table) std::visit(add, line.member);
}

/// Writes the state between two steps with a checksum.
void save_state(const ModuleParts& parts, const ModuleList& modules, const ByteSink& sink);
/// Reads a whole state. Throws InputError if it belongs to another setup or is damaged.
void read_state(const ModuleParts& parts, const ModuleList& modules, const ByteSource& source);
/// Throws InputError if a restored state contains values that no run produces, such as indices out of range.
void require_sound_state(const ModuleParts& parts, const ModuleList& modules);

}  // namespace ricochet
