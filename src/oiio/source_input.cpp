#include "oiio/source_input.h"

#include "core/error.h"

#include <span>

namespace etendue::oiio {

namespace {

OIIO::TypeDesc type_of(TexelDepth depth) {
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

}  // namespace

bool SourceInput::open(const std::string& name, OIIO::ImageSpec& spec) {
    return open(name, spec, {});
}

bool SourceInput::open(const std::string&, OIIO::ImageSpec& spec, const OIIO::ImageSpec& config) {
    void* open_pieces = nullptr;
    if (!config.getattribute(kOpenAttribute, OIIO::TypeDesc::PTR, &open_pieces)) {
        errorfmt("no image was named");
        return false;
    }
    try {
        pieces_ = (*static_cast<const OpenPieces*>(open_pieces))();
    } catch (const IoError& error) {
        errorfmt("{}", error.what());
        return false;
    }
    level_ = -1;
    if (!seek_subimage(0, 0)) return false;
    spec = m_spec;
    return true;
}

bool SourceInput::close() {
    pieces_.reset();
    return true;
}

bool SourceInput::seek_subimage(int subimage, int level) {
    if (!pieces_ || subimage != 0 || level < 0 || level >= static_cast<int>(pieces_->levels().size())) return false;
    if (level == level_) return true;
    const ImageInfo& info = pieces_->info();
    const ImageLevel& size = pieces_->levels()[static_cast<std::size_t>(level)];
    m_spec = OIIO::ImageSpec(size.width, size.height, info.decoded_channels, type_of(info.depth));
    m_spec.tile_width = pieces_->tile().width;
    m_spec.tile_height = pieces_->tile().height;
    level_ = level;
    return true;
}

template <typename Read>
bool SourceInput::convert(std::size_t pixel_count, void* data, const Read& read) {
    values_.resize(pixel_count * static_cast<std::size_t>(m_spec.nchannels));
    try {
        read(std::span(values_));
    } catch (const IoError& error) {
        errorfmt("{}", error.what());
        return false;
    }
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
                   [&](std::span<float> values) { pieces_->read_rows(level, y_begin, y_end, values); });
}

bool SourceInput::read_native_tile(int subimage, int level, int x, int y, int, void* data) {
    lock_guard lock(*this);
    if (!seek_subimage(subimage, level)) return false;
    const std::size_t pixel_count =
        static_cast<std::size_t>(m_spec.tile_width) * static_cast<std::size_t>(m_spec.tile_height);
    return convert(pixel_count, data, [&](std::span<float> values) { pieces_->read_tile(level, x, y, values); });
}

}  // namespace etendue::oiio
