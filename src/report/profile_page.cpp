#include "report/page_parts.h"
#include "report/page_templates.h"
#include "report/profile_report.h"

namespace etendue {

std::string make_profile_page(const ProfileReport& report, const ProfileImages& images) {
    return fill_page(profile_page_template(), to_json(report), png_urls(images));
}

}  // namespace etendue
