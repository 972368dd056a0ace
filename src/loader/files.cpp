#include "loader/files.h"

#include "core/error.h"
#include "core/refused_input.h"
#include "core/shown_text.h"
#include "loader/json_text.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

char to_lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

std::optional<int> hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return std::nullopt;
}

}  // namespace

std::string percent_decode(std::string_view uri) {
    std::string decoded;
    decoded.reserve(uri.size());
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            decoded += uri[i];
            continue;
        }
        const std::optional<int> high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : std::nullopt;
        const std::optional<int> low = high ? hex_digit(uri[i + 2]) : std::nullopt;
        if (!low) throw IoError("a '%' is not followed by two hexadecimal digits");
        decoded += static_cast<char>(*high * 16 + *low);
        i += 2;
    }
    return decoded;
}

namespace {

/// True for "http:", "file:", "C:" and whatever else starts like a URI's scheme.
bool has_scheme(std::string_view name) {
    const std::size_t colon = name.find(':');
    if (colon == std::string_view::npos || colon == 0) return false;
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const auto may_follow = [&](char c) {
        return is_letter(c) || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
    };
    return is_letter(name.front()) &&
           std::all_of(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(colon), may_follow);
}

void check_name(std::string_view name) {
    if (name.empty()) throw IoError("the file name is empty");
    if (name.size() > 4096) throw IoError("the file name is longer than 4096 bytes");
    if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; })) {
        throw IoError("the file name contains control characters");
    }
    if (has_scheme(name)) throw RefusedInput("only files inside the scene directory are read, no other URIs");
    if (name.front() == '/') throw RefusedInput("absolute paths are not read, only files inside the scene directory");
    int depth = 0;
    for (const fs::path& part : fs::path(name)) {
        if (part == ".") continue;
        depth += part == ".." ? -1 : 1;
        if (depth < 0) throw RefusedInput("'..' leaves the scene directory, and only files inside it are read");
    }
}

/// True if `check_name` accepts the name.
bool is_name(std::string_view name) {
    try {
        check_name(name);
        return true;
    } catch (const IoError&) {
        return false;
    }
}

/// `name` without letters that have an accent, whether that is part of the letter or follows it (U+0300 to U+036F).
std::string without_accents(std::string_view name) {
    std::string plain;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto byte = static_cast<unsigned char>(name[i]);
        const bool is_mark = byte == 0xcc || byte == 0xcd;
        if (is_mark && !plain.empty()) plain.pop_back();
        if (byte < 0x80) plain += name[i];
    }
    return plain;
}

/// True for names that differ in nothing but upper case and '\\' for '/'.
bool is_same_on_windows(std::string_view a, std::string_view b) {
    const auto plain = [](char c) { return c == '\\' ? '/' : to_lower(c); };
    return std::ranges::equal(a, b, {}, plain, plain);
}

bool is_image_extension(std::string_view extension) {
    constexpr std::array<std::string_view, 9> kImages{".png", ".jpg", ".jpeg", ".webp", ".ktx2",
                                                      ".exr", ".hdr", ".tif",  ".tiff"};
    return std::ranges::find(kImages, extension) != kImages.end();
}

/// True if `file` may have been meant by `name`: both are images, or their extensions differ by a slip at most. So no
/// buffer is taken for the glTF file that names it.
bool is_of_one_kind(const fs::path& file, const fs::path& name) {
    const std::string extension = lower_extension(file);
    const std::string wanted = lower_extension(name);
    if (is_image_extension(extension) && is_image_extension(wanted)) return true;
    return extension == wanted || !nearest_name(wanted, std::array<std::string_view, 1>{extension}).empty();
}

/// Suggests a file that exists in place of `name`, or returns nothing: names may differ by how an accent is encoded, by
/// upper case, by '\\' for '/', or by a few letters.
std::string similar_file(const fs::path& root, std::string_view name) {
    constexpr std::size_t kMostFiles = 1000;
    std::vector<std::string> names;
    std::error_code code;
    std::size_t seen = 0;
    for (fs::recursive_directory_iterator entry(root, code), end; !code && entry != end && seen < kMostFiles;
         entry.increment(code), ++seen) {
        std::error_code ignored;
        if (!entry->is_regular_file(ignored)) continue;
        names.push_back(entry->path().lexically_relative(root).generic_string());
        if (is_same_on_windows(names.back(), name)) return fmt::format("; did you mean '{}'?", shown(names.back()));
        const bool has_accents = without_accents(name).size() < name.size();
        if (has_accents && without_accents(names.back()) == without_accents(name))
            return fmt::format("; there is '{}', which may look the same: its letters are encoded another way",
                               shown(names.back()));
    }
    std::vector<std::string_view> known;
    for (const std::string& file : names)
        if (is_of_one_kind(file, name)) known.push_back(file);
    const std::string nearest = nearest_name(name, known);
    return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", shown(nearest));
}

bool is_inside(const fs::path& directory, const fs::path& file) {
    const auto [in_directory, in_file] = std::mismatch(directory.begin(), directory.end(), file.begin(), file.end());
    return in_directory == directory.end() && in_file != file.end();
}

