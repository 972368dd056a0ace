#include "live/connection_watch.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <linux/tcp.h>  // the one of libc lacks the count of bytes
#include <netinet/in.h>
#include <sys/socket.h>

namespace etendue {

namespace {

/// Returns how many bytes have come over a connection.
std::uint64_t bytes_received(int descriptor) {
    tcp_info info{};
    socklen_t size = sizeof info;
    return ::getsockopt(descriptor, IPPROTO_TCP, TCP_INFO, &info, &size) == 0 ? info.tcpi_bytes_received : 0;
}

/// Returns the port of one end of a connection, as `ask` (getsockname or getpeername) tells it; 0 if there is none.
int port_of(int descriptor, int (*ask)(int, sockaddr*, socklen_t*)) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    if (ask(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0 || address.sin_family != AF_INET) return 0;
    return ntohs(address.sin_port);
}

}  // namespace

ConnectionWatch::ConnectionWatch(int port) : port_(port), thread_([this] { run(); }) {}

ConnectionWatch::~ConnectionWatch() {
    {
        const std::scoped_lock lock(mutex_);
        is_ended_ = true;
    }
    woken_.notify_all();
    thread_.join();
}

void ConnectionWatch::note_request(int peer_port) {
    const std::scoped_lock lock(mutex_);
    asked_.insert(peer_port);
}

void ConnectionWatch::end_all_after(std::chrono::milliseconds patience) {
    const std::scoped_lock lock(mutex_);
    end_of_all_ = Clock::now() + patience;
}

void ConnectionWatch::run() {
    std::unique_lock lock(mutex_);
    while (!woken_.wait_for(lock, std::chrono::milliseconds(100), [&] { return is_ended_; })) look();
}

std::map<int, ConnectionWatch::Connection> ConnectionWatch::find_connections() const {
    std::map<int, Connection> found;
    std::error_code error;
    for (std::filesystem::directory_iterator each("/proc/self/fd", error), end; !error && each != end;
         each.increment(error)) {
        const std::string name = each->path().filename().string();
        int descriptor = -1;
        std::from_chars(name.data(), name.data() + name.size(), descriptor);
        if (port_of(descriptor, &::getsockname) != port_) continue;
        // What listens has no peer.
        if (const int peer = port_of(descriptor, &::getpeername); peer != 0)
            found.emplace(descriptor, Connection{peer, Clock::now()});
    }
    return found;
}

void ConnectionWatch::look() {
    std::map<int, Connection> now = find_connections();
    std::set<int> peers;
    for (auto& [descriptor, connection] : now) {
        peers.insert(connection.peer_port);
        const auto before = connections_.find(descriptor);
        if (before != connections_.end() && before->second.peer_port == connection.peer_port)
            connection.since = before->second.since;
    }
    connections_ = std::move(now);
    std::erase_if(asked_, [&](int port) { return !peers.contains(port); });

    const Clock::time_point time = Clock::now();
    std::vector<std::pair<Clock::time_point, int>> waiting;
    for (const auto& [descriptor, connection] : connections_) {
        const bool has_asked = asked_.contains(connection.peer_port);
        if (time > end_of_all_ || time - connection.since > (has_asked ? kLongest : kRequestTime) ||
            bytes_received(descriptor) > kMostBytes)
            ::shutdown(descriptor, SHUT_RDWR);
        else if (!has_asked)
            waiting.emplace_back(connection.since, descriptor);
    }
    if (connections_.size() <= kMostConnections) return;
    std::ranges::sort(waiting);
    waiting.resize(std::min(waiting.size(), connections_.size() - kMostConnections));
    for (const auto& [since, descriptor] : waiting) ::shutdown(descriptor, SHUT_RDWR);
}

}  // namespace etendue
