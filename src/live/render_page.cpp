#include "live/render_page.h"

#include "core/log.h"
#include "live/live_json.h"
#include "live/page_files.h"
#include "session/interrupt.h"

#include <thread>
#include <utility>

namespace etendue {

void announce_page(const std::string& url) {
    log_info("live: {}", url);
}

RenderPage::RenderPage(int port) : server_(port, [this](const LiveRequest& request) { return answer(request); }) {
    announce_page(server_.url());
}

RenderPage::~RenderPage() {
    const auto until = Clock::now() + kFarewell;
    while (is_watched() && Clock::now() < until) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

void RenderPage::begin(const std::string& title, const std::filesystem::path& output) {
    const std::scoped_lock lock(mutex_);
    title_ = title;
    output_ = output;
    progress_ = {};
    error_.reset();
    spp_requested_ = 0;
}

void RenderPage::enter(std::string_view phase) {
    const std::scoped_lock lock(mutex_);
    phase_ = phase;
}

void RenderPage::update(const RenderProgress& progress) {
    const std::scoped_lock lock(mutex_);
    progress_ = progress;
}

bool RenderPage::is_watched() const {
    return Clock::now() - looked_at_.load() < kWatchedFor;
}

bool RenderPage::wants_image() const {
    return is_watched();
}

void RenderPage::show(const ImageDescription& image) {
    image_.set(image.frame);
    const std::scoped_lock lock(mutex_);
    spp_requested_ = image.statistics.spp_requested;
    error_ = image.statistics.relative_error;
}

std::string RenderPage::status() const {
    const RenderProgress& p = progress_;
    nlohmann::json json{{"kind", "render"},
                        {"title", title_},
                        {"output", output_.string()},
                        {"phase", phase_},
                        {"spp_requested", spp_requested_},
                        {"error", error_ ? nlohmann::json(*error_) : nlohmann::json()},
                        {"fraction", p.fraction},
                        {"seconds", p.seconds},
                        {"samples", p.samples},
                        {"rays", p.rays},
                        {"images", nlohmann::json::array({json_of(image_.facts())})}};
    return text_of(json);
}

LiveAnswer RenderPage::answer(const LiveRequest& request) {
    if (request.is_post) {
        if (request.path == "stop")
            request_interrupt();
        else if (request.path == "preview")
            request_preview();
        else
            return LiveAnswer::not_found();
        return LiveAnswer::json("{}");
    }
    if (request.path == "status") {
        looked_at_ = Clock::now();
        const std::scoped_lock lock(mutex_);
        return LiveAnswer::json(status());
    }
    if (request.path == "displays") return LiveAnswer::json(text_of(displays_of(colors_)));
    if (request.path == "image.png") return image_.png(request);
    if (request.path == "pixel") return image_.pixel(request);
    return page_file(request.path);
}

}  // namespace etendue
