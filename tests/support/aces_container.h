// The constraints of SMPTE ST 2065-4 that docs/colour.md lists, checked on the bytes of a file, without the libraries
// that wrote it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace etendue::test {

/// One attribute of an EXR header.
struct ExrAttribute {
    std::string type;
    std::vector<std::byte> value;
};

class AcesContainerCheck {
  public:
    /// Lists what is wrong with the file, a line each; empty if it satisfies all constraints.
    [[nodiscard]] static std::vector<std::string> violations(std::span<const std::byte> file) {
        AcesContainerCheck check(file);
        check.run();
        return check.violations_;
    }

    /// The attributes of the first header by their names.
    [[nodiscard]] static std::map<std::string, ExrAttribute> attributes(std::span<const std::byte> file) {
        AcesContainerCheck check(file);
        check.read_header();
        return check.attributes_;
    }

  private:
    explicit AcesContainerCheck(std::span<const std::byte> file) : file_(file) {}

    template <typename T>
    [[nodiscard]] T number(std::span<const std::byte> bytes, std::size_t at) const {
        std::array<std::byte, sizeof(T)> raw{};
        if (at + sizeof(T) <= bytes.size())
            std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), sizeof(T), raw.begin());
        return std::bit_cast<T>(raw);
    }

    void require(bool is_so, const std::string& what) {
        if (!is_so) violations_.push_back(what);
    }

    std::string take_string() {
        std::string text;
        while (at_ < file_.size() && file_[at_] != std::byte{0}) text += static_cast<char>(file_[at_++]);
        ++at_;
        return text;
    }

    void read_header() {
        at_ = 8;
        while (at_ < file_.size()) {
            const std::string name = take_string();
            if (name.empty()) return;
            const std::string type = take_string();
            const auto size = number<std::uint32_t>(file_, at_);
            at_ += 4;
            if (at_ + size > file_.size()) return;
            const auto value = file_.subspan(at_, size);
            require(attributes_.emplace(name, ExrAttribute{type, {value.begin(), value.end()}}).second,
                    name + " stands twice");
            at_ += size;
        }
    }

    [[nodiscard]] std::span<const std::byte> value(const std::string& name) const {
        const auto found = attributes_.find(name);
        return found == attributes_.end() ? std::span<const std::byte>() : std::span(found->second.value);
    }

    void check_attributes() {
        const std::map<std::string, std::string> required{
            {"acesImageContainerFlag", "int"}, {"channels", "chlist"},        {"chromaticities", "chromaticities"},
            {"compression", "compression"},    {"dataWindow", "box2i"},       {"displayWindow", "box2i"},
            {"lineOrder", "lineOrder"},        {"pixelAspectRatio", "float"}, {"screenWindowCenter", "v2f"},
            {"screenWindowWidth", "float"}};
        for (const auto& [name, type] : required) {
            require(attributes_.count(name) == 1, name + " is missing");
            if (attributes_.count(name) == 1)
                require(attributes_.at(name).type == type, fmt::format("{} is no {}", name, type));
        }
        const std::set<std::string> types{
            "box2i",    "chlist",       "chromaticities", "compression",  "double",        "float",  "half",
            "int",      "lineOrder",    "keycode",        "rational",     "short",         "string", "stringVector",
            "timecode", "unsignedChar", "unsignedInt",    "unsignedLong", "unsignedShort", "v2f",    "v3f"};
        for (const auto& [name, attribute] : attributes_) {
            require(types.count(attribute.type) == 1, name + " is a " + attribute.type + ", which is no type of them");
            require(name.size() <= 31 && attribute.type.size() <= 31, name + " is longer than 31 characters");
            require(required.count(name) == 1 || name == "comments" || name == "capDate",
                    name + " is neither required nor one of the two others that are written");
        }
        require(number<std::int32_t>(value("acesImageContainerFlag"), 0) == 1, "acesImageContainerFlag is not 1");
        require(value("compression").size() == 1 && value("compression")[0] == std::byte{0}, "it is compressed");
        require(value("lineOrder").size() == 1 && value("lineOrder")[0] == std::byte{0}, "lines do not go down");
        constexpr std::array<float, 8> kAces{0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.077f, 0.32168f, 0.33767f};
        for (std::size_t i = 0; i < 8; ++i)
            require(number<float>(value("chromaticities"), 4 * i) == kAces[i], fmt::format("chromaticity {}", i));
    }

    /// B, G, R or A, B, G, R, each half and not subsampled.
    void check_channels() {
        const auto list = value("channels");
        std::string names;
        std::size_t at = 0;
        while (at < list.size() && list[at] != std::byte{0}) {
            std::string name;
            while (at < list.size() && list[at] != std::byte{0}) name += static_cast<char>(list[at++]);
            names += name + " ";
            require(number<std::int32_t>(list, at + 1) == 1, name + " is not half");
            require(number<std::int32_t>(list, at + 9) == 1 && number<std::int32_t>(list, at + 13) == 1,
                    name + " is subsampled");
            at += 17;
        }
        require(names == "B G R " || names == "A B G R ", "the channels are " + names);
        channel_count_ = names == "A B G R " ? 4 : 3;
    }

    /// One chunk a line, from the top down, one after the other, of halves that are finite, and nothing behind them.
    void check_pixels() {
        const auto box = value("dataWindow");
        const std::int64_t width = number<std::int32_t>(box, 8) - number<std::int32_t>(box, 0) + 1;
        const std::int64_t height = number<std::int32_t>(box, 12) - number<std::int32_t>(box, 4) + 1;
        require(width > 0 && height > 0, "there are no pixels");
        const std::size_t line_bytes = static_cast<std::size_t>(width * channel_count_ * 2);
        const std::size_t lines = at_ + static_cast<std::size_t>(height) * 8;
        require(file_.size() == lines + static_cast<std::size_t>(height) * (8 + line_bytes),
                "the file is not as long as its lines are");
        for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
            const std::size_t begin = lines + y * (8 + line_bytes);
            require(number<std::uint64_t>(file_, at_ + 8 * y) == begin, fmt::format("line {} is elsewhere", y));
            require(number<std::int32_t>(file_, begin) == number<std::int32_t>(box, 4) + static_cast<std::int32_t>(y),
                    fmt::format("line {} is another", y));
            require(number<std::uint32_t>(file_, begin + 4) == line_bytes, fmt::format("line {} has another size", y));
            for (std::size_t i = 0; i < line_bytes; i += 2)
                require((number<std::uint16_t>(file_, begin + 8 + i) & 0x7c00u) != 0x7c00u,
                        fmt::format("line {} has values that are not finite", y));
        }
    }

    void run() {
        require(number<std::uint32_t>(file_, 0) == 20000630u, "the magic number is another");
        const auto version = number<std::uint32_t>(file_, 4);
        require(version == 2u || version == 1026u, fmt::format("the version field is {}", version));
        read_header();
        check_attributes();
        check_channels();
        if (violations_.empty()) check_pixels();
    }

    std::span<const std::byte> file_;
    std::size_t at_ = 0;
    std::map<std::string, ExrAttribute> attributes_;
    std::int64_t channel_count_ = 3;
    std::vector<std::string> violations_;
};

}  // namespace etendue::test
