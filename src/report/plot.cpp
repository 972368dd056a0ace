#include "report/plot.h"

#include "core/shown_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Size of what is raised, and how high, as shares of the size of the words.
constexpr double kRaisedSize = 0.7;
constexpr double kRaised = 0.35;

constexpr int kFirstWidth = 32;
/// Widths of Helvetica's characters from the space to the tilde, in thousandths of its size (Adobe's font metrics).
constexpr std::array kWidths{278,  278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,
                             556,  556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,
                             1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,
                             667,  778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,
                             333,  556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
                             556,  556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584};
constexpr int kDigitWidth = 556;

/// The characters of `text`, which is UTF-8; what is no UTF-8 becomes question marks.
std::u32string characters(const std::string& text) {
    std::u32string result;
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<std::uint8_t>(text[i]);
        const std::size_t length = lead < 0x80 ? 1 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc0 ? 2 : 0;
        char32_t value = length < 2 ? lead : lead & (0xffU >> (length + 1));
        bool is_valid = length > 0 && i + length <= text.size();
        for (std::size_t k = 1; is_valid && k < length; ++k) {
            const auto next = static_cast<std::uint8_t>(text[i + k]);
            is_valid = (next & 0xc0U) == 0x80U;
            value = value << 6U | (next & 0x3fU);
        }
        result.push_back(is_valid ? value : U'?');
        i += is_valid ? length : 1;
    }
    return result;
}

double raised_x(const PlotText& text) {
    const double width = text_width(text.text, text.size) + text_width(text.raised, kRaisedSize * text.size);
    const double share = text.anchor == PlotAnchor::Start ? 0.0 : text.anchor == PlotAnchor::Middle ? 0.5 : 1.0;
    return text.at.x - share * width;
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : shown_text(text)) {
        switch (c) {
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '&':
                result += "&amp;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                // Characters that no XML may hold.
                result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
    }
    return result;
}

std::string svg_color(const std::optional<PlotColor>& color) {
    if (!color) return "none";
    const auto byte = [](double value) { return std::lround(255.0 * std::clamp(value, 0.0, 1.0)); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(color->r), byte(color->g), byte(color->b));
}

std::string svg_of(const PlotShape& shape) {
    std::string path;
    for (const PlotPoint& point : shape.points)
        path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", point.x, point.y);
    std::string style = fmt::format(R"(fill="{}")", svg_color(shape.fill));
    if (shape.fill && shape.fill_opacity < 1.0) style += fmt::format(R"( fill-opacity="{:g}")", shape.fill_opacity);
    if (shape.stroke)
        style += fmt::format(R"( stroke="{}" stroke-width="{:g}" stroke-linejoin="round")", svg_color(shape.stroke),
                             shape.width);
    if (!shape.dash.empty()) style += fmt::format(R"( stroke-dasharray="{}")", fmt::join(shape.dash, " "));
    return fmt::format("<path d=\"{}{}\" {}/>\n", path, shape.is_closed ? "Z" : "", style);
}

/// Placed by the widths of Helvetica as the PDF's words are, so that the two look the same.
std::string svg_of(const PlotText& text) {
    std::string raised;
    if (!text.raised.empty())
        raised = fmt::format(R"(<tspan dy="{:.2f}" font-size="{:g}">{}</tspan>)", -kRaised * text.size,
                             kRaisedSize * text.size, escaped(text.raised));
    return fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:g}\" fill=\"{}\">{}{}</text>\n", raised_x(text),
                       text.at.y, text.size, svg_color(text.color), escaped(text.text), raised);
}

/// Returns the code of `c` in WinAnsiEncoding, Windows-1252; '?' of what has none.
unsigned win_ansi(char32_t c) {
    constexpr unsigned kFirst = 0x80;
    // 0 where there is none.
    constexpr std::array<char32_t, 32> kBeyondLatin{0x20ac, 0,      0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021,
                                                    0x02c6, 0x2030, 0x0160, 0x2039, 0x0152, 0,      0x017d, 0,
                                                    0,      0x2018, 0x2019, 0x201c, 0x201d, 0x2022, 0x2013, 0x2014,
                                                    0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0,      0x017e, 0x0178};
    constexpr char32_t kMinus = 0x2212, kEnDash = 0x2013;
    if ((c >= 0x20 && c < 0x7f) || (c >= 0xa0 && c < 0x100)) return static_cast<unsigned>(c);
    const auto* const found = std::ranges::find(kBeyondLatin, c == kMinus ? kEnDash : c);
    return c == 0 || found == kBeyondLatin.end() ? '?' : kFirst + static_cast<unsigned>(found - kBeyondLatin.begin());
}

/// A string of PDF in its encoding WinAnsiEncoding.
std::string pdf_text(const std::string& text) {
    std::string result = "(";
    for (const char32_t c : characters(text)) {
        const unsigned code = win_ansi(c);
        if (code == '(' || code == ')' || code == '\\')
            result += fmt::format("\\{}", static_cast<char>(code));
        else if (code < 0x80)
            result += static_cast<char>(code);
        else
            result += fmt::format("\\{:03o}", code);
    }
    return result + ")";
}

