// `etendue help`, man pages and completions: all of them say what --help says.
#include "cli/command_help.h"
#include "cli/command_line.h"
#include "cli/man_page.h"
#include "cli/shell_completion.h"
#include "program/run_program.h"
#include "program/small_files.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

const fs::path kManual = ETENDUE_MANUAL;
const fs::path kBashCompletion = kManual / "bash-completion/completions/etendue";

class Manual : public testing::Test {
  protected:
    void SetUp() override { fs::create_directories(work_); }

    /// What a shell command prints on both streams.
    [[nodiscard]] std::string output_of(const std::string& command) const {
        const fs::path file = folder_ / "output";
        const std::string line = fmt::format("{{ {}\n}} > '{}' 2>&1", command, file.string());
        EXPECT_EQ(std::system(line.c_str()), 0) << command << "\n" << read_file(file);
        return read_file(file);
    }

    [[nodiscard]] std::string help_of(const std::string& command) const {
        return run_etendue({command, "--help"}, work_).out;
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

/// The names that lines of --help begin with, or the words of its list of commands.
std::set<std::string> first_words(const std::string& help, const std::string& pattern) {
    std::set<std::string> names;
    const std::regex line("(^|\n) {2,6}(-., ?)?(" + pattern + ")(?=[ \n,])");
    for (std::sregex_iterator i(help.begin(), help.end(), line); i != std::sregex_iterator(); ++i)
        names.insert((*i)[3].str());
    return names;
}

std::set<std::string> commands_of(const std::string& help) {
    const std::size_t begin = help.find("Subcommands:");
    return first_words(help.substr(begin, help.find("Exit codes:") - begin), "[a-z]+");
}

std::set<std::string> options_of(const std::string& help) {
    return first_words(help, "--[a-z-]+");
}

TEST_F(Manual, HelpPrintsWhatTheOptionPrints) {
    const std::string help = run_etendue({"--help"}, work_).out;
    EXPECT_EQ(run_etendue({"help"}, work_).out, help);
    const std::set<std::string> commands = commands_of(help);
    EXPECT_EQ(commands.size(), 12u);
    for (const std::string& command : commands) {
        const ProgramResult result = run_etendue({"help", command}, work_);
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.out, help_of(command));
        EXPECT_NE(result.out.find("--help"), std::string::npos) << result.out;
    }
}

TEST_F(Manual, HelpOfNoCommandSuggestsOne) {
    const ProgramResult result = run_etendue({"help", "redner"}, work_);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "error: there is no command 'redner'; did you mean 'render'?\n");
}

TEST_F(Manual, EveryOptionIsOnThePageAsItIsTyped) {
    const std::set<std::string> commands = commands_of(run_etendue({"--help"}, work_).out);
    for (const std::string& command : commands) {
        const fs::path page = kManual / "man/man1" / fmt::format("etendue-{}.1", command);
        // No hyphenation and no breaks within lines, so that words can be found.
        const std::string text =
            output_of(fmt::format("groff -man -Tascii -P-cbou -rLL=2000n -rHY=0 '{}'", page.string()));
        const std::set<std::string> options = options_of(help_of(command));
        EXPECT_TRUE(options.contains("--help")) << command;
        for (const std::string& option : options)
            EXPECT_TRUE(std::regex_search(text, std::regex("\n +(-., )?" + option + "[ \n]"))) << page << " " << option;
        EXPECT_NE(text.find("\n       etendue " + command + " "), std::string::npos) << "synopsis and examples\n"
                                                                                     << text;
    }
    const std::string program = read_file(kManual / "man/man1/etendue.1");
    for (const std::string& command : commands)
        EXPECT_NE(program.find("\\fB" + command + "\\fR\n"), std::string::npos) << command;
}

TEST_F(Manual, PagesAreTroffWithoutAWarning) {
    std::size_t pages = 0;
    for (const auto& entry : fs::directory_iterator(kManual / "man/man1")) {
        EXPECT_EQ(output_of(fmt::format("groff -man -ww -z -Tutf8 -Kutf8 '{}'", entry.path().string())), "");
        ++pages;
    }
    EXPECT_EQ(pages, 13u);
}

TEST(ManPage, TextIsNoTroff) {
    CommandHelp program{.name = "p", .summary = "", .footer = "", .arguments = {}, .options = {}, .commands = {}};
    const CommandHelp command{.name = "c",
                              .summary = "Do it",
                              .footer = ".so is no request\n'nor this: C:\\new\n\nExamples:\n  p c --x\n\nLast.",
                              .arguments = {},
                              .options = {},
                              .commands = {}};
    EXPECT_EQ(command_page(program, command, "P 1.0"),
              ".TH P\\-C 1 \"\" \"P 1.0\" \"Etendue\"\n.ad l\n"
              ".SH NAME\np\\-c \\- Do it\n"
              ".SH SYNOPSIS\n\\fBp c\\fR [\\fIOPTION\\fR...]\n"
              ".SH NOTES\n\\&.so is no request\n\\(aqnor this: C:\\enew\n"
              ".SH EXAMPLES\n.nf\np c \\-\\-x\n.fi\n"
              ".PP\nLast.\n"
              ".SH SEE ALSO\n\\fBp\\fR(1)\n");
}

/// Completions that bash finds for the last of `words`.
class BashCompletion : public Manual {
  protected:
    [[nodiscard]] Names complete(const Names& words) const {
        std::string line;
        for (const std::string& word : words) line += fmt::format(" '{}'", word);
        write_file(folder_ / "try.bash",
                   fmt::format("cd '{}' && source '{}'\n"
                               "COMP_WORDS=({})\nCOMP_CWORD={}\n_etendue\n"
                               "[[ ${{#COMPREPLY[@]}} -eq 0 ]] || printf '%s\\n' \"${{COMPREPLY[@]}}\"\n",
                               work_.string(), kBashCompletion.string(), line, words.size() - 1));
        std::istringstream lines(output_of(fmt::format("bash '{}'", (folder_ / "try.bash").string())));
        Names found;
        for (std::string word; std::getline(lines, word);) found.push_back(word);
        return found;
    }
};

