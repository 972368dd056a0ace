// Text that arrives in pieces, line by line.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace etendue {

class LineSplitter {
  public:
    using Callback = std::function<void(const std::string& line)>;

    /// Splits text into lines; bytes of a line beyond `longest` are left out.
    explicit LineSplitter(std::size_t longest) : longest_(longest) {}

    /// Calls `take` with every line that is complete now, without its newline.
    void add(std::string_view text, const Callback& take);
    /// Calls `take` with the text behind the last newline, if there is any.
    void finish(const Callback& take);

  private:
    std::size_t longest_;
    std::string line_;
};

}  // namespace etendue
