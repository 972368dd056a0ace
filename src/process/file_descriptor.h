// An open file of the system, closed at the end.
#pragma once

#include <utility>

namespace etendue {

class FileDescriptor {
  public:
    /// Owns `number`; a negative one is none.
    explicit FileDescriptor(int number = -1) : number_(number) {}
    ~FileDescriptor() { close(); }
    FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    FileDescriptor& operator=(FileDescriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;

    [[nodiscard]] int get() const { return number_; }
    [[nodiscard]] bool is_open() const { return number_ >= 0; }
    /// Without a word of what went wrong: for files that were read, or synchronised before.
    void close();

  private:
    int number_;
};

}  // namespace etendue
