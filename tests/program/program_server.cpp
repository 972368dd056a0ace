#include "program/program_server.h"

#include "program/program_requests.h"

#include <array>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace etendue::test {

namespace {

std::string request_head(const RequestHead& head) {
    std::string text(sizeof head, '\0');
    std::memcpy(text.data(), &head, sizeof head);
    return text;
}

}  // namespace

ProgramServer::ProgramServer() {
    std::array<int, 2> sockets{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, sockets.data()) != 0)
        throw std::runtime_error("no pair of sockets for the served program");
    // Away from the number that the program is to have: dup2 onto itself would leave it closed at exec.
    const int end = ::fcntl(sockets[1], F_DUPFD_CLOEXEC, kRequests + 1);
    ::close(sockets[1]);
    socket_ = ::fcntl(sockets[0], F_DUPFD_CLOEXEC, kRequests + 1);
    ::close(sockets[0]);
    std::string name = "etendue";
    std::string argument = kServe;
    const std::array<char*, 3> argv{name.data(), argument.data(), nullptr};
    pid_ = ::fork();
    if (pid_ == 0) {
        if (::dup2(end, kRequests) >= 0) ::execv(ETENDUE_SERVED_PROGRAM, argv.data());
        ::_exit(127);
    }
    ::close(end);
    if (pid_ < 0) throw std::runtime_error("the served program cannot be started");
}

ProgramServer::~ProgramServer() {
    // It would also end without the socket, unless another copy of this process still has that.
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    ::close(socket_);
}

int ProgramServer::ask(const std::string& request) const {
    int answer = 0;
    if (::send(socket_, request.data(), request.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request.size()) ||
        ::recv(socket_, &answer, sizeof answer, 0) != sizeof answer)
        throw std::runtime_error("the served program does not answer");
    return answer;
}

pid_t ProgramServer::start(const std::vector<std::string>& words, const std::filesystem::path& directory,
                           const std::filesystem::path& out, const std::filesystem::path& err) const {
    RequestHead head{.request = Request::Start, .words = static_cast<int>(words.size())};
    std::string strings;
    const auto add = [&strings](const std::string& text) { strings.append(text).push_back('\0'); };
    for (const std::filesystem::path& place : {directory, out, err}) add(place.string());
    for (const std::string& word : words) add(word);
    for (char** variable = ::environ; *variable != nullptr; ++variable, ++head.variables) add(*variable);
    const std::string request = request_head(head) + strings;
    if (request.size() > kLongestRequest) throw std::runtime_error("a command is too long for the served program");
    const pid_t pid = ask(request);
    if (pid <= 0) throw std::runtime_error("the served program cannot copy itself");
    return pid;
}

bool ProgramServer::has_ended(pid_t pid) const {
    return ask(request_head({.request = Request::HasEnded, .pid = pid})) != 0;
}

int ProgramServer::wait(pid_t pid) const {
    return ask(request_head({.request = Request::Wait, .pid = pid}));
}

const ProgramServer& program_server() {
    static const ProgramServer server;
    return server;
}

}  // namespace etendue::test
