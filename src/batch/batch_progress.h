// Progress of a whole batch on stderr: one line that redraws itself on a terminal, a plain line for each image
// elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// Estimates how long the rest of a batch takes; times of images that have finished correct the estimates, which are
/// of images that have all threads.
class TimeLeft {
  public:
    /// Adds an image that is to be made, with its estimate in seconds; none if nothing is known of it.
    void add(const std::optional<double>& estimate);
    /// Begins the image `index`, which is no more among those to come, with `share` of the threads, (0, 1].
    void begin(std::size_t index, const std::optional<double>& estimate, double share);
    /// Notes that the image `index`, which was begun, has taken `seconds` so far, and that `fraction` of it is done.
    /// This fraction took `rendered` seconds, with those of earlier attempts; if none are given, it took `seconds`.
    void follow(std::size_t index, double seconds, double fraction, const std::optional<double>& rendered = {});
    /// Ends the image after so many seconds; none if that says nothing of the others, as when it failed.
    void end(std::size_t index, const std::optional<double>& seconds);

    /// Returns the seconds until all is done; none if nothing is known.
    [[nodiscard]] std::optional<double> left() const;

  private:
    struct UnderWay {
        std::optional<double> estimate{};
        double share = 1.0;
        double seconds = 0.0;
        double rendered = 0.0;
        double fraction = 0.0;
    };
    /// Returns the seconds that an image of this estimate takes with all threads.
    [[nodiscard]] std::optional<double> expected(const std::optional<double>& estimate) const;

    double to_come_ = 0.0;             ///< sum of the estimates
    std::size_t unknown_to_come_ = 0;  ///< images to come without an estimate
    std::map<std::size_t, UnderWay> under_way_{};
    double finished_estimates_ = 0.0;    ///< estimates of finished images that have one
    double finished_seconds_ = 0.0;      ///< seconds of finished images that have an estimate, with all threads
    double all_finished_seconds_ = 0.0;  ///< seconds of all finished images, with all threads
    std::size_t finished_ = 0;
};

/// Holds what the line of progress shows.
struct BatchProgressLine {
    /// Names an image under way, or what else is done, with how far that is: "43%", "load".
    struct UnderWay {
        std::string name{};
        std::string state{};
    };
    std::size_t done = 0;
    std::size_t failed = 0;  ///< images of `done` that failed
    std::size_t of = 0;
    std::vector<UnderWay> under_way{};  ///< from the one that was begun first on
    double elapsed = 0.0;               ///< seconds of the batch
    std::optional<double> left{};
    std::chrono::system_clock::time_point now{};  ///< time of day, from which that of the end is told
};
/// Returns "[12/40, 1 failed] ", without those that failed if none has.
[[nodiscard]] std::string format_count(std::size_t done, std::size_t failed, std::size_t of);
/// Formats the line of progress in `width` characters at most: the first name may lose its beginning, and images for
/// which there is no room are counted.
[[nodiscard]] std::string format_line(const BatchProgressLine& line, int width);

/// Returns the local time of day, "23:40", with the weekday or the date if it is not the day of `now`.
[[nodiscard]] std::string format_clock(std::chrono::system_clock::time_point time,
                                       std::chrono::system_clock::time_point now);

class BatchProgress {
  public:
    /// Shows the progress of a batch on stderr, but for nothing if `quiet`, and appends every line to the file `log`
    /// unless that is empty. Where stderr is no terminal, and in the file, there is a line of progress for each time
    /// `between_lines`, and lines begin with the time. Throws UsageError if the file cannot be opened, IoError if
    /// it is a pipe that has a name.
    explicit BatchProgress(bool quiet, const std::filesystem::path& log = {},
                           std::chrono::milliseconds between_lines = std::chrono::minutes(1));
    ~BatchProgress();
    BatchProgress(const BatchProgress&) = delete;
    BatchProgress& operator=(const BatchProgress&) = delete;

    /// Shows the line if it was not shown just now.
    void update(BatchProgressLine line);
    /// Takes the line away, so that others can write.
    void clear();
    /// Writes a line that stays.
    void say(const std::string& text);
    /// Writes a line that stays, even if all else is quiet.
    void say_error(const std::string& text);

    /// Returns the seconds since the beginning.
    [[nodiscard]] double elapsed() const;

  private:
    using Clock = std::chrono::steady_clock;

    /// Appends a line to the log.
    void record(const std::string& text);

    bool quiet_;
    bool terminal_;
    std::ofstream log_{};
    std::chrono::milliseconds between_lines_;
    Clock::time_point last_line_ = Clock::now();
    bool is_drawn_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point drawn_{};
};

}  // namespace etendue
