// The one exception that the library throws.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <etendue/message.h>

namespace etendue {

/// `what()` has one error a line.
class [[gnu::visibility("default")]] Error : public std::runtime_error {
  public:
    enum class Kind {
        InvalidScene,  ///< the scene or its settings are wrong: another input may work
        Failed,        ///< something else failed: memory, a full disk, a missing permission
    };

    Error(Kind kind, const std::string& what, std::vector<Message> messages);

    [[nodiscard]] Kind kind() const noexcept {
        return kind_;
    }
    /// All errors, at least one.
    [[nodiscard]] std::span<const Message> messages() const noexcept {
        return messages_;
    }
    /// The file of the first error; empty if it is about none.
    [[nodiscard]] const std::string& file() const noexcept {
        return messages_.front().file;
    }
    /// The JSON pointer of the first error inside its file.
    [[nodiscard]] const std::string& pointer() const noexcept {
        return messages_.front().pointer;
    }

  private:
    Kind kind_;
    std::vector<Message> messages_;
};

}  // namespace etendue
