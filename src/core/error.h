// Problems with a scene or its settings: where, how bad, what, and what to do. Thrown only while loading and writing.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// A place in an input file.
struct SourceLocation {
    std::string file;     ///< path as the user gave it, or relative to the scene directory
    std::string pointer;  ///< JSON pointer (RFC 6901) inside the file; empty for the file as a whole

    /// `file`, or `file#pointer`.
    [[nodiscard]] std::string str() const { return pointer.empty() ? file : file + "#" + pointer; }
    friend bool operator==(const SourceLocation&, const SourceLocation&) = default;
};

enum class Severity { Note, Warning, Error };

struct Problem {
    Severity severity = Severity::Error;
    SourceLocation where;
    std::string message;  ///< the fault, and what to do or what is done about it

    /// `error: file#pointer: message`
    [[nodiscard]] std::string str() const;
};

/// All problems found, in the order in which they were found. At most `kMaxProblems` are kept, and of a long pointer or
/// message only its beginning and its end, so that a hostile file cannot exhaust memory; how many more problems there
/// were is counted.
class ProblemList {
  public:
    static constexpr std::size_t kMaxProblems = 1000;
    static constexpr std::size_t kMaxPointer = 1024;  ///< bytes
    static constexpr std::size_t kMaxMessage = 4096;  ///< bytes

    void note(SourceLocation where, std::string message) {
        add({Severity::Note, std::move(where), std::move(message)});
    }
    void warning(SourceLocation where, std::string message) {
        add({Severity::Warning, std::move(where), std::move(message)});
    }
    void error(SourceLocation where, std::string message) {
        add({Severity::Error, std::move(where), std::move(message)});
    }
    void add(Problem problem);

    [[nodiscard]] std::span<const Problem> all() const { return problems_; }
    [[nodiscard]] bool has_errors() const { return error_count_ > 0; }
    [[nodiscard]] std::size_t error_count() const { return error_count_; }
    [[nodiscard]] std::size_t dropped() const { return dropped_; }
    /// Returns whether another problem would only be counted: nobody reads its message.
    [[nodiscard]] bool is_full() const { return problems_.size() >= kMaxProblems; }

  private:
    std::vector<Problem> problems_;
    std::size_t error_count_ = 0;
    std::size_t dropped_ = 0;
};

/// Invalid scene or settings: exit code 3. `what()` is one problem a line, errors only.
class SceneError : public std::runtime_error {
  public:
    explicit SceneError(ProblemList problems);
    SceneError(SourceLocation where, std::string message);

    [[nodiscard]] const ProblemList& problems() const { return problems_; }

  private:
    ProblemList problems_;
};

/// Something outside the scene failed (disk full, permission): exit code 1.
class IoError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A file that would be written is one that is read, and would be lost: exit code 2.
class ReplacedInput : public IoError {
  public:
    using IoError::IoError;
};

/// Suggests what to write instead of `name`: "did you mean 'x'?" if one of `known` is near enough, else a list of the
/// first 20 of `known`, of each its first 64 bytes.
[[nodiscard]] std::string name_hint(std::string_view name, std::span<const std::string_view> known);

/// The member of `known` nearest to `name` in edit distance if it is near enough to suggest, else an empty string. Of
/// thousands, only the first ones are looked at.
[[nodiscard]] std::string nearest_name(std::string_view name, std::span<const std::string_view> known);

}  // namespace etendue
