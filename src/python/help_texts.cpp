#include "python/help_texts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet::python {
namespace {

/// Splits a text at the separators that are not inside brackets.
std::vector<std::string> split(std::string_view text, std::string_view separator) {
    std::vector<std::string> parts;
    int depth = 0;
    std::size_t begin = 0;
    for (std::size_t k = 0; k < text.size(); ++k) {
        if (text[k] == '(' || text[k] == '[') ++depth;
        if (text[k] == ')' || text[k] == ']') --depth;
        if (depth != 0 || text.substr(k, separator.size()) != separator) continue;
        parts.emplace_back(text.substr(begin, k - begin));
        begin = k + separator.size();
    }
    if (begin < text.size()) parts.emplace_back(text.substr(begin));
    return parts;
}

/// Returns an argument without its type: "most: object = None" becomes "most=None". The types are omitted, because the
/// functions accept every type that NumPy can convert.
std::string argument(const std::string& written) {
    const std::size_t colon = written.find(": ");
    const std::size_t value = written.find(" = ");
    const std::string name = written.substr(0, std::min(colon, value));
    if (value == std::string::npos) return name;
    const std::string standard = written.substr(value + 3);
    return fmt::format("{}={}", name, standard == "inf" ? "math.inf" : standard);
}

/// Returns a sentence with the type of a result and the fields of this type.
std::string sentence_on(std::string type) {
    constexpr std::string_view kCompiled = "ricochet._core.";
    if (type.starts_with(kCompiled)) type.replace(0, kCompiled.size(), "ricochet.");
    if (type.empty() || type == "None" || type == "object") return "";
    std::string text = fmt::format("\n\nReturns {}", type);
    constexpr std::string_view kPackage = "ricochet.";
    if (!type.starts_with(kPackage)) return text + ".";
    const py::module_ results = py::module_::import("ricochet._results");
    const std::string name = type.substr(kPackage.size());
    if (!py::hasattr(results, name.c_str())) return text + ".";
    const py::object fields = py::getattr(results.attr(name.c_str()), "_fields", py::tuple());
    text += ": ";
    for (const py::handle& field : fields) text += std::string(py::str(field)) + ", ";
    return text.substr(0, text.size() - 2) + ".";
}

/// Returns the text with a signature in the form that Python parses. Returns an empty text if `text` does not begin
/// with pybind11's signature.
std::string rewritten(std::string_view text, std::string_view name) {
    const std::size_t line_end = std::min(text.find('\n'), text.size());
    const std::string line(text.substr(0, line_end));
    const std::size_t close = line.rfind(") -> ");
    if (!line.starts_with(std::string(name) + "(") || close == std::string::npos) return "";
    std::string signature;
    for (const std::string& part :
         split(std::string_view(line).substr(name.size() + 1, close - name.size() - 1), ", ")) {
        signature += (signature.empty() ? "" : ", ") + argument(part);
    }
    std::string_view rest = text.substr(line_end);
    while (rest.starts_with('\n')) rest.remove_prefix(1);
    while (rest.ends_with('\n')) rest.remove_suffix(1);
    return fmt::format("{}({})\n--\n\n{}{}", name, signature, rest, sentence_on(line.substr(close + 5)));
}

void write_signature(PyObject* function, const std::string& name) {
    if (PyInstanceMethod_Check(function)) function = PyInstanceMethod_GET_FUNCTION(function);
    if (!PyCFunction_Check(function)) return;
    PyMethodDef* const definition = reinterpret_cast<PyCFunctionObject*>(function)->m_ml;
    if (definition->ml_doc == nullptr) return;
    const std::string text = rewritten(definition->ml_doc, name);
    if (text.empty()) return;
    // pybind11 frees the new text together with the function.
    std::free(const_cast<char*>(definition->ml_doc));  // NOLINT(cppcoreguidelines-no-malloc)
    definition->ml_doc = strdup(text.c_str());
}

}  // namespace

void write_signatures(const py::object& class_or_module) {
    const py::dict members(class_or_module.attr("__dict__"));
    for (const auto& [name, member] : members) {
        const py::object function = py::getattr(member, "__func__", member);  // unwraps the function of a static method
        write_signature(function.ptr(), py::str(name));
    }
}

}  // namespace ricochet::python
