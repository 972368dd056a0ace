// A drawing of lines, areas and words, for files that papers show: one model, written as SVG and as PDF.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace etendue {

/// Red, green and blue in [0, 1], encoded for an sRGB display.
struct PlotColor {
    double r = 0.0;
    double g = 0.0;
    double b = 0.0;
};

/// A place in points, 1/72 inch, from the top left corner.
struct PlotPoint {
    double x = 0.0;
    double y = 0.0;
};

/// A line through points, or the area that it encloses.
struct PlotShape {
    std::vector<PlotPoint> points{};
    bool is_closed = false;
    std::optional<PlotColor> fill{};
    double fill_opacity = 1.0;
    std::optional<PlotColor> stroke{};
    double width = 1.0;          ///< points
    std::vector<double> dash{};  ///< lengths of dashes and gaps in turns, points; empty for a solid line
};

enum class PlotAnchor { Start, Middle, End };

/// A line of words in Helvetica, which every reader of PDF has, with what stands raised behind it.
struct PlotText {
    PlotPoint at{};  ///< on the base line
    std::string text{};
    std::string raised{};
    PlotAnchor anchor = PlotAnchor::Start;
    double size = 8.0;  ///< points
    PlotColor color{};
};

struct Plot {
    double width = 0.0;  ///< points
    double height = 0.0;
    std::string title{};
    std::vector<std::variant<PlotShape, PlotText>> parts{};  ///< the first lies below all others
};

/// True if the font of a PDF has all characters of `text`; those that it lacks are question marks there.
[[nodiscard]] bool has_pdf_text(const std::string& text);

/// Returns the width of `text` in Helvetica of `size` points; characters that the font lacks count as wide as a digit.
[[nodiscard]] double text_width(const std::string& text, double size);

/// An SVG file.
[[nodiscard]] std::string to_svg(const Plot& plot);

/// A PDF file of one page. Words keep the characters of Latin-1 and the minus; others become question marks.
[[nodiscard]] std::string to_pdf(const Plot& plot);

}  // namespace etendue
