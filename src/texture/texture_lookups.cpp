#include "texture/texture_lookups.h"

#include "texture/texel_pair.h"

#include <algorithm>

namespace etendue {

namespace {

constexpr std::size_t kCorners = 4;  // of the square of texel centres around a tap
constexpr std::size_t kChannels = 3;

WrapMode<Wide> load_wrap(const Column& clamps, const Column& mirrors, std::size_t first) {
    return {clamps.load(first) > Wide(0.0f), mirrors.load(first) > Wide(0.0f)};
}

float flag(bool set) {
    return set ? 1.0f : 0.0f;
}

}  // namespace

void TextureLookups::clear() {
    results_.clear();
    lookups_ = 0;
}

void TextureLookups::add(const Texture& texture, Vec2f uv, const TextureFootprint& footprint) {
    const MipChain* const texels = texture.usual_texels();
    if (texels == nullptr) {
        results_.push_back(texture.lookup(uv, footprint).rgb);
        return;
    }
    if (lookups_ == kBlockLanes) finish();
    const std::size_t lookup = lookups_++;
    textures_[lookup] = &texture;
    chains_[lookup] = texels;
    result_of_[lookup] = static_cast<std::uint32_t>(results_.size());
    results_.emplace_back();
    uv_.set(lookup, uv);
    diameter0_.set(lookup, footprint.diameter[0]);
    diameter1_.set(lookup, footprint.diameter[1]);
    size_.set(lookup, {static_cast<float>(texels->width()), static_cast<float>(texels->height())});
    last_level_.set(lookup, static_cast<float>(texels->level_count() - 1));
}

void TextureLookups::finish() {
    plan_lookups();
    for (std::size_t lookup = 0; lookup < lookups_; ++lookup) add_taps(lookup);
    read_taps();
    for (std::size_t lookup = 0; lookup < lookups_; ++lookup)
        if (count_[lookup] > 1.0f) results_[result_of_[lookup]] *= 1.0f / count_[lookup];
    lookups_ = 0;
}

void TextureLookups::plan_lookups() {
    for (std::size_t l = 0; l < lookups_; l += Wide::kWidth) {
        const FilterTaps<Wide> taps = plan_taps(diameter0_.load(l), diameter1_.load(l), size_.load(l));
        const Wide within = min(taps.level, last_level_.load(l));
        const Wide level = floor(within);
        count_.store(l, taps.count);
        step_.store(l, taps.step);
        level_.store(l, level);
        fraction_.store(l, within - level);
    }
}

void TextureLookups::add_taps(std::size_t lookup) {
    const MipChain& texels = *chains_[lookup];
    const TextureOptions& options = textures_[lookup]->options();
    const int level = static_cast<int>(level_[lookup]);
    const MipChain::Level8 fine = texels.level8(level);
    const MipChain::Level8 coarse = fraction_[lookup] > 0.0f ? texels.level8(level + 1) : fine;
    const auto to_level = [](const MipChain::Level8& l) { return Level{l.texels, static_cast<std::size_t>(l.width)}; };
    const auto size = [](const MipChain::Level8& l) {
        return Vec2f(static_cast<float>(l.width), static_cast<float>(l.height));
    };
    const Vec2f step = step_[lookup];
    Vec2f at = uv_[lookup] - step * (0.5f * (count_[lookup] - 1.0f));
    for (int i = static_cast<int>(count_[lookup]); i > 0; --i, at += step) {
        if (taps_ == kBlockLanes) read_taps();
        const std::size_t tap = taps_++;
        tap_[tap] = {{to_level(fine), to_level(coarse)}, static_cast<std::uint8_t>(lookup)};
        tap_uv_.set(tap, at);
        tap_size_[0].set(tap, size(fine));
        tap_size_[1].set(tap, size(coarse));
        tap_fraction_.set(tap, fraction_[lookup]);
        clamps_.set(tap, {flag(options.wrap_u == Wrap::Clamp), flag(options.wrap_v == Wrap::Clamp)});
        mirrors_.set(tap, {flag(options.wrap_u == Wrap::Mirror), flag(options.wrap_v == Wrap::Mirror)});
    }
}

void TextureLookups::read_taps() {
    for (std::size_t l = 0; l < taps_; l += Wide::kWidth) {
        BasicRgb<Wide> value = read_level(l, 0);
        const auto is_between = [&](std::size_t lane) { return tap_fraction_[lane] > 0.0f; };
        bool any_between = false;
        for (std::size_t lane = l; lane < std::min(l + Wide::kWidth, taps_); ++lane) any_between |= is_between(lane);
        if (any_between) value = lerp(value, read_level(l, 1), tap_fraction_.load(l));
        tap_value_.store(l, value);
    }
    for (std::size_t tap = 0; tap < taps_; ++tap) results_[result_of_[tap_[tap].lookup]] += tap_value_[tap];
    taps_ = 0;
}

BasicRgb<Wide> TextureLookups::read_level(std::size_t first, std::size_t level) {
    const Imath::Vec2<Wide> uv = tap_uv_.load(first);
    const Imath::Vec2<Wide> size = tap_size_[level].load(first);
    const TexelPair<Wide> columns = texel_pair(uv.x, size.x, load_wrap(clamps_.x, mirrors_.x, first));
    const TexelPair<Wide> rows = texel_pair(uv.y, size.y, load_wrap(clamps_.y, mirrors_.y, first));
    using Lanes = std::array<float, Wide::kWidth>;
    alignas(Wide::kAlignment) std::array<Lanes, 4> whole;
    columns.first.store(whole[0].data());
    columns.second.store(whole[1].data());
    rows.first.store(whole[2].data());
    rows.second.store(whole[3].data());
    alignas(Wide::kAlignment) std::array<std::array<Lanes, kChannels>, kCorners> values{};
    const std::size_t end = std::min(first + Wide::kWidth, taps_);
    for (std::size_t tap = first; tap < end; ++tap) {
        if (level > 0 && tap_fraction_[tap] == 0.0f) continue;
        const std::size_t lane = tap - first;
        const Level& texels = tap_[tap].levels[level];
        const MipChain& chain = *chains_[tap_[tap].lookup];
        const Decoding8& decoded = chain.decoding8();
        const auto channels = static_cast<std::size_t>(chain.channels());
        const bool is_grey = channels < kChannels;
        const std::size_t green = is_grey ? 0 : 1;
        const std::size_t blue = is_grey ? 0 : 2;
        for (std::size_t corner = 0; corner < kCorners; ++corner) {
            const auto x = static_cast<std::size_t>(whole[corner % 2][lane]);
            const auto y = static_cast<std::size_t>(whole[2 + corner / 2][lane]);
            const std::uint8_t* const texel = texels.texels + (y * texels.width + x) * channels;
            values[corner][0][lane] = decoded[texel[0]];
            values[corner][1][lane] = decoded[texel[green]];
            values[corner][2][lane] = decoded[texel[blue]];
        }
    }
    const auto corner = [&](std::size_t i) {
        return BasicRgb<Wide>(Wide::load(values[i][0].data()), Wide::load(values[i][1].data()),
                              Wide::load(values[i][2].data()));
    };
    return lerp(lerp(corner(0), corner(1), columns.fraction), lerp(corner(2), corner(3), columns.fraction),
                rows.fraction);
}

}  // namespace etendue
