#include "view/page/run_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/printable.h"
#include "view/page/packing.h"
#include "view/page/page_data.h"
#include "view/page/page_files.h"
#include "view/page/part_encoder.h"

namespace ricochet {
namespace {

/// Script of the page: its name in import statements, and its file.
struct Module {
    std::string_view name;
    std::string_view file;
};
constexpr std::array kModules = {
    Module{"./three.core.js", "three.core.js"},
    Module{"three", "three.module.js"},
    Module{"./OrbitControls.js", "OrbitControls.js"},
    Module{"./blocks.js", "blocks.js"},
    Module{"./run.js", "run.js"},
    Module{"./colors.js", "colors.js"},
    Module{"./copies.js", "copies.js"},
    Module{"./particles.js", "particles.js"},
    Module{"./bodies.js", "bodies.js"},
    Module{"./ribbons.js", "ribbons.js"},
    Module{"./stage.js", "stage.js"},
    Module{"./panel.js", "panel.js"},
    Module{"./main.js", "main.js"},
};

std::string block_element(std::string_view kind, std::string_view name, std::string_view text) {
    return fmt::format("<script type=\"text/plain\" data-{}=\"{}\">{}</script>\n", kind, name, text);
}

std::string module_elements() {
    std::string text;
    for (const auto& [name, file] : kModules) text += block_element("module", name, base64(deflated(page_file(file))));
    return text;
}

std::string part_elements(const ColliderParts& colliders) {
    std::string text;
    for (std::size_t i = 0; i < colliders.parts().size(); ++i) {
        const std::string block = encoded_part(colliders.parts()[i]);
        text += block_element("block", fmt::format("part{}", i), base64(deflated(block)));
    }
    return text;
}

std::string thinned_text(const PageDetail& detail, const PageFrames& frames, const PageSource& source) {
    std::string text;
    const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
    if (detail.value_bits < 16) add(fmt::format("values in {} bits", detail.value_bits));
    if (detail.position_bits < 16) add(fmt::format("positions in {} bits", detail.position_bits));
    if (detail.every_frame > 1) add(fmt::format("{} of {} frames", frames.chosen.size(), source.frames.size()));
    if (detail.particles < 1.0) add(fmt::format("{:.0f} % of the particles", 100.0 * detail.particles));
    return text;
}

std::vector<std::string> notes_of(const PageSource& source, const PageFrames& frames, const PageOptions& options) {
    std::vector<std::string> notes;
    const std::string thinned = thinned_text(frames.detail, frames, source);
    if (!thinned.empty()) {
        notes.push_back(fmt::format("to fit into {:g} MB: {}", options.budget / 1e6, thinned));
    }
    if (frames.outside_count > 0) {
        const auto total = static_cast<double>(std::max<std::uint64_t>(source.survey.total(), 1));
        notes.push_back(fmt::format("{:.2g} % of the particles are too far from all others to be shown",
                                    100.0 * static_cast<double>(frames.outside_count) / total));
    }
    if (source.frames.size() < source.folder.frames.size()) {
        notes.push_back(fmt::format("{} frames lack the moving colliders and are left out",
                                    source.folder.frames.size() - source.frames.size()));
    }
    notes.insert(notes.end(), options.shapes.notes.begin(), options.shapes.notes.end());
    return notes;
}

// Returns the template with each @NAME@ of the list replaced. Names inside the replacement texts are not replaced.
std::string filled(std::string_view text, const std::vector<std::pair<std::string_view, std::string_view>>& values) {
    std::string result;
    while (!text.empty()) {
        std::size_t next = text.size();
        const std::pair<std::string_view, std::string_view>* found = nullptr;
        for (const auto& value : values) {
            const std::size_t at = text.find(value.first);
            if (at < next) {
                next = at;
                found = &value;
            }
        }
        result += text.substr(0, next);
        if (found != nullptr) result += found->second;
        text.remove_prefix(found == nullptr ? text.size() : next + found->first.size());
    }
    return result;
}

void check_color(const PageSource& source, const PageOptions& options) {
    if (options.color_by.empty() || (options.color_by == "color" && source.survey.has_colors)) return;
    std::string known = source.survey.has_colors ? "color" : "";
    for (const PageAttribute& attribute : source.survey.attributes) {
        if (attribute.name == options.color_by) return;
        known += (known.empty() ? "" : ", ") + attribute.name;
    }
    throw InputError(fmt::format("--color-by {}: no such attribute in the run; it has: {}", options.color_by, known));
}

}  // namespace

PageReport write_run_page(const RunFolder& folder, const std::filesystem::path& target, const PageOptions& options) {
    AtomicFile file(target);  // opened first, so that an unwritable path fails before the work
    const PageSource source = page_source(folder, options.shapes, [&](double part) { options.progress(0.5 * part); });
    check_color(source, options);
    const std::string modules = module_elements();
    const std::string parts = part_elements(source.colliders);
    const std::string title =
        folder.info.scene.empty() ? "run" : printable(std::filesystem::path(folder.info.scene).stem().string());
    const auto page_with = [&](std::string_view description) {
        return filled(page_file("page.html"), {{"@TITLE@", html_text(title)},
                                               {"@STYLE@", page_file("page.css")},
                                               {"@DESCRIPTION@", description},
                                               {"@LICENCE@", page_file("LICENSE")},
                                               {"@MODULES@", modules},
                                               {"@BOOT@", page_file("boot.js")},
                                               {"@PARTS@", parts}});
    };
    // Estimated size of everything except the blocks of frames. Each frame adds a line of tags and a few numbers.
    constexpr double kBytesPerFrame = 100.0;
    const double fixed = static_cast<double>(page_with(page_description(source, {}, options, {})).size()) + 2000.0 +
                         kBytesPerFrame * static_cast<double>(source.frames.size());
    const PageFrames frames = fitted_frames(source, options.budget - fixed, options);
    PageReport report{.frames = frames.chosen.size(), .notes = notes_of(source, frames, options)};
    const std::string head = page_with(page_description(source, frames, options, report.notes));
    const auto write = [&](const std::string& text) {
        file.write(text);
        report.bytes += text.size();
    };
    write(head);
    for (std::size_t i = 0; i < frames.blocks.size(); ++i) {
        write(block_element("block", fmt::format("frame{}", i), frames.blocks[i]));
    }
    write("</body>\n</html>\n");
    file.commit();
    return report;
}

}  // namespace ricochet
