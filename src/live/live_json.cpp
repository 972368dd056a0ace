#include "live/live_json.h"

namespace etendue {

nlohmann::json json_of(const std::optional<LiveImageFacts>& facts) {
    if (!facts) return {};
    return {{"version", facts->version}, {"width", facts->width},
            {"height", facts->height},   {"layers", facts->layers},
            {"spp", facts->spp},         {"integrator", facts->integrator},
            {"space", facts->space},     {"display", facts->shown.display},
            {"view", facts->shown.view}, {"exposure", facts->shown.exposure}};
}

nlohmann::json displays_of(const ColorConfig& colors) {
    nlohmann::json list = nlohmann::json::array();
    for (const std::string& display : colors.displays())
        list.push_back({{"name", display}, {"views", colors.views(display)}});
    return list;
}

std::string text_of(const nlohmann::json& json) {
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace etendue
