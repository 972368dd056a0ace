// The numbers of an IES file, with the lines they stand in.
#pragma once

#include "core/error.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Reads lines, then numbers between white space and commas. Lines end in LF, CR LF or CR.
class IesTokens {
  public:
    IesTokens(std::string_view text, const SourceLocation& where) : rest_(text), where_(where) {}

    [[nodiscard]] bool at_end() const { return rest_.empty(); }
    /// The next line, without its end.
    [[nodiscard]] std::string_view line();

    /// The next number, in [low, high]. `what` names it in messages.
    [[nodiscard]] double number(std::string_view what, double low, double high);
    /// The next number, which must be an integer.
    [[nodiscard]] int integer(std::string_view what, int low, int high);
    /// The next `count` numbers; refused before memory is taken if the text cannot hold that many.
    [[nodiscard]] std::vector<double> numbers(std::string_view what, std::size_t count, double low, double high);

    /// Throws a SceneError that says which line was read last.
    [[noreturn]] void fail(const std::string& message) const;

  private:
    void skip_delimiters();

    std::string_view rest_;
    const SourceLocation& where_;
    std::size_t line_ = 1;
};

}  // namespace etendue
