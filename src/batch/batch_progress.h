// Progress of a whole batch on stderr: one line that redraws itself on a terminal, a plain line for each image
// elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace etendue {

/// How long the rest takes, from estimates that what has finished corrects.
class TimeLeft {
  public:
    /// An image that is to be made; none if nothing is known of it.
    void add(const std::optional<double>& estimate);
    /// The next of them is begun: it is no more among those to come.
    void begin(const std::optional<double>& estimate);
    /// It took so many seconds; none if that says nothing of the others, as when it failed.
    void end(const std::optional<double>& seconds);

    /// Seconds until all is done. `seconds` and `fraction` are of the image that was begun. None if nothing is known.
    [[nodiscard]] std::optional<double> left(double seconds, double fraction) const;

  private:
    [[nodiscard]] std::optional<double> expected(const std::optional<double>& estimate) const;

    double to_come_ = 0.0;             ///< sum of the estimates
    std::size_t unknown_to_come_ = 0;  ///< images without one
    bool has_current_ = false;
    std::optional<double> current_{};  ///< estimate
    double finished_estimates_ = 0.0;  ///< of those that have one
    double finished_seconds_ = 0.0;    ///< of the same
    double all_finished_seconds_ = 0.0;
    std::size_t finished_ = 0;
};

/// What the line shows.
struct BatchProgressLine {
    std::size_t done = 0;
    std::size_t failed = 0;  ///< of those
    std::size_t of = 0;
    std::string current{};  ///< name of the image under way, or what else is done
    std::string state{};    ///< of it: "43%", "load"
    double elapsed = 0.0;   ///< seconds of the batch
    std::optional<double> left{};
};
/// `width` characters at most; a name that is too long loses its beginning.
[[nodiscard]] std::string format_line(const BatchProgressLine& line, int width);

class BatchProgress {
  public:
    /// Nothing is written if `quiet`.
    explicit BatchProgress(bool quiet);
    ~BatchProgress();
    BatchProgress(const BatchProgress&) = delete;
    BatchProgress& operator=(const BatchProgress&) = delete;

    /// Shows the line, on a terminal, if it was not shown just now.
    void update(BatchProgressLine line);
    /// Takes the line away, so that others can write.
    void clear();
    /// Writes a line that stays.
    void say(const std::string& text);

    /// Seconds since the beginning.
    [[nodiscard]] double elapsed() const;

  private:
    using Clock = std::chrono::steady_clock;

    bool quiet_;
    bool terminal_;
    bool is_drawn_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point drawn_{};
};

}  // namespace etendue
