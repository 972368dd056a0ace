#include "oiio/shown_bytes.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace etendue::oiio {

ShownBytes::ShownBytes(std::unique_ptr<OIIO::Filesystem::IOProxy> whole, std::vector<FilePiece> pieces)
    : IOProxy("", Read), whole_(std::move(whole)), pieces_(std::move(pieces)) {
    std::uint64_t end = 0;
    for (const FilePiece& piece : pieces_) {
        end += piece.size;
        ends_.push_back(end);
    }
}

std::size_t ShownBytes::size() const {
    return ends_.empty() ? 0 : ends_.back();
}

std::size_t ShownBytes::read(void* bytes, std::size_t count) {
    const std::size_t got = pread(bytes, count, m_pos);
    m_pos += static_cast<std::int64_t>(got);
    return got;
}

std::size_t ShownBytes::pread(void* bytes, std::size_t count, std::int64_t offset) {
    if (offset < 0) return 0;
    auto place = static_cast<std::uint64_t>(offset);
    auto i = static_cast<std::size_t>(std::ranges::upper_bound(ends_, place) - ends_.begin());
    auto* target = static_cast<unsigned char*>(bytes);
    std::size_t left = count;
    for (; left > 0 && i < pieces_.size(); ++i) {
        const FilePiece& piece = pieces_[i];
        const std::uint64_t inside = place - (ends_[i] - piece.size);
        const auto length = static_cast<std::size_t>(std::min<std::uint64_t>(left, piece.size - inside));
        std::size_t got = length;
        if (piece.is_blank)
            std::memset(target, 0, length);
        else
            got = whole_->pread(target, length, static_cast<std::int64_t>(piece.begin + inside));
        left -= std::min(got, length);
        if (got != length) break;
        target += length;
        place += length;
    }
    return count - left;
}

}  // namespace etendue::oiio
