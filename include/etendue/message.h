// What the library has to say: a sentence, and the place that it is about.
#pragma once

#include <string>

namespace etendue {

struct Message {
    enum class Kind { Note, Warning, Error };
    Kind kind = Kind::Error;
    std::string file;     ///< that the message is about; "(settings)" for settings that the caller gave; may be empty
    std::string pointer;  ///< JSON pointer (RFC 6901) inside the file; empty for the file as a whole
    std::string text;     ///< says what is wrong, and what to do or what is done about it
};

}  // namespace etendue
