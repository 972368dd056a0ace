#include "report/comparison_report.h"
#include "report/page_parts.h"
#include "report/page_templates.h"

#include <nlohmann/json.hpp>

namespace etendue {

std::string make_page(const ComparisonReport& report, const ReportImages& images) {
    nlohmann::json urls = nlohmann::json::object();
    for (const auto& [key, png] : images) urls[key] = "data:image/png;base64," + to_base64(png);
    return fill_page(comparison_page_template(), to_json(report),
                     urls.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace etendue
