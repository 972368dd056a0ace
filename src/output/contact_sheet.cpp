#include "output/contact_sheet.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

namespace etendue {

namespace {

constexpr float kBackground = 0.13f;
constexpr float kInk = 0.85f;
constexpr int kGap = 8;         // pixels between images and around them
constexpr int kGlyphWidth = 5;  // of the font's own pixels
constexpr int kGlyphHeight = 7;
constexpr int kAdvance = kGlyphWidth + 1;
constexpr int kFontScale = 2;  // pixels of the sheet for one of the font
constexpr int kLabelHeight = kFontScale * kGlyphHeight + kGap;

/// Rows from the top, the leftmost pixel in bit 4. The few characters that labels need are drawn here: machines that
/// render have no fonts.
using Glyph = std::array<std::uint8_t, kGlyphHeight>;

constexpr std::string_view kCharacters = "0123456789,()";
constexpr std::array<Glyph, kCharacters.size()> kGlyphs{{
    {14, 17, 19, 21, 25, 17, 14},  // 0
    {4, 12, 4, 4, 4, 4, 14},       // 1
    {14, 17, 1, 2, 4, 8, 31},      // 2
    {31, 2, 4, 2, 1, 17, 14},      // 3
    {2, 6, 10, 18, 31, 2, 2},      // 4
    {31, 16, 30, 1, 1, 17, 14},    // 5
    {6, 8, 16, 30, 17, 17, 14},    // 6
    {31, 1, 2, 4, 8, 8, 8},        // 7
    {14, 17, 17, 14, 17, 17, 14},  // 8
    {14, 17, 17, 15, 1, 2, 12},    // 9
    {0, 0, 0, 0, 12, 4, 8},        // ,
    {2, 4, 8, 8, 8, 4, 2},         // (
    {8, 4, 2, 2, 2, 4, 8},         // )
}};

void fill(ImageF& sheet, int x0, int y0, int width, int height, float value) {
    for (int y = std::max(y0, 0); y < std::min(y0 + height, sheet.height); ++y)
        for (int x = std::max(x0, 0); x < std::min(x0 + width, sheet.width); ++x)
            std::ranges::fill(sheet.pixel(x, y), value);
}

void draw_text(ImageF& sheet, std::string_view text, int x, int y) {
    for (const char c : text) {
        const std::size_t index = kCharacters.find(c);
        if (index != std::string_view::npos)
            for (int row = 0; row < kGlyphHeight; ++row)
                for (int column = 0; column < kGlyphWidth; ++column)
                    if ((kGlyphs[index][static_cast<std::size_t>(row)] >> (kGlyphWidth - 1 - column) & 1) != 0)
                        fill(sheet, x + kFontScale * column, y + kFontScale * row, kFontScale, kFontScale, kInk);
        x += kFontScale * kAdvance;
    }
}

void place(ImageF& sheet, const ImageF& image, int x0, int y0) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) std::ranges::copy(image.pixel(x, y), sheet.pixel(x0 + x, y0 + y).begin());
}

}  // namespace

ImageF make_contact_sheet(const std::vector<std::vector<LabelledImage>>& rows) {
    std::size_t columns = 0;
    std::size_t longest_label = 0;
    const ImageF* first = nullptr;
    for (const auto& row : rows) {
        columns = std::max(columns, row.size());
        for (const LabelledImage& image : row) {
            longest_label = std::max(longest_label, image.label.size());
            if (first == nullptr) first = &image.pixels;
            if (image.pixels.channels != 3 || image.pixels.width != first->width ||
                image.pixels.height != first->height)
                throw std::invalid_argument("images of a contact sheet have three channels and one size");
        }
    }
    if (first == nullptr) throw std::invalid_argument("a contact sheet without images");
    const int step_x = std::max(first->width, kFontScale * kAdvance * static_cast<int>(longest_label)) + kGap;
    const int step_y = first->height + kGap + kLabelHeight;
    ImageF sheet(kGap + step_x * static_cast<int>(columns), kGap + step_y * static_cast<int>(rows.size()), 3);
    std::ranges::fill(sheet.pixels, kBackground);
    int y = kGap;
    for (const auto& row : rows) {
        int x = kGap;
        for (const LabelledImage& image : row) {
            place(sheet, image.pixels, x, y);
            draw_text(sheet, image.label, x, y + first->height + kGap / 2);
            x += step_x;
        }
        y += step_y;
    }
    return sheet;
}

}  // namespace etendue
