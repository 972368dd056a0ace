#include "report/page_parts.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

void replace(std::string& page, std::string_view placeholder, const std::string& text) {
    const std::size_t at = page.find(placeholder);
    if (at == std::string::npos) throw std::logic_error("the page has no place for its data");
    page.replace(at, placeholder.size(), text);
}

}  // namespace

std::string to_base64(std::span<const unsigned char> bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j) group = group << 8 | (j < count ? bytes[i + j] : 0u);
        for (std::size_t j = 0; j < 4; ++j) text += j <= count ? kDigits[group >> (6 * (3 - j)) & 63u] : '=';
    }
    return text;
}

std::string png_urls(const std::map<std::string, std::vector<unsigned char>>& images) {
    nlohmann::json urls = nlohmann::json::object();
    for (const auto& [key, png] : images) urls[key] = "data:image/png;base64," + to_base64(png);
    return urls.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string for_script(std::string_view json) {
    std::string text;
    text.reserve(json.size());
    for (const char c : json) {
        if (c == '<')
            text += "\\u003c";
        else
            text += c;
    }
    return text;
}

std::string fill_page(std::string_view page, std::string_view report, std::string_view images) {
    std::string filled(page);
    // From the back: what is put in may say anything.
    replace(filled, "@IMAGES@", for_script(images));
    replace(filled, "@REPORT@", for_script(report));
    return filled;
}

}  // namespace etendue
