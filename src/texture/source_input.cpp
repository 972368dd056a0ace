#include "texture/source_input.h"

#include "core/error.h"
#include "texture/mip_chain.h"
#include "texture/srgb.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace etendue {

namespace {

ImageSource to_image_source(const TextureCache::Source& source) {
    if (const auto* path = std::get_if<std::filesystem::path>(&source)) return *path;
    return std::span<const std::byte>(*std::get<1>(source));
}

OIIO::TypeDesc shown_type(TexelDepth depth, Encoding encoding) {
    if (encoding == Encoding::Srgb && depth != TexelDepth::Float) return OIIO::TypeDesc::HALF;
    switch (depth) {
        case TexelDepth::UInt8:
            return OIIO::TypeDesc::UINT8;
        case TexelDepth::UInt16:
            return OIIO::TypeDesc::UINT16;
        case TexelDepth::Half:
            return OIIO::TypeDesc::HALF;
        case TexelDepth::Float:
            break;
    }
    return OIIO::TypeDesc::FLOAT;
}

void linearize(std::span<float> values, TexelDepth depth, int channels) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (is_alpha(static_cast<int>(i % static_cast<std::size_t>(channels)), channels)) continue;
        values[i] = depth == TexelDepth::UInt8 ? linear_from_srgb8(static_cast<std::uint8_t>(values[i] * 255.0f + 0.5f))
                                               : linear_from_srgb(values[i]);
    }
}

}  // namespace

bool SourceInput::open(const std::string& name, OIIO::ImageSpec& spec) {
    return open(name, spec, {});
}

bool SourceInput::open(const std::string&, OIIO::ImageSpec& spec, const OIIO::ImageSpec& config) {
    void* entry = nullptr;
    if (!config.getattribute(kEntryAttribute, OIIO::TypeDesc::PTR, &entry)) {
        errorfmt("no image was named");
        return false;
    }
    entry_ = static_cast<const CacheEntry*>(entry);
    try {
        reader_.emplace(to_image_source(entry_->source));
    } catch (const IoError& error) {
        errorfmt("{}", error.what());
        return false;
    }
    const ImageInfo& info = reader_->info();
    const auto levels = static_cast<int>(reader_->levels().size());
    level_count_ = levels == mip_level_count(info.width, info.height) ? levels : 1;
    level_ = -1;
    if (!seek_subimage(0, 0)) return false;
    spec = m_spec;
    return true;
}

bool SourceInput::close() {
    reader_.reset();
    return true;
}

bool SourceInput::seek_subimage(int subimage, int level) {
    if (!reader_ || subimage != 0 || level < 0 || level >= level_count_) return false;
    if (level == level_) return true;
    const ImageInfo& info = reader_->info();
    const ImageLevel& size = reader_->levels()[static_cast<std::size_t>(level)];
    m_spec = OIIO::ImageSpec(size.width, size.height, info.decoded_channels, shown_type(info.depth, entry_->encoding));
    m_spec.tile_width = reader_->tile().width;
    m_spec.tile_height = reader_->tile().height;
    level_ = level;
    return true;
}

template <typename Read>
bool SourceInput::convert(std::size_t pixel_count, void* data, const Read& read) {
    const ImageInfo& info = reader_->info();
    values_.resize(pixel_count * static_cast<std::size_t>(info.decoded_channels));
    try {
        read(std::span(values_));
    } catch (const IoError& error) {
        errorfmt("{}", error.what());
        return false;
    }
    for (float& value : values_)
        if (!std::isfinite(value)) value = 0.0f;
    if (entry_->encoding == Encoding::Srgb) linearize(values_, info.depth, info.decoded_channels);
    return OIIO::convert_pixel_values(OIIO::TypeDesc::FLOAT, values_.data(), m_spec.format, data,
                                      static_cast<int>(values_.size()));
}

bool SourceInput::read_native_scanline(int subimage, int level, int y, int z, void* data) {
    return read_native_scanlines(subimage, level, y, y + 1, z, data);
}

bool SourceInput::read_native_scanlines(int subimage, int level, int y_begin, int y_end, int, void* data) {
    lock_guard lock(*this);
    if (!seek_subimage(subimage, level)) return false;
    const std::size_t pixel_count = static_cast<std::size_t>(m_spec.width) * static_cast<std::size_t>(y_end - y_begin);
    return convert(pixel_count, data,
                   [&](std::span<float> values) { reader_->read_rows(level, y_begin, y_end, values); });
}

bool SourceInput::read_native_tile(int subimage, int level, int x, int y, int, void* data) {
    lock_guard lock(*this);
    if (!seek_subimage(subimage, level)) return false;
    const std::size_t pixel_count =
        static_cast<std::size_t>(m_spec.tile_width) * static_cast<std::size_t>(m_spec.tile_height);
    return convert(pixel_count, data, [&](std::span<float> values) { reader_->read_tile(level, x, y, values); });
}

}  // namespace etendue
