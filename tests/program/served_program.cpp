// The program etendue, which also runs commands in copies of itself. A copy has OpenImageIO from the beginning: to load
// its 260 libraries takes longer than most commands of tests.
#include "cli/program.h"
#include "image/image_module.h"
#include "program/program_requests.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using namespace etendue;
using namespace etendue::test;

/// Takes `count` strings off the front of `text`; a null pointer follows them.
std::vector<char*> take_strings(char*& text, int count) {
    std::vector<char*> strings;
    for (int i = 0; i < count; ++i) {
        strings.push_back(text);
        text += std::strlen(text) + 1;
    }
    strings.push_back(nullptr);
    return strings;
}

/// Runs the command of a Start whose strings are `text`.
[[noreturn]] void run_command(const RequestHead& head, char* text) {
    ::close(kRequests);
    const std::vector<char*> places = take_strings(text, 3);
    std::vector<char*> words = take_strings(text, head.words);
    std::vector<char*> variables = take_strings(text, head.variables);
    constexpr mode_t kMode = 0600;
    const int out = ::open(places[1], O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, kMode);
    const int err = ::open(places[2], O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, kMode);
    constexpr int kNotStarted = 127;
    if (out < 0 || err < 0 || ::dup2(out, STDOUT_FILENO) < 0 || ::dup2(err, STDERR_FILENO) < 0 ||
        ::chdir(places[0]) != 0)
        ::_exit(kNotStarted);
    ::close(out);
    ::close(err);
    ::environ = variables.data();
    const int code = run_program(head.words, words.data());
    std::fflush(nullptr);
    // Destructors of static objects are left out: some of libraries wait for threads, which no copy has.
    ::_exit(code);
}

bool has_ended(pid_t pid) {
    siginfo_t ended{};
    return ::waitid(P_PID, static_cast<id_t>(pid), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid == pid;
}

/// Answers requests until whoever asks is gone.
int serve() {
    load_image_module_early().get();
    std::vector<char> message(kLongestRequest);
    for (;;) {
        const ssize_t size = ::recv(kRequests, message.data(), message.size(), 0);
        if (size < static_cast<ssize_t>(sizeof(RequestHead))) return size == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
        RequestHead head;
        std::memcpy(&head, message.data(), sizeof head);
        int answer = 0;
        switch (head.request) {
            case Request::Start:
                answer = ::fork();
                if (answer == 0) run_command(head, message.data() + sizeof head);
                break;
            case Request::HasEnded:
                answer = has_ended(head.pid) ? 1 : 0;
                break;
            case Request::Wait:
                ::waitpid(head.pid, &answer, 0);
                break;
        }
        if (::send(kRequests, &answer, sizeof answer, MSG_NOSIGNAL) < 0) return EXIT_FAILURE;
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 2 && std::string_view(argv[1]) == kServe) return serve();
    return run_program(argc, argv);
}
