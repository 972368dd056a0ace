#include "app/program.h"

#include "app/command_line.h"
#include "app/interrupt.h"
#include "app/usage_error.h"
#include "core/error.h"
#include "core/log.h"
#include "film/film.h"
#include "processor/ray_code.h"

#include <exception>
#include <memory>
#include <new>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

/// Runs `action` and turns what it throws into messages and exit codes.
ExitCode run(const Action& action) {
    try {
        return action();
    } catch (const SceneError& error) {
        log_error("{}", error.what());
        return ExitCode::InvalidScene;
    } catch (const UsageError& error) {
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

}  // namespace

int run_program(int argc, char** argv) {
    try {
        (void)ray_code();
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
        const int code = app->exit(error);
        return code == 0 ? 0 : static_cast<int>(ExitCode::UsageError);
    }
    install_interrupt_handlers();
    return static_cast<int>(run(action));
}

}  // namespace etendue
