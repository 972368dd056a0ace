#include "texture/mip_chain.h"

#include "image/finite.h"
#include "texture/slope_rows.h"
#include "texture/wrap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

namespace etendue {

namespace {

/// Stored value to linear.
template <typename T>
float decode(T value, bool curved) {
    if constexpr (std::is_same_v<T, std::uint8_t>)
        return curved ? linear_from_srgb8(value) : static_cast<float>(value) * (1.0f / 255.0f);
    else if constexpr (std::is_same_v<T, std::uint16_t>)
        return curved ? linear_from_srgb16(value) : static_cast<float>(value) * (1.0f / 65535.0f);
    else
        return curved ? linear_from_srgb(static_cast<float>(value)) : static_cast<float>(value);
}

/// Linear to stored value.
template <typename T>
T encode(float value, bool curved) {
    if constexpr (std::is_integral_v<T>) {
        if constexpr (std::is_same_v<T, std::uint8_t>)
            if (curved) return srgb8_from_linear(value);
        const float encoded = std::clamp(curved ? srgb_from_linear(value) : value, 0.0f, 1.0f);
        // NOLINTNEXTLINE(bugprone-incorrect-roundings): it is never negative
        return static_cast<T>(encoded * static_cast<float>(std::numeric_limits<T>::max()) + 0.5f);
    } else {
        return static_cast<T>(curved ? srgb_from_linear(value) : value);
    }
}

/// The texels of a row of `size` that one texel of the row of half the size covers, and how much of each.
struct Coverage {
    int first = 0;
    int count = 0;
    std::array<float, 4> weight{};  ///< their sum is 1
};

Coverage coverage(int texel, int size, int half_size) {
    // In exact integers: texel i covers [i size, (i + 1) size) / half_size.
    const std::int64_t begin = std::int64_t{texel} * size;
    const std::int64_t end = begin + size;
    Coverage result;
    result.first = static_cast<int>(begin / half_size);
    for (std::int64_t i = result.first; i * half_size < end; ++i) {
        const std::int64_t covered = std::min(end, (i + 1) * half_size) - std::max(begin, i * half_size);
        result.weight[static_cast<std::size_t>(result.count++)] =
            static_cast<float>(covered) / static_cast<float>(size);
    }
    return result;
}

std::vector<Coverage> coverages(int size, int half_size) {
    std::vector<Coverage> result;
    result.reserve(static_cast<std::size_t>(half_size));
    for (int i = 0; i < half_size; ++i) result.push_back(coverage(i, size, half_size));
    return result;
}

/// Returns the image at half its size in linear light. `fetch(x, y, c)` is linear.
template <typename Fetch>
ImageF halve(int width, int height, int channels, const Fetch& fetch) {
    ImageF half(std::max(1, width / 2), std::max(1, height / 2), channels);
    const std::vector<Coverage> columns = coverages(width, half.width);
    for (int y = 0; y < half.height; ++y) {
        const Coverage rows = coverage(y, height, half.height);
        for (int x = 0; x < half.width; ++x) {
            const Coverage& column = columns[static_cast<std::size_t>(x)];
            const auto pixel = half.pixel(x, y);
            for (int j = 0; j < rows.count; ++j)
                for (int i = 0; i < column.count; ++i) {
                    const float weight =
                        rows.weight[static_cast<std::size_t>(j)] * column.weight[static_cast<std::size_t>(i)];
                    for (int c = 0; c < channels; ++c)
                        pixel[static_cast<std::size_t>(c)] += weight * fetch(column.first + i, rows.first + j, c);
                }
        }
    }
    return half;
}

ImageF halve(const ImageF& image) {
    return halve(image.width, image.height, image.channels,
                 [&](int x, int y, int c) { return image.pixel(x, y)[static_cast<std::size_t>(c)]; });
}

/// Divides the colours of mip levels, each times its alpha, by that; where alpha is nothing, the next level's stand in.
void divide_by_alpha(std::span<ImageF> levels) {
    const ImageF* coarser = nullptr;
    for (auto level = levels.rbegin(); level != levels.rend(); coarser = &*level++)
        for (int y = 0; y < level->height; ++y)
            for (int x = 0; x < level->width; ++x) {
                const auto texel = level->pixel(x, y);
                const auto colors = texel.first(texel.size() - 1);
                if (texel.back() > 0.0f)
                    for (float& color : colors) color /= texel.back();
                else if (coarser != nullptr)
                    std::ranges::copy(
                        coarser->pixel(std::min(x / 2, coarser->width - 1), std::min(y / 2, coarser->height - 1))
                            .first(colors.size()),
                        colors.begin());
            }
}

/// `a` where both are equal, without rounding.
Texel mix(const Texel& a, const Texel& b, float t) {
    return {lerp(a.rgb, b.rgb, t), a.alpha + (b.alpha - a.alpha) * t};
}

}  // namespace

int mip_level_count(int width, int height) {
    int count = 1;
    for (int size = std::max(width, height); size > 1; size /= 2) ++count;
    return count;
}

std::uint64_t mip_texel_count(int width, int height) {
    std::uint64_t count = 0;
    for (int i = mip_level_count(width, height); i > 0; --i) {
        count += static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
        width = std::max(1, width / 2);
        height = std::max(1, height / 2);
    }
    return count;
}

std::uint64_t slope_covariance_bytes(int width, int height) {
    const auto image = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    return (mip_texel_count(width, height) - image) * 3 * sizeof(Float16);
}

MipChain::MipChain(std::vector<NativeImage> levels, Encoding encoding, MipLevels wanted)
    : encoding_(encoding), decoding8_(encoding == Encoding::Srgb ? &srgb_decoding8() : &linear_decoding8()) {
    std::visit(
        [&]<typename T>(const Image<T>& image) {
            channels_ = image.channels;
            std::vector<T> values = take_levels<T>(levels);
            if (wanted != MipLevels::AsGiven) add_levels(values, wanted == MipLevels::AllByAlpha);
            values_ = std::move(values);
        },
        levels.front());
}

template <typename T>
std::vector<T> MipChain::take_levels(std::vector<NativeImage>& images) {
    std::vector<T> values;
    for (NativeImage& native : images) {
        auto& level = std::get<Image<T>>(native);
        levels_.push_back({level.width, level.height, values.size() / static_cast<std::size_t>(channels_)});
        if (values.empty()) {
            values = std::move(level.pixels);
        } else {
            values.resize(values.size() + level.pixels.size());
            std::ranges::copy_backward(level.pixels, values.end());
        }
    }
    // One texel that is no number would spoil all that it is averaged with.
    if constexpr (!std::is_integral_v<T>) (void)make_finite(std::span(values));
    return values;
}

template <typename T>
void MipChain::add_levels(std::vector<T>& values, bool by_alpha) {
    const int last_channel = channels_ - 1;
    by_alpha = by_alpha && is_alpha(last_channel, channels_);
    const auto channels = static_cast<std::size_t>(channels_);
    values.reserve(static_cast<std::size_t>(mip_texel_count(width(), height())) * channels);
    const auto curved = [&](int c) { return encoding_ == Encoding::Srgb && !is_alpha(c, channels_); };
    const Level last = levels_.back();
    const auto stored = [&](int x, int y, int c) {
        const std::size_t texel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(last.width) + static_cast<std::size_t>(x);
        const T* const first = &values[(last.first + texel) * channels];
        const float value = decode(first[c], curved(c));
        if (!by_alpha) return value;
        const float alpha = std::clamp(decode(first[last_channel], false), 0.0f, 1.0f);
        return c == last_channel ? alpha : value * alpha;
    };
    const auto append = [&](const ImageF& level) {
        levels_.push_back({level.width, level.height, values.size() / channels});
        for (std::size_t i = 0; i < level.pixels.size(); ++i)
            values.push_back(encode<T>(level.pixels[i], curved(static_cast<int>(i % channels))));
    };
    std::vector<ImageF> averages;  // not rounded, so that errors do not add up from level to level
    for (int missing = mip_level_count(width(), height()) - level_count(); missing > 0; --missing) {
        averages.push_back(averages.empty() ? halve(last.width, last.height, channels_, stored)
                                            : halve(averages.back()));
        if (by_alpha) continue;
        append(averages.back());
        averages.erase(averages.begin(), averages.end() - 1);
    }
    if (!by_alpha) return;
    divide_by_alpha(averages);
    for (const ImageF& level : averages) append(level);
}

template <typename T>
float MipChain::decode_color(T value) const {
    if constexpr (std::is_same_v<T, std::uint8_t>) return (*decoding8_)[value];
    return decode(value, encoding_ == Encoding::Srgb);
}

template <int Channels, typename T>
Texel MipChain::read_texel(const T* texel) const {
    if constexpr (Channels == 1) return {Rgb(decode_color(texel[0])), 1.0f};
    if constexpr (Channels == 2) return {Rgb(decode_color(texel[0])), decode(texel[1], false)};
    if constexpr (Channels == 3)
        return {{decode_color(texel[0]), decode_color(texel[1]), decode_color(texel[2])}, 1.0f};
    if constexpr (Channels == 4)
        return {{decode_color(texel[0]), decode_color(texel[1]), decode_color(texel[2])}, decode(texel[3], false)};
}

template <typename Read>
auto MipChain::sample_level(Vec2f uv, const Level& level, bool nearest, const TextureOptions& options,
                            const Read& read) const {
    const float x = reduce_coordinate(uv.x, options.wrap_u) * static_cast<float>(level.width);
    const float y = reduce_coordinate(uv.y, options.wrap_v) * static_cast<float>(level.height);
    const auto column = [&](int i) {
        return level.first + static_cast<std::size_t>(wrap_index(i, level.width, options.wrap_u));
    };
    const auto row = [&](int i) {
        return static_cast<std::size_t>(wrap_index(i, level.height, options.wrap_v)) *
               static_cast<std::size_t>(level.width);
    };
    if (nearest) return read(column(static_cast<int>(std::floor(x))) + row(static_cast<int>(std::floor(y))));
    // Texel centres lie at half-integers.
    const float left = std::floor(x - 0.5f);
    const float top = std::floor(y - 0.5f);
    const float fx = x - 0.5f - left;
    const float fy = y - 0.5f - top;
    const std::size_t column0 = column(static_cast<int>(left));
    const std::size_t column1 = column(static_cast<int>(left) + 1);
    const std::size_t row0 = row(static_cast<int>(top));
    const std::size_t row1 = row(static_cast<int>(top) + 1);
    return mix(mix(read(column0 + row0), read(column1 + row0), fx), mix(read(column0 + row1), read(column1 + row1), fx),
               fy);
}

template <typename Read>
auto MipChain::sample_levels(Vec2f uv, float level, bool nearest, const TextureOptions& options,
                             const Read& read) const {
    const float within = std::min(level, static_cast<float>(levels_.size() - 1));
    const float lower = std::floor(within);
    const float fraction = within - lower;
    const Level* const first = &levels_[static_cast<std::size_t>(lower)];
    auto fine = sample_level(uv, *first, nearest, options, read);
    if (fraction == 0.0f) return fine;
    return mix(fine, sample_level(uv, *(first + 1), nearest, options, read), fraction);
}

// Which depth and how many channels is asked once for all texels of a look-up: what reads them knows both.
template <typename Use>
auto MipChain::with_texels(const Use& use) const {
    return std::visit(
        [&](const auto& values) {
            switch (channels_) {
                case 1:
                    return use(values.data(), std::integral_constant<int, 1>());
                case 2:
                    return use(values.data(), std::integral_constant<int, 2>());
                case 3:
                    return use(values.data(), std::integral_constant<int, 3>());
                default:
                    return use(values.data(), std::integral_constant<int, 4>());
            }
        },
        values_);
}

Texel MipChain::sample(Vec2f uv, float level, bool nearest, const TextureOptions& options) const {
    return with_texels([&]<int Channels>(const auto* values, std::integral_constant<int, Channels>) {
        return sample_levels(uv, level, nearest, options,
                             [&](std::size_t i) { return read_texel<Channels>(values + i * Channels); });
    });
}

SlopeDistribution MipChain::sample_slopes(Vec2f uv, float level, bool nearest, const TextureOptions& options) const {
    if (level_count() == 1) return {slope_of(sample(uv, 0.0f, nearest, options).rgb), {}};
    const std::size_t first = levels_[1].first;
    return with_texels([&]<int Channels>(const auto* values, std::integral_constant<int, Channels>) {
        return sample_levels(uv, level, nearest, options, [&](std::size_t i) {
            const Float16* const c = &slope_covariances_[3 * (i - first)];
            return SlopeDistribution{slope_of(read_texel<Channels>(values + i * Channels).rgb), {c[0], c[1], c[2]}};
        });
    });
}

// Moments are averaged without rounding, and from the image: a file's own levels do not know of them.
void MipChain::keep_slopes(bool interpolated) {
    slope_covariances_.reserve(slope_covariance_bytes(width(), height()) / sizeof(Float16));
    ImageF current = with_texels([&]<int Channels>(const auto* values, std::integral_constant<int, Channels>) {
        const auto read_row = [&](int y, std::span<Vec2f> slopes) {
            const auto* texel = values + static_cast<std::size_t>(y) * slopes.size() * Channels;
            for (Vec2f& slope : slopes) {
                slope = slope_of(read_texel<Channels>(texel).rgb);
                texel += Channels;
            }
        };
        SlopeRows rows(width(), height(), interpolated);
        SlopeMoments moments{};
        return halve(width(), height(), static_cast<int>(moments.size()), [&](int x, int y, int c) {
            if (c == 0) moments = rows.moments(x, y, read_row);
            return moments[static_cast<std::size_t>(c)];
        });
    });
    for (int level = 1; level < level_count(); ++level) {
        for (std::size_t i = 0; i < current.pixels.size(); i += std::tuple_size_v<SlopeMoments>) {
            SlopeMoments moments;
            std::copy_n(&current.pixels[i], moments.size(), moments.begin());
            const SlopeCovariance covariance = distribution_of(moments).covariance;
            for (const float value : {covariance.xx, covariance.xy, covariance.yy})
                slope_covariances_.push_back(Float16(value));
        }
        current = halve(current);
    }
}

void MipChain::fetch(Vec2f uv) const {
    const auto texel = [](float coordinate, int size) {
        return std::clamp(static_cast<int>(coordinate * static_cast<float>(size) - 0.5f), 0, size - 1);
    };
    const int column = texel(uv.x, width());
    const int row = texel(uv.y, height());
    std::visit(
        [&](const auto& values) {
            for (const int y : {row, std::min(row + 1, height() - 1)})
                __builtin_prefetch(&values[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width()) +
                                            static_cast<std::size_t>(column)) *
                                           static_cast<std::size_t>(channels_)]);
        },
        values_);
}

