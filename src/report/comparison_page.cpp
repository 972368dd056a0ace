#include "report/comparison_report.h"
#include "report/page_template.h"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

/// RFC 4648, section 4.
std::string to_base64(const std::vector<unsigned char>& bytes) {
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

/// JSON that may stand in a script element: nothing in it ends that.
std::string for_script(std::string json) {
    std::string text;
    for (const char c : json) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
    return text;
}

void replace(std::string& page, std::string_view placeholder, const std::string& text) {
    const std::size_t at = page.find(placeholder);
    if (at == std::string::npos) throw std::logic_error("the page has no place for its data");
    page.replace(at, placeholder.size(), text);
}

}  // namespace

std::string make_page(const ComparisonReport& report, const ReportImages& images) {
    nlohmann::json urls = nlohmann::json::object();
    for (const auto& [key, png] : images) urls[key] = "data:image/png;base64," + to_base64(png);
    std::string page(page_template());
    // From the back: what is put in may say anything.
    replace(page, "@IMAGES@", for_script(urls.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
    replace(page, "@REPORT@", for_script(to_json(report)));
    return page;
}

}  // namespace etendue
