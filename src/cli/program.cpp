#include "cli/program.h"

#include "cli/command_line.h"
#include "cli/command_mistakes.h"
#include "core/error.h"
#include "core/log.h"
#include "core/source_date.h"
#include "core/standard_output.h"
#include "film/film.h"
#include "process/process_limits.h"
#include "processor/ray_code.h"
#include "session/interrupt.h"
#include "session/usage_error.h"

#include <csignal>
#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

ExitCode run_action(const Action& action) {
    try {
        return action();
    } catch (const SceneError& error) {
        // One by one: what follows the first line of a message is no message of its own.
        for (const Problem& problem : error.problems().all())
            if (problem.severity == Severity::Error) log_error("{}", problem.str());
        if (const std::size_t more = error.problems().dropped()) log_error("(and {} more problems)", more);
        return ExitCode::InvalidScene;
    } catch (const UsageError& error) {
        log_error("error: {}", error.what());
        return ExitCode::UsageError;
    } catch (const ReplacedInput& error) {
        log_error("error: {}", error.what());
        return ExitCode::UsageError;
    } catch (const std::bad_alloc&) {
        log_error(
            "error: there is not enough memory for the scene and its image; a smaller --size or --crop needs less, {} "
            "bytes a pixel",
            sizeof(PixelSum));
        return ExitCode::RenderFailed;
    } catch (const std::exception& error) {
        log_error("error: {}", error.what());
        return ExitCode::RenderFailed;
    }
}

namespace {

/// Says what is wrong with a command line, or prints what --help and --version ask for.
ExitCode answer(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
        std::ostringstream out;
        (void)app.exit(error, out, out);
        print_text(out.str());
        return ExitCode::Success;
    }
    log_error("error: {}", mistake_in_words(app, error));
    return ExitCode::UsageError;
}

}  // namespace

int run_program(int argc, char** argv) {
    keep_standard_descriptors();
    // A file that would pass the limit of file sizes (ulimit -f) is an error of writing, also of help and of errors.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        (void)ray_code();
        (void)source_date();
    } catch (const std::invalid_argument& error) {
        log_error("error: {}", error.what());
        return static_cast<int>(ExitCode::UsageError);
    }
    Action action;
    const std::unique_ptr<CLI::App> app = make_command_line(action);
    try {
        // CLI11 would only say that a command is missing.
        if (argc > 1 && argv[1][0] != '-') require_command(*app, argv[1]);
        app->parse(argc, argv);
    } catch (const UsageError& error) {
        log_error("error: {}", error.what());
        return static_cast<int>(ExitCode::UsageError);
    } catch (const CLI::ParseError& error) {
        return static_cast<int>(run_action([&] { return answer(*app, error); }));
    }
    install_interrupt_handlers();
    return static_cast<int>(run_action([&] {
        require_process_limits();
        return action();
    }));
}

}  // namespace etendue
