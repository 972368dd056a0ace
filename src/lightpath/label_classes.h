// Names in classes: those that no expression can tell apart count as one letter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// True if `name` is `pattern`, in which * stands for any characters, and \ makes the *, \ or quote behind it that
/// character. In time proportional to their lengths' product.
[[nodiscard]] bool matches_label(std::string_view pattern, std::string_view name);

/// True if the character of `pattern` at `place` makes the one behind it stand for itself.
[[nodiscard]] bool is_label_escape(std::string_view pattern, std::size_t place);

/// Returns the pattern that `name` alone matches, in quotes of either kind.
[[nodiscard]] std::string label_pattern(std::string_view name);

/// Which patterns each name matches. Names without any are in class 0.
class LabelClasses {
  public:
    /// Something matches by its name or its alias; `aliases` may be empty, and fewer than `names`.
    LabelClasses(std::vector<std::string> patterns, std::span<const std::string> names,
                 std::span<const std::string> aliases = {});

    /// Returns the class of the name with this index.
    [[nodiscard]] std::uint16_t of(std::size_t name) const { return classes_[name]; }
    [[nodiscard]] std::size_t count() const { return matched_.size(); }
    /// True if the names of class `label` match `pattern`, one of those that this was made with; the empty one is any.
    [[nodiscard]] bool matches(std::size_t label, std::string_view pattern) const;
    /// Patterns that no name matches.
    [[nodiscard]] std::vector<std::string> unmatched() const;

  private:
    std::vector<std::string> patterns_;
    std::vector<std::uint16_t> classes_;
    std::vector<std::vector<bool>> matched_;  ///< by class, by pattern
};

}  // namespace etendue
