#include "ricochet/compare/gnuplot_style.h"

#include <fmt/format.h>

#include <array>

namespace ricochet {
namespace {

// M. Okabe, K. Ito, "Color universal design", 2008: colours that the colour-blind tell apart.
constexpr std::array kColors{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000"};
constexpr std::array kPointTypes{7, 5, 9, 13, 3};
constexpr std::array kPointSizes{2.2, 1.7, 1.7, 1.7, 1.4};

}  // namespace

std::string gnuplot_start(std::string_view remark) {
    return fmt::format("# {}\n", remark) +
           "if (!exists('ending')) ending = ''\n"
           "if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) {\n"
           "    set terminal pngcairo size 1100,700 font 'DejaVu Sans,14' background 'white'\n"
           "} else {\n"
           "    set terminal png size 1100,700\n"
           "}\n"
           "set encoding utf8\n"
           "set datafile missing 'nan'\n"
           "set grid linetype 1 linecolor '#c8c8c8' linewidth 1\n"
           "set border linecolor '#404040'\n"
           "set key outside right top Left reverse noenhanced\n"
           "set tics nomirror\n"
           "set format y '%g'\n";
}

std::string gnuplot_line_styles(std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t k = i % kColors.size();
        text += fmt::format("set style line {} linecolor '{}' linewidth 2 pointtype {} pointsize {}\n", i + 1,
                            kColors[k], kPointTypes[k], kPointSizes[k]);
    }
    return text;
}

}  // namespace ricochet
