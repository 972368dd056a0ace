// What an OpenColorIO config refers to: files, and colour spaces by way of others.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <OpenColorIO/OpenColorIO.h>

namespace etendue {

struct ConfigReferences {
    std::vector<std::filesystem::path> files;  ///< look-up tables that exist, each once
    std::string problem;                       ///< why OpenColorIO must not follow them; empty if it can
};

/// Follows all references of `config`, before OpenColorIO does, which follows those in a circle until its stack is full
/// and reads tables that never end.
[[nodiscard]] ConfigReferences find_references(const OCIO_NAMESPACE::Config& config);

/// Why `file` must not be opened to read a config or a table from; empty if it can: it is a regular file, and small
/// enough to be one of these.
[[nodiscard]] std::string why_not_read(const std::filesystem::path& file);

}  // namespace etendue
