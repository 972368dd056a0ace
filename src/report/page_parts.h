// What pages with data in them are put together from.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// RFC 4648, section 4.
[[nodiscard]] std::string to_base64(std::span<const unsigned char> bytes);

/// A JSON object with a data URL for each of `images`, PNG files by keys.
[[nodiscard]] std::string png_urls(const std::map<std::string, std::vector<unsigned char>>& images);

/// JSON that may stand in a script element: nothing in it ends that.
[[nodiscard]] std::string for_script(std::string_view json);

/// The page `page` with the report and the images, both JSON, at their places. Throws std::logic_error if it has none.
[[nodiscard]] std::string fill_page(std::string_view page, std::string_view report, std::string_view images);

}  // namespace etendue
