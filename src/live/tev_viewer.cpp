#include "live/tev_viewer.h"

#include "core/error.h"
#include "core/log.h"
#include "core/system_error_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <future>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/types.h>

namespace etendue {

namespace {

constexpr std::chrono::milliseconds kBetweenImages{500};
constexpr std::chrono::milliseconds kPatience{3000};  // for a connection or for any progress
constexpr std::chrono::seconds kPatienceForName{30};
constexpr std::chrono::seconds kLastPatience{10};          // of the end, for all
constexpr std::size_t kMostFloats = std::size_t{1} << 22;  // of a packet, whose length has 32 bits

enum class PacketKind : char { CloseImage = 2, CreateImage = 4, UpdateImageV3 = 6 };

static_assert(std::endian::native == std::endian::little, "packets are little-endian");

/// Puts a packet together: its length in bytes, its kind, and then its fields without gaps.
class Packet {
  public:
    explicit Packet(PacketKind kind) {
        put(std::uint32_t{0});
        put(kind);
    }
    template <typename Number>
    void put(Number number) {
        bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
    void put_text(std::string_view text) {
        bytes_.append(text);
        bytes_.push_back('\0');
    }
    void put_floats(std::span<const float> numbers) {
        bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
    }
    [[nodiscard]] std::string_view finished() {
        const auto size = static_cast<std::uint32_t>(bytes_.size());
        std::memcpy(bytes_.data(), &size, sizeof size);
        return bytes_;
    }

  private:
    std::string bytes_;
};

/// Names the channels of a layer; those of the image itself are R, G, B and A.
std::vector<std::string> channel_names(const std::string& layer, std::string_view letters) {
    std::vector<std::string> names;
    for (const char letter : letters)
        names.push_back(layer.empty() ? std::string(1, letter) : fmt::format("{}.{}", layer, letter));
    return names;
}

/// Calls `send` for each packet with a band of rows of `image`.
void send_pixels(const std::string& name, const std::vector<std::string>& channels, const ImageF& image,
                 const auto& send) {
    const auto row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    const int rows = static_cast<int>(std::max<std::size_t>(1, kMostFloats / row));
    for (int y = 0; y < image.height; y += rows) {
        const int count = std::min(rows, image.height - y);
        Packet packet(PacketKind::UpdateImageV3);
        packet.put(false);  // does not take the focus
        packet.put_text(name);
        packet.put(static_cast<std::int32_t>(channels.size()));
        for (const std::string& channel : channels) packet.put_text(channel);
        for (const int number : {0, y, image.width, count}) packet.put(std::int32_t{number});
        for (std::size_t c = 0; c < channels.size(); ++c) packet.put(static_cast<std::int64_t>(c));
        for (std::size_t c = 0; c < channels.size(); ++c) packet.put(std::int64_t{image.channels});
        packet.put_floats(
            std::span(image.pixels).subspan(static_cast<std::size_t>(y) * row, static_cast<std::size_t>(count) * row));
        send(packet.finished());
    }
}

using Addresses = std::shared_ptr<const addrinfo>;

/// Looks the address up. Throws IoError.
Addresses look_up(const TevAddress& address) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (const int error = ::getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found); error != 0)
        throw IoError(::gai_strerror(error));
    return {found, &::freeaddrinfo};
}

}  // namespace

std::optional<TevAddress> TevAddress::parse(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == text.size()) return std::nullopt;
    TevAddress address{text.substr(0, colon), text.substr(colon + 1)};
    if (!std::ranges::all_of(address.port, [](char c) { return c >= '0' && c <= '9'; })) return std::nullopt;
    return address;
}

TevViewer::TevViewer(TevAddress address) : address_(std::move(address)), thread_([this] { run(); }) {}

TevViewer::~TevViewer() {
    deadline_ = Clock::now() + kLastPatience;
    {
        const std::scoped_lock lock(mutex_);
        is_ended_ = true;
    }
    woken_.notify_all();
    thread_.join();
}

void TevViewer::begin(const std::string& /*title*/, const std::filesystem::path& output) {
    const std::scoped_lock lock(mutex_);
    name_ = output.filename().string();
}

bool TevViewer::wants_image() const {
    return is_idle_ && !is_lost_ && Clock::now() - shown_.load() > kBetweenImages;
}

void TevViewer::show(const ImageDescription& image) {
    std::string name;
    {
        const std::scoped_lock lock(mutex_);
        name = name_;
    }
    show(name, image.frame);
}

