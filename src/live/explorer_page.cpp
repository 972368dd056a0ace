#include "live/explorer_page.h"

#include "core/error.h"
#include "live/live_json.h"
#include "live/page_files.h"
#include "live/render_page.h"
#include "picture/render_setup.h"
#include "session/usage_error.h"

#include <algorithm>
#include <charconv>
#include <utility>
#include <vector>

#include <fmt/format.h>
namespace etendue {

namespace {

/// Reads a whole number in the query or in a form of the page; 0 if there is none.
std::uint64_t whole_number(const std::string& text) {
    std::uint64_t number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

std::uint64_t whole_number(const LiveRequest& request, std::string_view name) {
    const auto found = request.query.find(name);
    return found == request.query.end() ? 0 : whole_number(found->second);
}

/// Lists the nine numbers of a place: eye, target and up.
std::vector<double> numbers_of(const CameraPlace& place) {
    std::vector<double> numbers;
    for (const Vec3d& v : {place.eye, place.target, place.up}) numbers.insert(numbers.end(), {v.x, v.y, v.z});
    return numbers;
}

}  // namespace

ExplorerPage::ExplorerPage(int port, Explorer& explorer)
    : explorer_(explorer), server_(port, [this](const LiveRequest& request) { return answer(request); }) {
    announce_page(server_.url());
}

std::string ExplorerPage::status() const {
    const std::uint64_t serial = explorer_.serial();
    nlohmann::json sides = nlohmann::json::array();
    nlohmann::json images = nlohmann::json::array();
    const std::array<ExplorerSide, 2> all = explorer_.sides();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const ExplorerSide& side = all.at(i);
        sides.push_back({{"shown", side.choice.is_shown},
                         {"integrator", side.choice.integrator},
                         {"depth", side.choice.max_depth},
                         {"more", side.choice.more},
                         {"seconds", side.cpu_seconds},
                         {"rays", side.rays},
                         {"command", side.command}});
        nlohmann::json facts = json_of(explorer_.image(i).facts());
        if (!facts.is_null()) std::tie(facts["full_width"], facts["full_height"]) = explorer_.size();
        images.push_back(std::move(facts));
    }
    const nlohmann::json json{{"kind", "explore"},
                              {"title", explorer_.name()},
                              {"phase", "render"},
                              {"serial", serial},
                              {"camera", numbers_of(explorer_.camera())},
                              {"own_camera", numbers_of(explorer_.own_camera())},
                              {"integrators", integrator_names()},
                              {"sides", std::move(sides)},
                              {"images", std::move(images)}};
    return text_of(json);
}

LiveAnswer ExplorerPage::follow(const LiveRequest& request) {
    const nlohmann::json asked = nlohmann::json::parse(request.body);
    if (request.path == "camera") {
        const auto place = asked.at("place").get<std::vector<double>>();
        explorer_.move_camera(fmt::format("{}", fmt::join(place, ",")), asked.at("moves").get<bool>());
    } else {
        const auto depth = whole_number(asked.at("depth").get<std::string>());
        const ExplorerChoice choice{.is_shown = asked.at("shown").get<bool>(),
                                    .integrator = asked.at("integrator").get<std::string>(),
                                    .max_depth = static_cast<int>(std::min<std::uint64_t>(depth, 1 << 20)),
                                    .more = asked.at("more").get<std::string>()};
        const auto index = asked.at("index").get<std::size_t>();
        if (index > 1) throw UsageError("the page has only two sides, 0 and 1");
        explorer_.choose(index, choice);
    }
    return LiveAnswer::json("{}");
}

LiveAnswer ExplorerPage::answer(const LiveRequest& request) {
    const std::size_t side = std::min<std::uint64_t>(whole_number(request, "side"), 1);
    if (request.is_post) {
        if (request.path == "stop") {
            is_ended_ = true;
            return LiveAnswer::json("{}");
        }
        if (request.path != "camera" && request.path != "side") return LiveAnswer::not_found();
        try {
            return follow(request);
        } catch (const UsageError& error) {
            return LiveAnswer::refused(error.what());
        } catch (const SceneError& error) {
            return LiveAnswer::refused(error.what());
        } catch (const nlohmann::json::exception&) {
            return LiveAnswer::refused("the page sent what is not understood");
        }
    }
    if (request.path == "status") {
        explorer_.wait_for_news(whole_number(request, "after"));
        return LiveAnswer::json(status());
    }
    if (request.path == "displays") return LiveAnswer::json(text_of(displays_of(explorer_.colors())));
    if (request.path == "image.png") return explorer_.image(side).png(request);
    if (request.path == "pixel") return explorer_.image(side).pixel(request);
    return page_file(request.path);
}

}  // namespace etendue
