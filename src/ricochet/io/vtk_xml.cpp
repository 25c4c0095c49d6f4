#include "ricochet/io/vtk_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/printable.h"

namespace ricochet::detail {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string unescaped(std::string_view text) {
    constexpr std::pair<std::string_view, char> kEntities[] = {
        {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
    std::string out;
    while (!text.empty()) {
        const auto entity = std::find_if(std::begin(kEntities), std::end(kEntities),
                                         [&](const auto& e) { return text.substr(0, e.first.size()) == e.first; });
        out += entity == std::end(kEntities) ? text.front() : entity->second;
        text.remove_prefix(entity == std::end(kEntities) ? 1 : entity->first.size());
    }
    return out;
}

std::string_view without_leading_blanks(std::string_view text) {
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(kBlanks)));
    return text;
}

}  // namespace

void VtkSource::refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}; {}", path.string(), printable(what, 300), expected));
}

std::optional<XmlTag> XmlTags::next() {
    constexpr std::string_view kCommentEnd = "-->";
    std::size_t open = text_.find('<', at_);
    while (open != std::string_view::npos && text_.substr(open, 4) == "<!--") {
        const std::size_t end = text_.find(kCommentEnd, open);
        if (end == std::string_view::npos) source_.refuse("a comment is not closed");
        at_ = end + kCommentEnd.size();
        open = text_.find('<', at_);
    }
    if (open == std::string_view::npos) return std::nullopt;
    const std::size_t close = text_.find('>', open);
    if (close == std::string_view::npos) source_.refuse("a tag of the header is not closed");
    XmlTag tag = parse(text_.substr(open + 1, close - open - 1));
    at_ = close + 1;
    tag.begin = open;
    tag.end = at_;
    tag.text = text_.substr(at_);
    tag.text = tag.text.substr(0, tag.text.find('<'));
    return tag;
}

XmlTag XmlTags::parse(std::string_view inside) const {
    XmlTag tag;
    if (!inside.empty() && inside.back() == '/') {
        tag.closed = true;
        inside.remove_suffix(1);
    }
    tag.name = inside.substr(0, inside.find_first_of(kBlanks));
    inside = without_leading_blanks(inside.substr(tag.name.size()));
    while (!inside.empty() && inside != "?") {
        const std::size_t equals = inside.find('=');
        const char quote = equals < inside.size() - 1 ? inside[equals + 1] : '\0';
        const bool quoted = quote == '"' || quote == '\'';
        const std::size_t end = quoted ? inside.find(quote, equals + 2) : std::string_view::npos;
        if (end == std::string_view::npos) source_.refuse(fmt::format("bad attribute in the tag <{}>", tag.name));
        tag.attributes[std::string(inside.substr(0, equals))] = unescaped(inside.substr(equals + 2, end - equals - 2));
        inside = without_leading_blanks(inside.substr(end + 1));
    }
    return tag;
}

const std::string& attribute_of(const VtkSource& source, const XmlTag& tag, std::string_view name) {
    const auto found = tag.attributes.find(name);
    if (found == tag.attributes.end()) source.refuse(fmt::format("no {} in the tag <{}>", name, tag.name));
    return found->second;
}

std::uint64_t count_of(const VtkSource& source, const XmlTag& tag, std::string_view name) {
    const std::string& text = attribute_of(source, tag, name);
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || stop != text.data() + text.size()) {
        source.refuse(fmt::format("{}=\"{}\" is not a count", name, text));
    }
    return value;
}

}  // namespace ricochet::detail
