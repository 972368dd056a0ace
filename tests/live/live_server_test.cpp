// What the server lets in, spoken to as a browser does, and as somebody else's page would.
#include "live/live_server.h"

#include "core/error.h"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace etendue::test {

namespace {

class Connection {
  public:
    explicit Connection(int port, const char* address = "127.0.0.1") {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(static_cast<std::uint16_t>(port));
        ::inet_pton(AF_INET, address, &to.sin_addr);
        is_open_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
    }
    ~Connection() { ::close(socket_); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    [[nodiscard]] bool is_open() const { return is_open_; }
    /// Sends `text`; returns false if the connection has ended.
    [[nodiscard]] bool send(const std::string& text) const {
        return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
    }
    /// Sends `request` and returns all that comes back until the connection ends.
    [[nodiscard]] std::string ask(const std::string& request) const {
        EXPECT_EQ(::send(socket_, request.data(), request.size(), MSG_NOSIGNAL), static_cast<ssize_t>(request.size()));
        std::string answer;
        char buffer[4096];
        for (ssize_t got = 0; (got = ::recv(socket_, buffer, sizeof buffer, 0)) > 0;)
            answer.append(buffer, static_cast<std::size_t>(got));
        return answer;
    }

  private:
    int socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    bool is_open_ = false;
};

/// A server that says what it was asked for.
LiveServer echo() {
    return {0, [](const LiveRequest& request) -> LiveAnswer {
                if (request.path == "fail") throw std::runtime_error("it failed");
                if (request.path != "echo") return LiveAnswer::not_found();
                const auto x = request.query.find("x");
                return {.body = fmt::format("{} {} {}", request.is_post ? "POST" : "GET",
                                            x == request.query.end() ? "-" : x->second, request.body)};
            }};
}

/// Returns the path of `url`, which is the secret.
std::string path_of(const std::string& url) {
    return url.substr(url.find('/', std::string("http://").size()));
}

std::string status_of(const std::string& answer) {
    return answer.substr(0, std::string("HTTP/1.1 200").size());
}

TEST(LiveServer, AnswersThoseAloneWhoKnowTheSecretAndNameThisMachine) {
    const LiveServer server = echo();
    const std::string port = std::to_string(server.port());
    const std::string page = path_of(server.url());
    ASSERT_EQ(page.size(), 34u) << "128 bits as hexadecimal digits, between slashes";
    EXPECT_EQ(server.url(), "http://127.0.0.1:" + port + page);
    std::string other = page;
    other[5] = other[5] == '0' ? '1' : '0';
    const std::string own_host = "Host: 127.0.0.1:" + port + "\r\n";
    struct Case {
        std::string line;
        std::string headers;
        std::string status;
    };
    const std::vector<Case> cases{
        {"GET " + page + "echo?x=a%20b", own_host, "HTTP/1.1 200"},
        {"GET " + page + "echo", "Host: localhost:" + port + "\r\n", "HTTP/1.1 200"},
        {"GET " + page + "echo", own_host + "Origin: http://127.0.0.1:" + port + "\r\n", "HTTP/1.1 200"},
        {"GET " + page + "elsewhere", own_host, "HTTP/1.1 404"},
        {"GET " + page + "fail", own_host, "HTTP/1.1 500"},
        {"GET " + page + "echo", "Host: example.org:" + port + "\r\n", "HTTP/1.1 403"},
        {"GET " + page + "echo", "Host: 127.0.0.1:1\r\n", "HTTP/1.1 403"},
        {"GET " + page + "echo", "", "HTTP/1.1 403"},
        {"GET " + page + "echo", own_host + "Host: example.org\r\n", "HTTP/1.1 403"},
        {"GET " + page + "echo", own_host + "Origin: http://example.org\r\n", "HTTP/1.1 403"},
        {"GET " + page + "echo", own_host + "Origin: null\r\n", "HTTP/1.1 403"},
        {"GET " + other + "echo", own_host, "HTTP/1.1 403"},
        {"GET /", own_host, "HTTP/1.1 403"},
        {"GET /echo", own_host, "HTTP/1.1 403"},
        {"GET " + page.substr(0, 33), own_host, "HTTP/1.1 403"},
        {"DELETE " + page + "echo", own_host, "HTTP/1.1 405"},
        {"POST " + page + "echo", own_host + "Content-Length: 2\r\n", "HTTP/1.1 200"},
        {"POST " + other + "echo", own_host + "Content-Length: 2\r\n", "HTTP/1.1 403"},
        {"POST " + page + "echo", own_host + "Origin: https://example.org\r\nContent-Length: 2\r\n", "HTTP/1.1 403"},
    };
    for (const Case& c : cases) {
        const std::string body = c.line.starts_with("POST") ? "hi" : "";
        const std::string answer = Connection(server.port()).ask(c.line + " HTTP/1.1\r\n" + c.headers + "\r\n" + body);
        EXPECT_EQ(status_of(answer), c.status) << c.line << "\n" << c.headers << answer;
        EXPECT_NE(answer.find("Content-Security-Policy: default-src 'none'; script-src 'self'"), std::string::npos);
        EXPECT_EQ(answer.find("it failed") != std::string::npos, c.status == "HTTP/1.1 500") << answer;
    }
    EXPECT_NE(Connection(server.port())
                  .ask("POST " + page + "echo?x=%3C HTTP/1.1\r\n" + own_host + "Content-Length: 2\r\n\r\nhi")
                  .find("POST < hi"),
              std::string::npos);
}

TEST(LiveServer, IsReachedOnTheLoopbackAlone) {
    const LiveServer server = echo();
    EXPECT_TRUE(Connection(server.port()).is_open());
    EXPECT_FALSE(Connection(server.port(), "127.0.0.2").is_open()) << "the other addresses of this machine";
}

TEST(LiveServer, SharesItsPortWithNobody) {
    const LiveServer server = echo();
    EXPECT_THROW(LiveServer(server.port(), [](const LiveRequest&) { return LiveAnswer(); }), IoError);
}

TEST(LiveServer, EndsThoughConnectionsAreOpen) {
    const auto start = std::chrono::steady_clock::now();
    {
        const LiveServer server = echo();
        const Connection idle(server.port());
        const Connection half(server.port());
        ASSERT_TRUE(idle.is_open() && half.is_open());
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(4));
}

TEST(LiveServer, EndsThoughAClientSendsAByteNowAndThen) {
    std::atomic<bool> is_over{false};
    std::thread client;
    std::chrono::steady_clock::time_point start;
    {
        const LiveServer server = echo();
        client = std::thread([&is_over, port = server.port()] {
            const Connection slow(port);
            while (!is_over && slow.send("G")) std::this_thread::sleep_for(std::chrono::milliseconds(200));
        });
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        start = std::chrono::steady_clock::now();
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(4));
    is_over = true;
    client.join();
}

TEST(LiveServer, ShutsAConnectionThatSendsHeadersWithoutEnd) {
    const LiveServer server = echo();
    const Connection endless(server.port());
    ASSERT_TRUE(endless.send("GET / HTTP/1.1\r\n"));
    const std::string header = "X: " + std::string(8000, 'x') + "\r\n";
    const auto start = std::chrono::steady_clock::now();
    const auto passed = [&] { return std::chrono::steady_clock::now() - start; };
    while (passed() < std::chrono::seconds(3) && endless.send(header))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_LT(passed(), std::chrono::seconds(3));
    EXPECT_EQ(status_of(Connection(server.port()).ask("GET / HTTP/1.1\r\n\r\n")), "HTTP/1.1 403");
}

}  // namespace

}  // namespace etendue::test