/// Is thrown if there is no file of that name.
class MissingFile : public IoError {
  public:
    using IoError::IoError;
};

/// Does what `resolve_name` does, and says of `directory` that it is `what`; throws MissingFile if there is no file.
fs::path resolve_below(const fs::path& directory, std::string_view name, std::string_view what) {
    check_name(name);
    std::error_code code;
    const fs::path root = fs::canonical(directory.empty() ? fs::path(".") : directory, code);
    if (code) {
        const std::string message = fmt::format("{} cannot be read: {}", what, code.message());
        if (code == std::errc::no_such_file_or_directory) throw MissingFile(message);
        throw IoError(message);
    }
    fs::path file = fs::weakly_canonical(root / fs::path(name), code);
    if (code) throw IoError("the file cannot be reached: " + code.message());
    if (file != root && !is_inside(root, file))
        throw RefusedInput(fmt::format("a symbolic link leads out of {}", what));

    const fs::file_status status = fs::status(file, code);
    if (fs::is_symlink(fs::symlink_status(file, code)) && !fs::exists(status))
        throw IoError("a symbolic link leads to a file that does not exist");
    if (!fs::exists(status))
        throw MissingFile(fmt::format("the file does not exist in {}{}", what, similar_file(root, name)));
    if (!fs::is_regular_file(status)) throw IoError("this is not a regular file");
    return file;
}

/// Says why `asset` refuses what it has under `name`, which is read from `directory`; nothing if it has no such file.
std::string refusal_of(const fs::path& asset, const fs::path& directory, const fs::path& name) {
    std::error_code code;
    const fs::path root = fs::canonical(asset, code);
    std::vector<fs::path> names;  // in `asset`
    if (is_name(name.string())) names.push_back(name);
    // An absolute path may be spelled as one below it and lead elsewhere.
    for (const fs::path& file : {directory / name, fs::weakly_canonical(directory / name, code)})
        if (!root.empty() && is_inside(root, file)) names.push_back(file.lexically_relative(root));
    for (const fs::path& below : names) {
        try {
            static_cast<void>(resolve_below(asset, below.string(), "this directory"));
        } catch (const MissingFile&) {
            // Another directory may have it.
        } catch (const IoError& error) {
            return error.what();
        }
    }
    return {};
}

}  // namespace

std::string lower_extension(const fs::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), to_lower);
    return extension;
}

fs::path resolve_name(const fs::path& directory, std::string_view name) {
    return resolve_below(directory, name, "the scene directory");
}

fs::path resolve_asset(const fs::path& directory, std::span<const fs::path> assets, std::string_view name) {
    try {
        return resolve_name(directory, name);
    } catch (const IoError& error) {
        std::error_code code;
        fs::path named = fs::weakly_canonical(directory / fs::path(name), code);
        for (const fs::path& asset : assets) {
            const fs::path root = fs::canonical(asset, code);
            if (!code && is_inside(root, named) && fs::is_regular_file(named, code)) return named;
            try {
                return resolve_name(asset, name);
            } catch (const IoError&) {
            }
        }
        for (const fs::path& asset : assets)
            if (const std::string refusal = refusal_of(asset, directory, name); !refusal.empty())
                throw IoError(fmt::format("{}; in '{}' of --assets and $ETENDUE_ASSETS: {}", error.what(),
                                          asset.string(), refusal));
        throw IoError(std::string(error.what()) +
                      (assets.empty() ? "; --assets DIR names a directory outside of it from which it may come"
                                      : "; it is in none of the directories of --assets and $ETENDUE_ASSETS either"));
    }
}

fs::path resolve_uri(const fs::path& directory, std::string_view uri) {
    // A scheme counts before decoding, everything else after it.
    if (has_scheme(uri)) throw RefusedInput("only files inside the scene directory are read, no other URIs");
    try {
        return resolve_name(directory, percent_decode(uri));
    } catch (const IoError&) {
        if (uri.find('%') == std::string_view::npos) throw;
        try {
            return resolve_name(directory, uri);  // some exporters do not encode names, which may have a '%'
        } catch (const IoError&) {
        }
        throw;
    }
}

std::vector<unsigned char> read_bytes(const fs::path& file, std::uintmax_t limit, std::uintmax_t wanted) {
    std::error_code code;
    if (!fs::is_regular_file(file, code)) throw IoError("there is no such file");
    const std::uintmax_t size = fs::file_size(file, code);
    if (code) throw IoError("the file cannot be read: " + code.message());
    if (size < wanted) throw IoError(fmt::format("the file has {} bytes, but {} are needed", size, wanted));
    const std::uintmax_t length = wanted > 0 ? wanted : size;
    if (length > limit) throw IoError(fmt::format("{} bytes are more than the limit of {}", length, limit));

    std::vector<unsigned char> bytes(static_cast<std::size_t>(length));
    std::ifstream stream(file, std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(length));
    if (!stream) throw IoError("the file cannot be read");
    return bytes;
}

}  // namespace etendue
