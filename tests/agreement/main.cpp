// The gate of agreement: every two integrators that find all light of a room, in every room of the matrix of
// docs/agreement.md.
//
// All comparisons together fail with probability 0.01 if everything is right (Sidak's correction); seeds are fixed.
#include "agreement/agreement_report.h"
#include "agreement/matrix_room.h"
#include "agreement/room_comparison.h"
#include "agreement/room_traits.h"
#include "core/parallel.h"
#include "core/write_file.h"
#include "support/chi2.h"

#include <cstddef>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue::test {
namespace {

struct Arguments {
    bool list = false;
    std::string filter;
    std::size_t every = 1;
    std::size_t from = 0;
    std::filesystem::path markdown;
    ComparisonOptions comparison;
};

/// A room and its place in the matrix.
using Numbered = std::pair<std::size_t, RoomTraits>;

std::vector<Numbered> rooms_with(const std::string& filter, std::size_t every, std::size_t from) {
    std::vector<Numbered> result;
    const std::vector<RoomTraits> rooms = all_rooms();
    for (std::size_t i = from; i < rooms.size(); i += every)
        if (name_of(rooms[i]).find(filter) != std::string::npos) result.emplace_back(i, rooms[i]);
    return result;
}

std::size_t count_pairs(const std::vector<Numbered>& rooms) {
    std::size_t pairs = 0;
    for (const auto& [index, room] : rooms) {
        const std::size_t finders = finders_of(room).size();
        pairs += finders * (finders - 1) / 2;
    }
    return pairs;
}

void report_progress(const RoomComparison& result, std::size_t done, std::size_t all) {
    std::string line = fmt::format("[{}/{}] {}: ", done, all, name_of(result.room));
    line += result.agrees() ? "agrees" : "DISAGREES";
    line += fmt::format(" ({:.1f} s)\n", result.seconds);
    for (const PairComparison& pair : result.pairs)
        if (!pair.agreement.agree())
            line += fmt::format("    {} against {}: {}\n", pair.a, pair.b, pair.agreement.str());
    std::cerr << line;
}

/// In the order of `rooms`.
std::vector<RoomComparison> compare_all(const std::vector<Numbered>& rooms, const ComparisonOptions& options) {
    const RoomImages images;
    const ThreadPool threads;
    std::vector<RoomComparison> results(rooms.size());
    std::size_t done = 0;
    std::mutex mutex;
    threads.parallel_for(rooms.size(), [&](std::size_t i, int) {
        results[i] = compare_in_room(rooms[i].second, rooms[i].first, images, options);
        const std::lock_guard lock(mutex);
        report_progress(results[i], ++done, rooms.size());
    });
    return results;
}

void write_report(const std::filesystem::path& path, const std::string& report) {
    std::ifstream file(path);
    const std::string document{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    write_text(path, with_report(document, report));
}

int run(Arguments arguments) {
    const std::vector<Numbered> rooms = rooms_with(arguments.filter, arguments.every, arguments.from);
    if (arguments.list) {
        for (const auto& [index, room] : rooms) {
            std::string line = name_of(room) + ":";
            for (const std::string& name : finders_of(room)) line += " " + name;
            std::cout << line << '\n';
        }
        return 0;
    }
    if (rooms.empty()) throw std::invalid_argument("no room's name contains '" + arguments.filter + "'");
    arguments.comparison.significance = sidak_level(kFamilyLevel, count_pairs(rooms));
    const std::vector<RoomComparison> results = compare_all(rooms, arguments.comparison);
    const std::string report = markdown_report(results, kFamilyLevel);
    if (arguments.markdown.empty()) {
        std::cout << report;
    } else {
        write_report(arguments.markdown, report);
    }
    for (const RoomComparison& result : results)
        if (!result.agrees()) return 1;
    return 0;
}

}  // namespace
}  // namespace etendue::test

int main(int argc, char** argv) {
    CLI::App app("Renders the rooms of docs/agreement.md by every integrator that finds their light, and compares.");
    etendue::test::Arguments arguments;
    app.add_flag("--list", arguments.list, "say which rooms there are and who finds their light, and stop");
    app.add_option("--filter", arguments.filter, "only rooms whose names contain this text");
    app.add_option("--every", arguments.every, "only every Nth room of the matrix, a look at all kinds of them")
        ->check(CLI::Range(1, 1000));
    app.add_option("--from", arguments.from, "begin with the room of this number");
    app.add_option("--samples", arguments.comparison.samples, "multiply the samples of every image")
        ->check(CLI::Range(1, 1024));
    app.add_option("--out", arguments.comparison.failures, "directory for the images that disagree");
    app.add_option("--markdown", arguments.markdown, "write the report between this file's marks, not to the terminal")
        ->check(CLI::ExistingFile);
    app.footer("Exit codes: 0 all agree, 1 some disagree, 2 it could not be told.");
    CLI11_PARSE(app, argc, argv);
    try {
        return etendue::test::run(std::move(arguments));
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return 2;
    }
}
