#include "report/comparison_report.h"
#include "report/page_parts.h"
#include "report/page_templates.h"

namespace etendue {

std::string make_page(const ComparisonReport& report, const ReportImages& images) {
    return fill_page(comparison_page_template(), to_json(report), png_urls(images));
}

}  // namespace etendue
