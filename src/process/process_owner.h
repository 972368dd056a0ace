// Which process of which machine something belongs to.
#pragma once

#include <cstdint>
#include <string>

namespace etendue {

struct ProcessOwner {
    std::string host{};            ///< its name, for people
    std::string machine{};         ///< this start of the system and, in containers, this set of process ids
    std::int64_t pid = 0;          ///< is used again, hence:
    std::uint64_t start_time = 0;  ///< start of the process, in clock ticks since the system started

    friend bool operator==(const ProcessOwner&, const ProcessOwner&) = default;
    /// Names the process for people: "host:pid".
    [[nodiscard]] std::string str() const;
};

/// Returns the owner that stands for the process that asks.
[[nodiscard]] ProcessOwner this_process();

enum class Liveness {
    Alive,
    Dead,
    Unknown,  ///< it is of another machine
};
[[nodiscard]] Liveness liveness(const ProcessOwner& owner);

}  // namespace etendue
