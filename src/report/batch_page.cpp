#include "report/batch_report.h"
#include "report/page_parts.h"
#include "report/page_templates.h"

#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

bool is_unreserved(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("-._~/").find(c) != std::string_view::npos;
}

/// A reference to the file `path` beside the page, whatever its name is: "javascript:x" is a file too.
std::string relative_url(std::string_view path) {
    std::string url = "./";
    for (const char c : path) {
        if (is_unreserved(c))
            url += c;
        else
            url += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return url;
}

std::string data_url(const std::vector<unsigned char>& file) {
    const char* type = file.front() == 0xff ? "image/jpeg" : "image/png";
    return fmt::format("data:{};base64,{}", type, to_base64(file));
}

}  // namespace

std::string make_batch_page(const BatchReport& report, const Thumbnails& thumbnails) {
    if (thumbnails.files.size() != report.units.size())
        throw std::invalid_argument("a batch page takes one thumbnail for each unit");
    nlohmann::json pictures = nlohmann::json::array();
    for (std::size_t i = 0; i < report.units.size(); ++i) {
        const BatchUnit& unit = report.units[i];
        nlohmann::json picture = nlohmann::json::object();
        if (has_image(unit.outcome) && !unit.preview.empty()) picture["link"] = relative_url(unit.preview);
        if (!thumbnails.files[i].empty()) picture["thumbnail"] = data_url(thumbnails.files[i]);
        pictures.push_back(std::move(picture));
    }
    const nlohmann::json images{{"note", thumbnails.note}, {"units", std::move(pictures)}};
    return fill_page(batch_page_template(), to_json(report), images.dump());
}

}  // namespace etendue
