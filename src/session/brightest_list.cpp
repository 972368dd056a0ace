#include "session/brightest_list.h"

#include "core/log.h"
#include "core/shown_text.h"

#include <fmt/format.h>

namespace etendue {

void list_brightest(const RenderStatistics& statistics) {
    if (statistics.brightest.empty()) return;
    log_info("brightest contributions:{:>13} {:>8} {:>30}  {:>7} {:>5}  path", "pixel", "sample", "value", "(s,t)",
             "edges");
    for (const BrightContribution& c : statistics.brightest) {
        const std::string value = fmt::format("{:.4g} {:.4g} {:.4g}", c.value[0], c.value[1], c.value[2]);
        const bool is_known = !c.path.empty();
        log_info("{:>37} {:>8} {:>30}  {:>7} {:>5}  {}", fmt::format("({}, {})", c.x, c.y), c.sample, value,
                 is_known ? fmt::format("({},{})", c.s, c.t) : "?", is_known ? fmt::format("{}", c.edges) : "?",
                 is_known ? shown_text(c.path) : "not known");
    }
}

}  // namespace etendue
