/// \file
/// Appending of numbers to the bytes of a little-endian file.
#pragma once

#include <bit>
#include <string>
#include <type_traits>

namespace ricochet {

/// Appends the bytes of a value as they are in memory.
template <class Value>
void append_bytes(std::string& bytes, const Value& value) {
    static_assert(std::endian::native == std::endian::little, "files are little-endian, and so is the memory");
    static_assert(std::is_trivially_copyable_v<Value>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(Value));
}

}  // namespace ricochet
