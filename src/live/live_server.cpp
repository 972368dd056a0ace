#include "live/live_server.h"

#include "core/error.h"
#include "live/connection_watch.h"

#include <array>
#include <chrono>
#include <exception>
#include <optional>
#include <random>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

namespace etendue {

namespace {

constexpr const char* kLoopback = "127.0.0.1";
constexpr std::size_t kServerThreads = 8;

/// Returns 128 random bits of the operating system as hexadecimal digits.
std::string make_secret() {
    std::random_device random;
    std::string secret;
    for (int i = 0; i < 4; ++i) secret += fmt::format("{:08x}", random());
    return secret;
}

/// Compares in a time that does not tell where the texts differ.
bool is_secret(std::string_view given, std::string_view secret) {
    if (given.size() != secret.size()) return false;
    unsigned int difference = 0;
    for (std::size_t i = 0; i < secret.size(); ++i)
        difference |= static_cast<unsigned int>(given[i]) ^ static_cast<unsigned int>(secret[i]);
    return difference == 0;
}

/// Keeps browsers from loading anything from elsewhere, from guessing types, from telling the address to others and
/// from showing the page inside of another one.
httplib::Headers safe_headers() {
    return {{"Content-Security-Policy",
             "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; "
             "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
            {"X-Content-Type-Options", "nosniff"},
            {"X-Frame-Options", "DENY"},
            {"Referrer-Policy", "no-referrer"},
            {"Cross-Origin-Resource-Policy", "same-origin"},
            {"Cross-Origin-Opener-Policy", "same-origin"},
            {"Cache-Control", "no-store"}};
}

/// Leaves out the port of an address of the web if it is the usual one, as browsers do.
std::string_view without_usual_port(std::string_view address) {
    constexpr std::string_view kUsual = ":80";
    if (address.ends_with(kUsual)) address.remove_suffix(kUsual.size());
    return address;
}

void answer_with(httplib::Response& response, int status, std::string_view text) {
    response.status = status;
    response.set_content(std::string(text), "text/plain; charset=utf-8");
}

}  // namespace

struct LiveServer::Impl {
    Handler handler;
    std::string secret = make_secret();
    std::string url{};
    int port = 0;
    httplib::Server server{};
    std::thread thread{};
    std::optional<ConnectionWatch> watch{};

    /// Returns false, with an answer, for a request that is not from the page of this server.
    [[nodiscard]] bool admits(const httplib::Request& request, httplib::Response& response) const {
        // A name of somebody else's that leads here would make this server a part of their site.
        const std::string host = request.get_header_value("Host");
        const std::string address = fmt::format("{}:{}", kLoopback, port);
        const std::string name = fmt::format("localhost:{}", port);
        const std::string_view asked = without_usual_port(host);
        if (request.get_header_value_count("Host") != 1 ||
            (asked != without_usual_port(address) && asked != without_usual_port(name))) {
            answer_with(response, 403, "this server answers to 127.0.0.1 and localhost only\n");
            return false;
        }
        const std::string prefix = "/" + secret + "/";
        if (!is_secret(std::string_view(request.path).substr(0, prefix.size()), prefix)) {
            answer_with(response, 403, "the address lacks the secret that etendue has printed\n");
            return false;
        }
        const std::string origin = request.get_header_value("Origin");
        if (request.has_header("Origin") && without_usual_port(origin) != fmt::format("http://{}", asked)) {
            answer_with(response, 403, "the request comes from another page\n");
            return false;
        }
        if (request.method != "GET" && request.method != "POST") {
            answer_with(response, 405, "only GET and POST are known\n");
            return false;
        }
        return true;
    }

    void answer(const httplib::Request& request, httplib::Response& response) {
        watch->note_request(request.remote_port);
        LiveRequest asked{.is_post = request.method == "POST", .path = request.path.substr(secret.size() + 2)};
        for (const auto& [name, value] : request.params) asked.query.emplace(name, value);
        asked.body = request.body;
        const LiveAnswer answer = handler(asked);
        response.status = answer.status;
        response.set_content(answer.body, answer.type);
    }
};

LiveServer::LiveServer(int port, Handler handler) : impl_(std::make_unique<Impl>()) {
    Impl& impl = *impl_;
    impl.handler = std::move(handler);
    httplib::Server& server = impl.server;
    server.new_task_queue = [] { return new httplib::ThreadPool(kServerThreads); };
    server.set_default_headers(safe_headers());
    server.set_payload_max_length(kMostBody);
    // Each connection has one request. The times begin anew with each byte: `watch` bounds the whole.
    server.set_keep_alive_max_count(1);
    server.set_keep_alive_timeout(1);
    server.set_read_timeout(1);
    server.set_write_timeout(2);
    // The library would share the port with whoever asks for it, too.
    server.set_socket_options([](auto socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server.set_tcp_nodelay(true);
    server.set_pre_routing_handler([&impl](const auto& request, auto& response) {
        return impl.admits(request, response) ? httplib::Server::HandlerResponse::Unhandled
                                              : httplib::Server::HandlerResponse::Handled;
    });
    const auto answer = [&impl](const httplib::Request& request, httplib::Response& response) {
        impl.answer(request, response);
    };
    server.Get(".*", answer);
    server.Post(".*", answer);
    server.set_exception_handler([](const auto&, auto& response, const std::exception_ptr& failure) {
        std::string what = "unknown";
        try {
            std::rethrow_exception(failure);
        } catch (const std::exception& error) {
            what = error.what();
        } catch (...) {
        }
        answer_with(response, 500, what + "\n");
    });
    impl.port = port == 0 ? server.bind_to_any_port(kLoopback) : (server.bind_to_port(kLoopback, port) ? port : -1);
    if (impl.port < 0)
        throw IoError(port == 0 ? std::string("--live: no port of 127.0.0.1 is free")
                                : fmt::format("--live: port {} of 127.0.0.1 is taken or not allowed; leave it out for "
                                              "one that is free",
                                              port));
    impl.url = fmt::format("http://{}:{}/{}/", kLoopback, impl.port, impl.secret);
    impl.watch.emplace(impl.port);
    impl.thread = std::thread([&server] { server.listen_after_bind(); });
    // To be stopped, it must have started.
    while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

LiveServer::~LiveServer() {
    impl_->server.stop();
    // Time for answers that are under way; who sends slowly would take longer.
    impl_->watch->end_all_after(std::chrono::seconds(1));
    impl_->thread.join();
}

int LiveServer::port() const {
    return impl_->port;
}

const std::string& LiveServer::url() const {
    return impl_->url;
}

}  // namespace etendue
