#include "ricochet/io/detail/fingerprint.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "ricochet/core/hash.h"

namespace ricochet::detail {
namespace {

constexpr std::array<std::string_view, 4> kLeftOut{"output", "camera", "title", "description"};

/// Adds a value with a number for its type, so that no two different scenes read alike.
class ValueHasher {
public:
    explicit ValueHasher(StateHash& hash) : hash_(hash) {}

    void operator()(std::monostate) const { hash_.add(std::uint64_t{0}); }
    void operator()(bool value) const { add(1, value ? 1 : 0); }
    void operator()(std::uint64_t value) const { add(2, value); }
    void operator()(std::int64_t value) const { add(3, static_cast<std::uint64_t>(value)); }
    void operator()(double value) const {
        hash_.add(std::uint64_t{4});
        hash_.add(value);
    }
    void operator()(const std::string& text) const {
        add(5, text.size());
        for (const char c : text) hash_.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
    }
    void operator()(const JsonNode::Array& list) const {
        add(6, list.size());
        for (const JsonNode& node : list) std::visit(*this, node.value);
    }
    void operator()(const JsonNode::Object& object) const {
        add(7, object.size());
        for (const JsonMember& member : object) this->member(member);
    }
    void member(const JsonMember& member) const {
        (*this)(member.key);
        std::visit(*this, member.value.value);
    }

private:
    void add(std::uint64_t type, std::uint64_t value) const {
        hash_.add(type);
        hash_.add(value);
    }
    StateHash& hash_;
};

}  // namespace

std::uint64_t scene_fingerprint(const JsonNode& root) {
    StateHash hash;
    const ValueHasher hasher(hash);
    if (root.object() == nullptr) return hash.value();
    for (const JsonMember& member : *root.object()) {
        if (std::find(kLeftOut.begin(), kLeftOut.end(), member.key) == kLeftOut.end()) hasher.member(member);
    }
    return hash.value();
}

}  // namespace ricochet::detail
