#include "session/progress_pipe.h"

#include <array>
#include <csignal>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace etendue::test {

namespace {

class ProgressPipes : public testing::Test {
  protected:
    void SetUp() override { ASSERT_EQ(::pipe2(ends_.data(), O_CLOEXEC), 0); }
    void TearDown() override {
        std::signal(SIGPIPE, SIG_DFL);
        for (const int end : ends_) ::close(end);
    }
    /// All that can be read without waiting.
    [[nodiscard]] std::string read_all() const {
        ::fcntl(ends_[0], F_SETFL, O_NONBLOCK);
        std::string text;
        std::array<char, 4096> buffer;
        for (ssize_t got = 0; (got = ::read(ends_[0], buffer.data(), buffer.size())) > 0;)
            text.append(buffer.data(), static_cast<std::size_t>(got));
        return text;
    }

    std::array<int, 2> ends_{-1, -1};
};

TEST_F(ProgressPipes, TakesALineForEachReport) {
    const ProgressPipe pipe(ends_[1]);
    pipe.enter("load");
    pipe.update({0.25, 1.5, 100, 700});
    EXPECT_EQ(read_all(),
              "{\"phase\":\"load\",\"fraction\":0.000000,\"seconds\":0.000,\"samples\":0,\"rays\":0}\n"
              "{\"phase\":\"render\",\"fraction\":0.250000,\"seconds\":1.500,\"samples\":100,\"rays\":700}\n");
}

TEST_F(ProgressPipes, AReaderThatIsGoneEndsNothing) {
    const ProgressPipe pipe(ends_[1]);
    ::close(ends_[0]);
    pipe.update({});
    ends_[0] = ::dup(ends_[1]);
}

// If it waited, an alarm would end the test.
TEST_F(ProgressPipes, AReaderThatIsSlowIsNotWaitedForAndGetsWholeLines) {
    const ProgressPipe pipe(ends_[1]);
    ::alarm(30);
    for (int i = 0; i < 5000; ++i) pipe.update({0.5, 1.0, 1, 1});
    ::alarm(0);
    const std::string text = read_all();
    const std::string line = text.substr(0, text.find('\n') + 1);
    ASSERT_EQ(text.size() % line.size(), 0u);
    for (std::size_t i = 0; i < text.size(); i += line.size()) ASSERT_EQ(text.substr(i, line.size()), line);
    EXPECT_GT(text.size() / line.size(), 100u);
    EXPECT_LT(text.size() / line.size(), 5000u);
    pipe.update({});
    EXPECT_FALSE(read_all().empty()) << "there is room again";
}

}  // namespace

}  // namespace etendue::test
