#include "image/encoded_format.h"

#include <algorithm>
#include <array>

namespace etendue {

namespace {

using namespace std::string_view_literals;

// Deflate cannot expand by more than 1032 (258 bytes from 2 bits), which bounds PNG and, with the run lengths of their
// other codecs, Radiance and TIFF. JPEG needs a bit per 8x8 block of the densest component: 512 pixels a byte of up to
// four channels. OpenEXR's wavelet and DCT codecs pack up to 256 constant lines into a chunk of about a hundred bytes.
// WebP's prefix codes need no bits at all where all pixels are equal; a picture of 2048 x 2048 of them still passes.
// The frames of an animation may be smaller than its canvas, of which the decoder holds several.
constexpr std::array kFormats{
    EncodedFormat{"png", "\x89PNG\r\n\x1a\n"sv, 1100},
    EncodedFormat{"jpeg", "\xff\xd8\xff"sv, 2100},
    EncodedFormat{"openexr", "\x76\x2f\x31\x01"sv, 20000},
    EncodedFormat{"hdr", "#?RADIANCE"sv, 1100},
    EncodedFormat{"hdr", "#?RGBE"sv, 1100},
    EncodedFormat{"tiff", "II*\0"sv, 1100},
    EncodedFormat{"tiff", "MM\0*"sv, 1100},
    // BigTIFF, which files above 4 GB are.
    EncodedFormat{"tiff", "II+\0"sv, 1100},
    EncodedFormat{"tiff", "MM\0+"sv, 1100},
    EncodedFormat{"webp", "RIFF"sv, 200'000, "WEBP"sv},
};

/// Returns the bits per pixel of a PNG's header (PNG specification, 11.2.1), 0 if `head` ends before: pixels of a
/// palette or of few greys are packed.
int png_bits_per_pixel(std::span<const std::byte> head) {
    constexpr std::size_t kDepth = 24, kColorType = 25;
    if (head.size() <= kColorType) return 0;
    constexpr std::array kSamples{1, 0, 3, 1, 2, 0, 4};  // by colour type
    const auto type = static_cast<std::size_t>(head[kColorType]);
    return type < kSamples.size() ? static_cast<int>(head[kDepth]) * kSamples[type] : 0;
}

constexpr std::int64_t kAnimationExpansion = 1100;

/// Returns whether the features that `head` lists have an animation among them (WebP container, "Extended File
/// Format").
bool is_animated_webp(std::span<const std::byte> head) {
    constexpr std::size_t kExtended = 15, kFeatures = 20;
    constexpr std::byte kAnimation{0x02};
    return head.size() > kFeatures && head[kExtended] == std::byte{'X'} &&
           (head[kFeatures] & kAnimation) != std::byte{};
}

}  // namespace

std::optional<EncodedFormat> detect_format(std::span<const std::byte> head) {
    for (const EncodedFormat& format : kFormats) {
        const auto has = [head](std::string_view magic, std::size_t at) {
            const auto matches = [](char expected, std::byte found) {
                return static_cast<std::byte>(expected) == found;
            };
            return head.size() >= at + magic.size() &&
                   std::equal(magic.begin(), magic.end(), head.begin() + static_cast<std::ptrdiff_t>(at), matches);
        };
        if (!has(format.magic, 0) || (!format.magic_at_8.empty() && !has(format.magic_at_8, 8))) continue;
        EncodedFormat found = format;
        if (found.name == "png") found.bits_per_pixel = png_bits_per_pixel(head);
        if (found.name == "webp" && is_animated_webp(head)) found.max_expansion = kAnimationExpansion;
        return found;
    }
    return std::nullopt;
}

}  // namespace etendue