TEST_F(BashCompletion, KnowsCommands) {
    EXPECT_EQ(complete({"etendue", "re"}), Names{"render"});
    EXPECT_EQ(complete({"etendue", ""}).size(), 12u);
    EXPECT_EQ(complete({"etendue", "help", "den"}), Names{"denoise"});
    EXPECT_EQ(complete({"etendue", "--v"}), Names{"--version"});
}

TEST_F(BashCompletion, KnowsTheOptionsOfEachCommand) {
    EXPECT_EQ(complete({"etendue", "render", "box", "--integ"}), Names{"--integrator"});
    EXPECT_EQ(complete({"etendue", "diff", "--integ"}), Names());
    for (const std::string command : {"render", "batch", "view", "submit"}) {
        const Names words = complete({"etendue", command, "--"});
        EXPECT_EQ(std::set<std::string>(words.begin(), words.end()), options_of(help_of(command))) << command;
    }
}

TEST_F(BashCompletion, KnowsValues) {
    EXPECT_EQ(complete({"etendue", "render", "--quality", ""}), (Names{"draft", "final", "preview"}));
    EXPECT_EQ(complete({"etendue", "render", "--quality", "=", "pr"}), Names{"preview"});
    EXPECT_EQ(complete({"etendue", "render", "--integrator", "bd"}), Names{"bdpt"});
    EXPECT_EQ(complete({"etendue", "render", "--integrator", "="}).size(),
              complete({"etendue", "render", "--integrator", ""}).size());
    EXPECT_EQ(complete({"etendue", "render", "--spp", ""}), Names()) << "a number";
}

TEST_F(BashCompletion, KnowsThatFlagsHaveNoValues) {
    EXPECT_EQ(complete({"etendue", "render", "box", "--resume", "--sp"}), Names{"--spp"});
    EXPECT_EQ(complete({"etendue", "render", "box", "--live", "--sp"}), Names{"--spp"}) << "its value is optional";
}

TEST_F(BashCompletion, FindsFilesWhereNothingElseIsMeant) {
    write_file(work_ / "with space.exr", "");
    EXPECT_EQ(complete({"etendue", "view", "wi"}), Names{"with space.exr"});
    EXPECT_EQ(complete({"etendue", "view", "-o", "wi"}), Names{"with space.exr"});
}

TEST_F(Manual, OtherShellsAcceptTheirCompletions) {
    const std::string zsh = (kManual / "zsh/site-functions/_etendue").string();
    const std::string fish = (kManual / "fish/vendor_completions.d/etendue.fish").string();
    EXPECT_NE(read_file(zsh).find("'*--integrator["), std::string::npos);
    EXPECT_NE(read_file(fish).find(" -l integrator "), std::string::npos);
    EXPECT_TRUE(std::regex_search(read_file(zsh), std::regex(R"('\*--resume\[[^\]]*\]' )"))) << "a flag";
    EXPECT_NE(read_file(fish).find(" -l resume -d "), std::string::npos) << "a flag";
    std::string missing;
    for (const auto& [shell, check] : {std::pair("zsh", fmt::format("zsh -n '{}'", zsh)),
                                       std::pair("fish", fmt::format("fish --no-execute '{}'", fish))}) {
        if (std::system(fmt::format("command -v {} >/dev/null", shell).c_str()) == 0) {
            EXPECT_EQ(output_of(check), "");
        } else {
            missing += fmt::format("{}{}", missing.empty() ? "" : " and no ", shell);
        }
    }
    if (!missing.empty()) GTEST_SKIP() << "there is no " << missing << " to read them";
}

/// Returns what --help of `command` says in a terminal of so many columns; empty if there can be no terminal.
std::string help_in_terminal(const std::string& command, unsigned short columns) {
    const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    if (terminal < 0) return "";
    const bool is_open = grantpt(terminal) == 0 && unlockpt(terminal) == 0;
    const int shown = is_open ? open(ptsname(terminal), O_RDWR | O_NOCTTY) : -1;
    std::string help;
    winsize size{};
    size.ws_col = columns;
    if (shown >= 0 && ioctl(shown, TIOCSWINSZ, &size) == 0) {
        std::fflush(stdout);
        const int before = dup(STDOUT_FILENO);
        dup2(shown, STDOUT_FILENO);
        Action none;
        help = make_command_line(none)->get_subcommand(command)->help("etendue");
        dup2(before, STDOUT_FILENO);
        close(before);
    }
    if (shown >= 0) close(shown);
    close(terminal);
    return help;
}

TEST(Help, FillsTheTerminalAndNoMore) {
    for (const auto& [columns, most] : {std::pair(60, 60), std::pair(120, 120), std::pair(200, 120)})
        for (const std::string command : {"render", "batch", "compare"}) {
            const std::string help = help_in_terminal(command, static_cast<unsigned short>(columns));
            if (help.empty()) GTEST_SKIP() << "there is no terminal";
            std::istringstream lines(help.substr(0, help.find("Examples:")));
            std::size_t longest = 0;
            for (std::string line; std::getline(lines, line);) {
                EXPECT_LE(line.size(), static_cast<std::size_t>(most)) << command << ", " << columns << ": " << line;
                longest = std::max(longest, line.size());
            }
            EXPECT_GE(longest + 8, static_cast<std::size_t>(most)) << command << ", " << columns;
        }
}

}  // namespace

}  // namespace etendue::test
