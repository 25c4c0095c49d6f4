#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ricochet/geometry/mesh/gltf_buffers.h"

namespace ricochet {
namespace {

// Numbers of component types in the file. They are the OpenGL constants.
constexpr std::uint64_t kInt8 = 5120;
constexpr std::uint64_t kUint8 = 5121;
constexpr std::uint64_t kInt16 = 5122;
constexpr std::uint64_t kUint16 = 5123;
constexpr std::uint64_t kUint32 = 5125;
constexpr std::uint64_t kFloat = 5126;

std::size_t bytes_of_type(const GltfLocation& location, std::uint64_t type) {
    switch (type) {
        case kInt8:
        case kUint8:
            return 1;
        case kInt16:
        case kUint16:
            return 2;
        case kUint32:
        case kFloat:
            return 4;
        default:
            location.fail(fmt::format("found the componentType {}, expected 5120 to 5123, 5125 or 5126", type));
    }
}

bool is_index_type(std::uint64_t type) { return type == kUint8 || type == kUint16 || type == kUint32; }

std::uint32_t index_at(std::uint64_t type, const char* at) {
    if (type == kUint8) return value_at<std::uint8_t>(at);
    if (type == kUint16) return value_at<std::uint16_t>(at);
    return value_at<std::uint32_t>(at);
}

// Returns an integer type's value divided by its largest value. -128 and -32768 give -1, as the format requires.
template <typename Value>
double integer_at(const char* at, bool is_normalized) {
    const double value = value_at<Value>(at);
    return is_normalized ? std::max(value / std::numeric_limits<Value>::max(), -1.0) : value;
}

// Returns the bytes from the byteOffset on. Checks that they suffice for `count` elements.
std::string_view require_bytes(const GltfLocation& location, std::string_view view, std::uint64_t count,
                               std::size_t stride, std::size_t element) {
    const std::uint64_t offset = location.whole_number("byteOffset", 0);
    const std::uint64_t needed = count == 0 ? 0 : (count - 1) * stride + element;
    if (offset > view.size() || needed > view.size() - offset) {
        location.fail(fmt::format("{} elements need {} bytes from byte {} on, but its bufferView has {}", count, needed,
                                  offset, view.size()));
    }
    return view.substr(offset);
}

std::uint64_t count_in(const GltfLocation& location) {
    const std::uint64_t count = location.at("count").whole_number();
    if (count > kLargestIndexCount) {
        location.fail(fmt::format("found the count {}, expected at most {}", count, kLargestIndexCount));
    }
    return count;
}

}  // namespace

GltfAccessor::GltfAccessor(const GltfLocation& accessor, GltfBuffers& buffers, std::size_t components)
    : components_(components),
      type_(accessor.at("componentType").whole_number()),
      component_bytes_(bytes_of_type(accessor, type_)),
      is_normalized_(accessor.flag("normalized", false)),
      count_(count_in(accessor)),
      stride_(components * component_bytes_) {
    const std::string expected = components == 3 ? "VEC3" : "SCALAR";
    if (accessor.at("type").text() != expected) {
        accessor.fail(fmt::format("found the type {}, expected {}", in_quotes(accessor.at("type").text()), expected));
    }
    if (is_normalized_ && (type_ == kFloat || type_ == kUint32)) {
        accessor.fail("\"normalized\" is for integers of 8 and 16 bits only");
    }
    const std::size_t element = stride_;
    if (accessor.has("bufferView")) {
        const GltfBuffers::View view = buffers.view(accessor, "bufferView");
        if (view.stride > 0) stride_ = view.stride;
        if (stride_ < element) {
            accessor.fail(fmt::format("elements of {} bytes overlap at a byteStride of {}", element, stride_));
        }
        bytes_ = require_bytes(accessor, view.bytes, count_, stride_, element);
    } else if (!accessor.has("sparse")) {
        accessor.fail(
            "no \"bufferView\", so all its values would be 0; compressed files have such accessors: export "
            "without compression");
    }
    if (accessor.has("sparse")) read_sparse(accessor, buffers);
}

GltfAccessor GltfAccessor::of_points(const GltfLocation& accessor, GltfBuffers& buffers, bool quantized) {
    GltfAccessor points(accessor, buffers, 3);
    const bool is_small = points.type_ != kFloat && points.type_ != kUint32;
    if (points.type_ != kFloat && !(quantized && is_small)) {
        accessor.fail(
            fmt::format("points of the componentType {}, expected floats (5126), or the extension "
                        "KHR_mesh_quantization with integers of 8 or 16 bits",
                        points.type_));
    }
    return points;
}

GltfAccessor GltfAccessor::of_indices(const GltfLocation& accessor, GltfBuffers& buffers) {
    GltfAccessor indices(accessor, buffers, 1);
    if (!is_index_type(indices.type_) || indices.is_normalized_) {
        accessor.fail("indices are unsigned integers (componentType 5121, 5123 or 5125), not normalized");
    }
    return indices;
}

void GltfAccessor::read_sparse(const GltfLocation& accessor, GltfBuffers& buffers) {
    const GltfLocation sparse = accessor.at("sparse");
    const std::uint64_t count = count_in(sparse);
    if (count == 0 || count > count_) {
        sparse.fail(fmt::format("found the count {}, expected 1 to the accessor's {}", count, count_));
    }
    const GltfLocation indices = sparse.at("indices");
    const std::uint64_t type = indices.at("componentType").whole_number();
    if (!is_index_type(type)) indices.fail("found another componentType, expected 5121, 5123 or 5125");
    const std::size_t size = bytes_of_type(indices, type);
    const std::string_view bytes = require_bytes(indices, buffers.view(indices, "bufferView").bytes, count, size, size);
    sparse_indices_.reserve(count);
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t index = index_at(type, bytes.data() + k * size);
        if (index >= count_ || (k > 0 && index <= sparse_indices_.back())) {
            indices.fail(fmt::format("found {} at place {}, expected numbers below {} that rise", index, k, count_));
        }
        sparse_indices_.push_back(index);
    }
    const GltfLocation values = sparse.at("values");
    const std::size_t element = components_ * component_bytes_;
    sparse_values_ = require_bytes(values, buffers.view(values, "bufferView").bytes, count, element, element);
}