std::string pdf_color(const PlotColor& color, const char* command) {
    return fmt::format("{:.3f} {:.3f} {:.3f} {}\n", color.r, color.g, color.b, command);
}

/// Writes the page's commands, whose y goes up.
class PdfPage {
  public:
    explicit PdfPage(const Plot& plot) : height_(plot.height) {
        for (const auto& part : plot.parts) std::visit([this](const auto& shape) { add(shape); }, part);
    }

    [[nodiscard]] const std::string& commands() const { return commands_; }
    /// Returns the opacities that the commands choose by their numbers, "/O0" and so on.
    [[nodiscard]] const std::vector<double>& opacities() const { return opacities_; }

  private:
    void choose_opacity(double opacity) {
        auto found = std::ranges::find(opacities_, opacity);
        if (found == opacities_.end()) found = opacities_.insert(found, opacity);
        commands_ += fmt::format("/O{} gs\n", found - opacities_.begin());
    }

    void add(const PlotShape& shape) {
        choose_opacity(shape.fill_opacity);
        if (shape.fill) commands_ += pdf_color(*shape.fill, "rg");
        if (shape.stroke)
            commands_ += pdf_color(*shape.stroke, "RG") +
                         fmt::format("{:g} w 1 j\n[{}] 0 d\n", shape.width, fmt::join(shape.dash, " "));
        const char* command = "m";
        for (const PlotPoint& point : shape.points) {
            commands_ += fmt::format("{:.2f} {:.2f} {}\n", point.x, height_ - point.y, command);
            command = "l";
        }
        if (shape.is_closed) commands_ += "h\n";
        commands_ += shape.fill && shape.stroke ? "B\n" : shape.fill ? "f\n" : shape.stroke ? "S\n" : "n\n";
    }

    void add(const PlotText& text) {
        choose_opacity(1.0);
        commands_ +=
            pdf_color(text.color, "rg") + fmt::format("BT\n/F0 {:g} Tf\n{:.2f} {:.2f} Td\n{} Tj\n", text.size,
                                                      raised_x(text), height_ - text.at.y, pdf_text(text.text));
        if (!text.raised.empty())
            commands_ += fmt::format("/F0 {:g} Tf\n{:.2f} Ts\n{} Tj\n0 Ts\n", kRaisedSize * text.size,
                                     kRaised * text.size, pdf_text(text.raised));
        commands_ += "ET\n";
    }

    double height_;
    std::string commands_;
    std::vector<double> opacities_;
};

}  // namespace

bool has_pdf_text(const std::string& text) {
    return std::ranges::none_of(characters(text), [](char32_t c) { return c != '?' && win_ansi(c) == '?'; });
}

double text_width(const std::string& text, double size) {
    double width = 0.0;
    for (const char32_t c : characters(text)) {
        const auto place = static_cast<std::size_t>(c) - kFirstWidth;
        width += c >= kFirstWidth && place < kWidths.size() ? kWidths[place] : kDigitWidth;
    }
    return width * size / 1000.0;
}

std::string to_svg(const Plot& plot) {
    std::string text = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}pt\" height=\"{1:g}pt\" viewBox=\"0 0 {0:g} {1:g}\" "
        "font-family=\"Helvetica, 'Nimbus Sans', Arial, 'Liberation Sans', sans-serif\">\n<title>{2}</title>\n",
        plot.width, plot.height, escaped(plot.title));
    for (const auto& part : plot.parts) text += std::visit([](const auto& shape) { return svg_of(shape); }, part);
    return text + "</svg>\n";
}

// ISO 32000-1, with plain streams; the table at the end has the place of every object.
std::string to_pdf(const Plot& plot) {
    const PdfPage page(plot);
    std::string states;
    for (std::size_t i = 0; i < page.opacities().size(); ++i)
        states += fmt::format("/O{} << /ca {:g} >> ", i, page.opacities()[i]);
    const std::vector<std::string> objects{
        "<< /Type /Catalog /Pages 2 0 R >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:g} {:g}] /Contents 4 0 R /Resources << /Font << /F0 "
                    "5 0 R >> /ExtGState << {}>> >> >>",
                    plot.width, plot.height, states),
        fmt::format("<< /Length {} >>\nstream\n{}endstream", page.commands().size(), page.commands()),
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
        fmt::format("<< /Title {} >>", pdf_text(plot.title))};
    std::string text = "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n";
    std::string table = fmt::format("xref\n0 {}\n0000000000 65535 f \n", objects.size() + 1);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        table += fmt::format("{:010} 00000 n \n", text.size());
        text += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
    }
    return text + table +
           fmt::format("trailer\n<< /Size {} /Root 1 0 R /Info 6 0 R >>\nstartxref\n{}\n%%EOF\n", objects.size() + 1,
                       text.size());
}

}  // namespace etendue
