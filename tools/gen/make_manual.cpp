// make_manual DIRECTORY: writes man pages and the completions of shells below DIRECTORY, as they lie below a share/.
#include "cli/command_help.h"
#include "cli/command_line.h"
#include "cli/man_page.h"
#include "cli/shell_completion.h"
#include "core/write_file.h"
#include "output/software_name.h"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

namespace {

using namespace etendue;

void write(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    write_text(file, text);
}

void write_manual(const std::filesystem::path& share) {
    Action none;
    const CommandHelp program = describe_command(*make_command_line(none));
    const std::string software(software_name());
    write(share / "man/man1/etendue.1", program_page(program, software));
    for (const CommandHelp& command : program.commands)
        write(share / ("man/man1/etendue-" + command.name + ".1"), command_page(program, command, software));
    write(share / "bash-completion/completions/etendue", bash_completion(program));
    write(share / "zsh/site-functions/_etendue", zsh_completion(program));
    write(share / "fish/vendor_completions.d/etendue.fish", fish_completion(program));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("Usage: make_manual DIRECTORY\n", stderr);
        return 2;
    }
    try {
        write_manual(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_manual: %s\n", error.what());
        return 1;
    }
    return 0;
}