const char* GltfAccessor::element(std::size_t i) const {
    const auto found = std::lower_bound(sparse_indices_.begin(), sparse_indices_.end(), i);
    if (found != sparse_indices_.end() && *found == i) {
        const auto location = static_cast<std::size_t>(found - sparse_indices_.begin());
        return sparse_values_.data() + location * components_ * component_bytes_;
    }
    return bytes_.data() == nullptr ? nullptr : bytes_.data() + i * stride_;
}

double GltfAccessor::component(const char* at) const {
    switch (type_) {
        case kInt8:
            return integer_at<std::int8_t>(at, is_normalized_);
        case kUint8:
            return integer_at<std::uint8_t>(at, is_normalized_);
        case kInt16:
            return integer_at<std::int16_t>(at, is_normalized_);
        case kUint16:
            return integer_at<std::uint16_t>(at, is_normalized_);
        default:
            return value_at<float>(at);
    }
}

Vec3 GltfAccessor::point(std::size_t i) const {
    const char* const at = element(i);
    if (at == nullptr) return {};
    return {component(at), component(at + component_bytes_), component(at + 2 * component_bytes_)};
}

std::uint32_t GltfAccessor::index(std::size_t i) const {
    const char* const at = element(i);
    return at == nullptr ? 0 : index_at(type_, at);
}

std::uint32_t GltfAccessor::no_index() const {
    return std::numeric_limits<std::uint32_t>::max() >> (32 - 8 * component_bytes_);
}

}  // namespace ricochet