void TevViewer::show(const std::string& name, const OutputFrame& frame) {
    if (is_lost_) return;
    shown_ = Clock::now();
    is_idle_ = false;
    {
        const std::scoped_lock lock(mutex_);
        auto waiting = std::ranges::find(next_, name, [](const auto& each) { return each.first; });
        if (waiting == next_.end()) waiting = next_.emplace(next_.end(), name, nullptr);
        waiting->second = std::make_shared<const OutputFrame>(frame);
    }
    woken_.notify_all();
}

void TevViewer::run() {
    for (;;) {
        std::string name;
        std::shared_ptr<const OutputFrame> frame;
        {
            std::unique_lock lock(mutex_);
            woken_.wait(lock, [&] { return !next_.empty() || is_ended_; });
            if (next_.empty()) return;
            std::tie(name, frame) = std::move(next_.front());
            next_.pop_front();
        }
        try {
            if (!socket_.is_open()) socket_ = connect();
            send(name, *frame);
        } catch (const std::exception& error) {
            is_lost_ = true;
            log_warning("warning: --tev {}:{} shows no more of this: {}", address_.host, address_.port, error.what());
            return;
        }
        is_idle_ = true;
    }
}

void TevViewer::send(const std::string& name, const OutputFrame& frame) {
    const auto send_packet = [this](std::string_view bytes) { send_bytes(bytes); };
    std::vector<std::pair<std::vector<std::string>, const ImageF*>> parts{{channel_names({}, "RGBA"), &frame.pixels}};
    for (const OutputLayer& layer : frame.layers)
        if (layer.channels.size() == static_cast<std::size_t>(layer.pixels.channels))
            parts.emplace_back(channel_names(layer.name, layer.channels), &layer.pixels);
    if (!sent_names_.contains(name)) {
        // What an earlier run has sent may have another size.
        Packet close(PacketKind::CloseImage);
        close.put_text(name);
        send_bytes(close.finished());
        Packet create(PacketKind::CreateImage);
        create.put(true);  // takes the focus
        create.put_text(name);
        create.put(std::int32_t{frame.pixels.width});
        create.put(std::int32_t{frame.pixels.height});
        std::vector<std::string> all;
        for (const auto& [channels, image] : parts) all.insert(all.end(), channels.begin(), channels.end());
        create.put(static_cast<std::int32_t>(all.size()));
        for (const std::string& channel : all) create.put_text(channel);
        send_bytes(create.finished());
        sent_names_.insert(name);
    }
    for (const auto& [channels, image] : parts) send_pixels(name, channels, *image, send_packet);
}

void TevViewer::wait_until_writable(int socket) const {
    const Clock::time_point start = Clock::now();
    // The end may come, and bring the deadline, while this waits.
    while (Clock::now() < std::min(start + kPatience, deadline_.load())) {
        pollfd reader{.fd = socket, .events = POLLOUT, .revents = 0};
        constexpr int kBetweenLooks = 100;  // milliseconds
        const int ready = ::poll(&reader, 1, kBetweenLooks);
        if (ready == 1) return;
        if (ready < 0 && errno != EINTR) throw IoError(system_error_text(errno));
    }
    throw IoError("it takes nothing");
}

FileDescriptor TevViewer::connect() const {
    // A server of names that does not answer holds the system's look-up for as long as it likes: nobody waits for that
    // thread, which has what it needs.
    std::packaged_task<Addresses()> task([address = address_] { return look_up(address); });
    std::future<Addresses> answer = task.get_future();
    std::thread(std::move(task)).detach();
    constexpr std::chrono::milliseconds kBetweenLooks{100};
    const Clock::time_point start = Clock::now();
    while (answer.wait_for(kBetweenLooks) != std::future_status::ready)
        if (Clock::now() >= std::min(start + kPatienceForName, deadline_.load()))
            throw IoError("the look-up of its name takes too long");
    const Addresses found = answer.get();
    int error = 0;
    for (const addrinfo* each = found.get(); each != nullptr; each = each->ai_next) {
        FileDescriptor socket(::socket(each->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
        if (!socket.is_open()) continue;
        error = ::connect(socket.get(), each->ai_addr, each->ai_addrlen) == 0 ? 0 : errno;
        if (error == EINPROGRESS) {
            socklen_t size = sizeof error;
            try {
                wait_until_writable(socket.get());
                ::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size);
            } catch (const IoError&) {
                error = ETIMEDOUT;  // another address may answer
            }
        }
        if (error == 0) return socket;
    }
    throw IoError(system_error_text(error));
}

void TevViewer::send_bytes(std::string_view bytes) const {
    while (!bytes.empty()) {
        if (Clock::now() > deadline_.load()) throw IoError("it takes too long");
        const ssize_t sent = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent > 0)
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        else if (errno == EAGAIN)
            wait_until_writable(socket_.get());
        else if (errno != EINTR)
            throw IoError(system_error_text(errno));
    }
}

}  // namespace etendue
