/// \file
/// Where the bytes of a saved state go to and come from.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace ricochet {

/// Takes the bytes, at least one, in order; throws when it cannot.
using ByteSink = std::function<void(std::span<const std::byte>)>;
/// Gives exactly as many bytes as the span holds, at least one, in order; throws when there are not so many.
using ByteSource = std::function<void(std::span<std::byte>)>;

}  // namespace ricochet
