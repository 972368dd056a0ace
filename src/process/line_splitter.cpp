#include "process/line_splitter.h"

#include <algorithm>

namespace etendue {

void LineSplitter::add(std::string_view text, const Callback& take) {
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string_view piece = text.substr(0, end);
        line_.append(piece.substr(0, std::min(piece.size(), longest_ - line_.size())));
        if (end == std::string_view::npos) return;
        take(line_);
        line_.clear();
        text.remove_prefix(end + 1);
    }
}

void LineSplitter::finish(const Callback& take) {
    if (!line_.empty()) take(line_);
    line_.clear();
}

}  // namespace etendue
