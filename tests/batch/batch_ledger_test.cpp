#include "batch/batch_ledger.h"

#include "core/error.h"
#include "program/forked.h"
#include "program/small_files.h"
#include "support/file_calls.h"

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace etendue::test {

namespace {

using nlohmann::json;

std::vector<std::string> lines_of(const std::filesystem::path& file) {
    std::istringstream text(read_file(file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
}

class Ledger : public testing::Test {
  protected:
    void append(LedgerEventKind kind, const std::string& unit, bool again = false) const {
        ledger_.append({.kind = kind, .unit = unit, .error = "first\nsecond", .again = again});
    }

    TestFolder folder_;
    std::filesystem::path path_ = folder_ / "ledger.jsonl";
    BatchLedger ledger_{path_};
    LedgerHistory history_{path_};
};

TEST_F(Ledger, HasALineForEachEventWithWhatIsKnown) {
    ledger_.append({.kind = LedgerEventKind::BatchStarted, .units = 3});
    ledger_.append({.kind = LedgerEventKind::UnitFailed,
                    .unit = "a\nb\xff",
                    .attempt = 2,
                    .signal = "SIGSEGV",
                    .log = {"one", "two"},
                    .seconds = 1.5});
    const std::vector<std::string> lines = lines_of(path_);
    ASSERT_EQ(lines.size(), 2u);
    const json started = json::parse(lines[0]);
    EXPECT_EQ(started["event"], "batch started");
    EXPECT_EQ(started["units"], 3);
    EXPECT_EQ(started["pid"], getpid());
    EXPECT_FALSE(started.contains("unit"));
    const json failed = json::parse(lines[1]);
    EXPECT_EQ(failed["event"], "unit failed");
    EXPECT_EQ(failed["attempt"], 2);
    EXPECT_EQ(failed["signal"], "SIGSEGV");
    EXPECT_EQ(failed["log"], (json{"one", "two"}));
    EXPECT_EQ(failed["seconds"], 1.5);
    EXPECT_FALSE(failed.contains("exit_code"));
    EXPECT_EQ(failed["time"].get<std::string>().size(), std::string("2026-11-22T14:03:07.123Z").size());
}

TEST_F(Ledger, TellsHowLongDenoisingTakes) {
    EXPECT_FALSE(history_.denoise_seconds(100, 1));
    append(LedgerEventKind::UnitFinished, "plain");
    const auto denoised = [&](const std::string& unit, double seconds, std::uint64_t pixels, int threads) {
        ledger_.append({.kind = LedgerEventKind::UnitFinished,
                        .unit = unit,
                        .denoise_seconds = seconds,
                        .pixels = pixels,
                        .threads = threads});
    };
    denoised("a", 8.0, 100, 1);
    denoised("b", 2.0, 300, 4);
    history_.read_new();
    EXPECT_EQ(history_.denoise_seconds(100, 1), 4.0);
    EXPECT_EQ(history_.denoise_seconds(200, 4), 2.0);
    EXPECT_FALSE(history_.denoise_seconds(0, 4)) << "its size is not known";
    EXPECT_EQ(history_.find("b")->denoise_seconds, 2.0);
    EXPECT_FALSE(history_.find("plain")->denoise_seconds);
}

TEST_F(Ledger, EveryLineIsOnTheDiskWhenItIsAppended) {
    const FileCalls calls;
    for (std::size_t line = 1; line <= 2; ++line) {
        append(LedgerEventKind::UnitFinished, "box");
        ASSERT_EQ(calls.all().size(), line);
        EXPECT_EQ(calls.all().back(), fmt::format("fsync ledger.jsonl {}", std::filesystem::file_size(path_)));
    }
}

TEST_F(Ledger, ATornLineStaysAlone) {
    append(LedgerEventKind::UnitFailed, "one");
    const std::string whole = read_file(path_);
    // Wherever a writer died: the next line is whole, and what was torn says nothing, or nothing false.
    for (std::size_t end = 0; end <= whole.size(); ++end) {
        write_file(path_, whole.substr(0, end));
        append(LedgerEventKind::UnitFinished, "two");
        LedgerHistory history(path_);
        history.read_new();
        ASSERT_NE(history.find("two"), nullptr) << end;
        EXPECT_EQ(history.find("two")->kind, LedgerEventKind::UnitFinished);
        EXPECT_EQ(history.find("one") != nullptr, end + 1 >= whole.size()) << end;
    }
}

TEST_F(Ledger, HistoryIsTheLastOfEachUnit) {
    history_.read_new();
    EXPECT_EQ(history_.find("one"), nullptr) << "there is no ledger yet";
    append(LedgerEventKind::UnitStarted, "one");
    append(LedgerEventKind::UnitFailed, "one", true);
    LedgerHistory history(path_);
    history.read_new();
    ASSERT_NE(history.find("one"), nullptr);
    EXPECT_EQ(history.find("one")->kind, LedgerEventKind::UnitFailed);
    EXPECT_EQ(history.find("one")->error, "first");
    EXPECT_FALSE(history.find("one")->is_final);
    EXPECT_FALSE(history.find("one")->is_recent);
    append(LedgerEventKind::UnitFailed, "one");
    history.read_new();
    EXPECT_TRUE(history.find("one")->is_final);
    EXPECT_TRUE(history.find("one")->is_recent);
    history_.read_new();
    EXPECT_TRUE(history_.find("one")->is_recent) << "it began when there was nothing";
}

TEST_F(Ledger, HistorySkipsWhatIsForeignAndWaitsForWhatIsBeingWritten) {
    write_file(path_, "no json\n[]\n{\"event\": 3, \"unit\": 4}\n{\"event\": \"unit sung\", \"unit\": \"one\"}\n" +
                          std::string(3 << 20, 'x') + "\n{\"event\": \"unit finished\", \"unit\": \"one\"");
    history_.read_new();
    EXPECT_EQ(history_.find("one"), nullptr);
    write_file(path_, read_file(path_) + "}\n");
    history_.read_new();
    EXPECT_NE(history_.find("one"), nullptr);
}

TEST_F(Ledger, ManyWritersDoNotMixTheirLines) {
    constexpr int kWriters = 4;
    constexpr int kLines = 50;
    for (int writer = 0; writer < kWriters; ++writer) {
        (void)run_forked([&] {
            for (int i = 0; i < kLines; ++i)
                append(LedgerEventKind::UnitFinished, fmt::format("{} {} {}", writer, i, std::string(5000, 'x')));
            return 0;
        });
    }
    for (int writer = 0; writer < kWriters; ++writer) wait(nullptr);
    const std::vector<std::string> lines = lines_of(path_);
    EXPECT_EQ(lines.size(), static_cast<std::size_t>(kWriters * kLines));
    for (const std::string& line : lines) EXPECT_TRUE(json::accept(line)) << line;
}

TEST_F(Ledger, AFullDiskIsAnErrorAndNothingIsAppended) {
    append(LedgerEventKind::UnitFinished, "one");
    const std::string before = read_file(path_);
    const pid_t pid = run_forked([&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{before.size() + 10, before.size() + 10};
        if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 1;
        try {
            append(LedgerEventKind::UnitFinished, "two");
        } catch (const IoError&) {
            return 0;
        }
        return 2;
    });
    int status = 0;
    waitpid(pid, &status, 0);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(read_file(path_), before);
    EXPECT_THROW(BatchLedger(folder_ / "no/ledger.jsonl").append({.unit = "one"}), IoError);
}

TEST_F(Ledger, ThatIsNoFileIsAnErrorAndNothingToWaitFor) {
    ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
    EXPECT_THROW(history_.read_new(), IoError);
    const std::string more_than_a_pipe_holds(200'000, 'x');
    EXPECT_THROW(append(LedgerEventKind::UnitFinished, more_than_a_pipe_holds), IoError);
    EXPECT_THROW(LedgerHistory("/dev/zero").read_new(), IoError) << "it has no end";
    EXPECT_THROW(BatchLedger("/dev/zero").append({.unit = "one"}), IoError);
}

}  // namespace

}  // namespace etendue::test
