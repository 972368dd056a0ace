// A web server for a browser on this machine: it listens on 127.0.0.1 alone, behind a secret in its address.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace etendue {

/// Asks for something of a page, or for something to be done.
struct LiveRequest {
    bool is_post = false;                                     ///< it may change something
    std::string path{};                                       ///< behind the secret, without a slash before it
    std::map<std::string, std::string, std::less<>> query{};  ///< parameters of the address, decoded
    std::string body{};                                       ///< body of a POST, at most `LiveServer::kMostBody` bytes
};

/// Answers a request.
struct LiveAnswer {
    int status = 200;
    std::string type = "text/plain; charset=utf-8";
    std::string body{};

    /// Answers that there is nothing at an address.
    [[nodiscard]] static LiveAnswer not_found() { return {404, "text/plain; charset=utf-8", "not found\n"}; }
    /// Answers with JSON text.
    [[nodiscard]] static LiveAnswer json(std::string text) { return {200, "application/json", std::move(text)}; }
    /// Answers that a request cannot be followed, and why.
    [[nodiscard]] static LiveAnswer refused(std::string why) {
        return {400, "text/plain; charset=utf-8", std::move(why)};
    }
};

/// Says how long after its last question a page counts as closed, or hidden behind others.
inline constexpr std::chrono::seconds kWatchedFor{3};
/// Is the longest time that the server waits at its end, so that each open page learns of the end.
inline constexpr std::chrono::milliseconds kFarewell{1000};

/// Hands requests of browsers to a function. Requests that name another host, come from pages of others or lack the
/// secret are answered with 403 and go no further.
class LiveServer {
  public:
    /// Called from several threads at once; what it throws becomes the status 500.
    using Handler = std::function<LiveAnswer(const LiveRequest&)>;

    static constexpr std::size_t kMostBody = std::size_t{1} << 16;

    /// Listens on `port`, or on a free one if that is 0. Throws IoError if it cannot.
    LiveServer(int port, Handler handler);
    /// Ends open connections within a second or two, whatever they send.
    ~LiveServer();
    LiveServer(const LiveServer&) = delete;
    LiveServer& operator=(const LiveServer&) = delete;

    [[nodiscard]] int port() const;
    /// Returns the address of the page, secret and all.
    [[nodiscard]] const std::string& url() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace etendue
