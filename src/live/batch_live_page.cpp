#include "live/batch_live_page.h"

#include "core/error.h"
#include "live/live_json.h"
#include "live/page_files.h"
#include "live/render_page.h"
#include "loader/files.h"
#include "session/interrupt.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <thread>
#include <utility>

namespace etendue {

namespace {

constexpr std::chrono::milliseconds kBetweenReports{500};
constexpr std::uintmax_t kMostPictureBytes = std::uintmax_t{1} << 28;

}  // namespace

BatchLivePage::BatchLivePage(int port) : server_(port, [this](const LiveRequest& request) { return answer(request); }) {
    announce_page(server_.url());
}

BatchLivePage::~BatchLivePage() {
    const auto until = Clock::now() + kFarewell;
    while (is_watched() && Clock::now() < until) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

bool BatchLivePage::is_watched() const {
    return Clock::now() - looked_at_.load() < kWatchedFor;
}

bool BatchLivePage::wants_report() const {
    // A tenth of the time at most, however many units there are.
    const Clock::duration between = std::max<Clock::duration>(kBetweenReports, 10 * took_.load());
    return is_watched() && Clock::now() - shown_at_.load() > between;
}

void BatchLivePage::show(const BatchReport& report) {
    const Clock::time_point start = Clock::now();
    shown_at_ = start;
    const bool is_ended = report.state == BatchState::Ended;
    const char* const running = report.state == BatchState::Planning ? "plan" : "render";
    const std::uint64_t version = version_ + 1;
    const nlohmann::json json{{"kind", "batch"},
                              {"title", report.title},
                              {"phase", is_ended ? (report.interrupted ? "stopped" : "finished") : running},
                              {"version", version},
                              {"images", nlohmann::json::array()}};
    // The report is inserted as text: for ten thousand units, parsing it again would cost megabytes of JSON.
    std::string text = text_of(json);
    text.back() = ',';
    text += R"("report":)" + to_json(report) + "}";
    std::vector<std::filesystem::path> pictures;
    pictures.reserve(report.units.size());
    for (const BatchUnit& unit : report.units)
        pictures.push_back(has_image(unit.outcome) && !unit.preview.empty()
                               ? std::filesystem::path(report.output_directory) / unit.preview
                               : std::filesystem::path());
    took_ = Clock::now() - start;
    const std::scoped_lock lock(mutex_);
    version_ = version;
    status_ = std::move(text);
    pictures_ = std::move(pictures);
}

LiveAnswer BatchLivePage::status(const LiveRequest& request) const {
    const auto after = request.query.find("after");
    const std::scoped_lock lock(mutex_);
    if (after != request.query.end() && after->second == std::to_string(version_.load()))
        return LiveAnswer::json(R"({"is_same":true})");
    return LiveAnswer::json(status_);
}

LiveAnswer BatchLivePage::picture(std::size_t unit) const {
    std::filesystem::path path;
    {
        const std::scoped_lock lock(mutex_);
        if (unit < pictures_.size()) path = pictures_[unit];
    }
    if (path.empty()) return LiveAnswer::not_found();
    try {
        const std::vector<unsigned char> bytes = read_bytes(path, kMostPictureBytes);
        return {200, "image/png", std::string(bytes.begin(), bytes.end())};
    } catch (const std::exception&) {
        return LiveAnswer::not_found();  // it may have been taken away
    }
}

LiveAnswer BatchLivePage::answer(const LiveRequest& request) {
    if (request.is_post) {
        if (request.path != "stop") return LiveAnswer::not_found();
        request_interrupt();
        return LiveAnswer::json("{}");
    }
    if (request.path == "status") {
        looked_at_ = Clock::now();
        return status(request);
    }
    if (request.path == "displays") return LiveAnswer::json("[]");
    if (request.path == "picture.png") {
        std::size_t unit = ~std::size_t{0};
        if (const auto found = request.query.find("unit"); found != request.query.end())
            std::from_chars(found->second.data(), found->second.data() + found->second.size(), unit);
        return picture(unit);
    }
    return page_file(request.path);
}

}  // namespace etendue