Texel MipChain::mean() const {
    return std::visit(
        [&](const auto& values) {
            const bool curved = encoding_ == Encoding::Srgb;
            const std::size_t texel_count = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
            std::array<double, 4> sum{};
            for (std::size_t i = 0; i < texel_count; ++i)
                for (int c = 0; c < channels_; ++c) {
                    const auto channel = static_cast<std::size_t>(c);
                    const auto value = values[i * static_cast<std::size_t>(channels_) + channel];
                    sum[channel] += static_cast<double>(decode(value, curved && !is_alpha(c, channels_)));
                }
            std::array<float, 4> mean{};
            for (std::size_t c = 0; c < mean.size(); ++c)
                mean[c] = static_cast<float>(sum[c] / static_cast<double>(texel_count));
            return make_texel(channels_, mean.data());
        },
        values_);
}

TexelRange MipChain::range() const {
    return with_texels([&]<int Channels>(const auto* values, std::integral_constant<int, Channels>) {
        using Value = std::remove_cvref_t<decltype(*values)>;
        // A multiple of any number of channels, and so large that compilers compare many values at once.
        constexpr std::size_t kBlock = 768;
        const std::size_t count = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()) * Channels;
        std::array<Value, kBlock> least, greatest;
        for (std::size_t j = 0; j < kBlock; ++j) least[j] = greatest[j] = values[j % Channels];
        const auto take = [&](std::size_t j, Value value) {
            least[j] = std::min(least[j], value);
            greatest[j] = std::max(greatest[j], value);
        };
        std::size_t i = 0;
        for (; i + kBlock <= count; i += kBlock)
            for (std::size_t j = 0; j < kBlock; ++j) take(j, values[i + j]);
        for (; i < count; ++i) take(i % kBlock, values[i]);
        for (std::size_t j = 0; j < kBlock; ++j) {
            take(j % Channels, least[j]);
            take(j % Channels, greatest[j]);
        }
        return TexelRange{read_texel<Channels>(least.data()), read_texel<Channels>(greatest.data())};
    });
}

std::size_t MipChain::bytes() const {
    return std::visit([](const auto& values) { return values.size() * sizeof(values[0]); }, values_) +
           slope_covariances_.size() * sizeof(Float16);
}

}  // namespace etendue
