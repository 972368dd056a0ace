// What keeps connections of a server from lasting, however slowly or endlessly they send.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <map>
#include <mutex>
#include <set>
#include <thread>

namespace etendue {

/// Shuts connections to a port of this process that take too long, send too much or are too many, from a thread of its
/// own. It looks at them ten times a second.
class ConnectionWatch {
  public:
    /// Says how long a connection may take for a whole request.
    static constexpr std::chrono::seconds kRequestTime{5};
    /// Says how long a connection may last in all.
    static constexpr std::chrono::seconds kLongest{60};
    /// Says how many bytes a connection may send.
    static constexpr std::size_t kMostBytes = std::size_t{1} << 17;
    /// Says how many connections there may be; the oldest without a whole request are shut first.
    static constexpr std::size_t kMostConnections = 64;

    explicit ConnectionWatch(int port);
    ~ConnectionWatch();
    ConnectionWatch(const ConnectionWatch&) = delete;
    ConnectionWatch& operator=(const ConnectionWatch&) = delete;

    /// Notes that the connection from `peer_port` has sent a whole request.
    void note_request(int peer_port);
    /// Shuts whatever connections there still are after `patience`, until this ends.
    void end_all_after(std::chrono::milliseconds patience);

  private:
    using Clock = std::chrono::steady_clock;

    struct Connection {
        int peer_port = 0;
        Clock::time_point since{};
    };

    void run();
    void look();
    /// Finds the connections among the open descriptors of the process.
    [[nodiscard]] std::map<int, Connection> find_connections() const;

    const int port_;
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable woken_;
    std::map<int, Connection> connections_;  ///< by descriptor
    std::set<int> asked_;                    ///< ports of peers that have sent a whole request
    Clock::time_point end_of_all_ = Clock::time_point::max();
    bool is_ended_ = false;
    std::thread thread_;
};

}  // namespace etendue
