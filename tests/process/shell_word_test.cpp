#include "process/shell_word.h"

#include "process/run_command.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(ShellWord, BashReadsItBackAndRunsNothing) {
    std::vector<std::string> words{"",
                                   "plain",
                                   "a b",
                                   "it's",
                                   "$(echo run)",
                                   "`echo run`",
                                   "; echo run #",
                                   "back\\slash\\",
                                   "\"quoted\"",
                                   "two\nlines",
                                   "\n",
                                   "'\\'\n'",
                                   "tab\tand \x1b[31m bell \a",
                                   "-n",
                                   "*",
                                   "~root",
                                   "!!",
                                   "\xc3\xa9 and \xff"};
    std::string all;
    for (char c = 1; c != 0; ++c) all += c;
    words.push_back(all);
    for (const std::string& word : words) {
        const std::string line = quoted(word);
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        const CommandResult result = run_command({"bash", "-c", "printf %s " + line + " end"});
        EXPECT_EQ(result.out, word + "end") << line;
        EXPECT_EQ(result.err, "") << line;
    }
}

TEST(ShellWord, WithoutControlCharactersEveryShellReadsIt) {
    EXPECT_EQ(quoted("a b"), "'a b'");
    EXPECT_EQ(quoted("it's"), R"('it'\''s')");
}

}  // namespace

}  // namespace etendue::test
