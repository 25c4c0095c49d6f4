/// \file
/// Sink and source of the bytes of a saved state.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace ricochet {

/// Function that consumes bytes, at least one, in order. Throws if it cannot consume them all.
using ByteSink = std::function<void(std::span<const std::byte>)>;
/// Function that fills the whole span, of at least one byte, in order. Throws if there are not enough bytes.
using ByteSource = std::function<void(std::span<std::byte>)>;

}  // namespace ricochet
