#include "loader/gltf/meshopt_attributes.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace etendue {

namespace {

using Bytes = std::span<const unsigned char>;

constexpr unsigned char kVersion1 = 0xa1;
constexpr std::size_t kGroup = 16;  ///< elements whose deltas are coded alike
constexpr std::size_t kMostInBlock = 256;

[[noreturn]] void refuse() {
    throw IoError("the compressed bytes are damaged");
}

/// Hands out bytes from the front.
class ByteReader {
  public:
    explicit ByteReader(Bytes bytes) : bytes_(bytes) {}

    Bytes take(std::size_t count) {
        if (count > bytes_.size()) refuse();
        const Bytes taken = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return taken;
    }
    [[nodiscard]] bool empty() const { return bytes_.empty(); }

  private:
    Bytes bytes_;
};

/// The two bits numbered `index`, from the least significant bit on.
unsigned two_bits(Bytes packed, std::size_t index) {
    return (packed[index / 4] >> (2 * (index % 4))) & 3u;
}

/// The deltas of one group, of `bits` each; those with all bits set follow as whole bytes.
std::array<unsigned char, kGroup> read_group(ByteReader& in, unsigned bits) {
    std::array<unsigned char, kGroup> deltas{};
    if (bits == 0) return deltas;
    const Bytes packed = in.take(kGroup * bits / 8);
    const std::size_t per_byte = 8 / bits;
    const unsigned sentinel = (1u << bits) - 1;
    for (std::size_t i = 0; i < kGroup; ++i) {
        const std::size_t within = i % per_byte;
        // Single bits start at the least significant one, others at the most significant ones.
        const std::size_t shift = bits == 1 ? within : 8 - bits * (within + 1);
        const unsigned value = (packed[i / per_byte] >> shift) & sentinel;
        deltas[i] = static_cast<unsigned char>(value);
        if (bits < 8 && value == sentinel) deltas[i] = in.take(1).front();
    }
    return deltas;
}

/// The deltas of one byte of all elements of a block.
void read_deltas(ByteReader& in, unsigned control, std::span<unsigned char> deltas) {
    constexpr unsigned kZeros = 2, kLiteral = 3;
    if (control == kZeros || control == kLiteral) {
        std::ranges::fill(deltas, static_cast<unsigned char>(0));
        if (control == kLiteral) std::ranges::copy(in.take(deltas.size()), deltas.begin());
        return;
    }
    constexpr std::array<std::array<unsigned, 4>, 2> kBits{{{0, 1, 2, 4}, {1, 2, 4, 8}}};
    const std::size_t groups = (deltas.size() + kGroup - 1) / kGroup;
    const Bytes headers = in.take((groups + 3) / 4);
    for (std::size_t g = 0; g < groups; ++g) {
        const auto group = read_group(in, kBits[control][two_bits(headers, g)]);
        const std::size_t first = g * kGroup;
        std::copy_n(group.begin(), std::min(kGroup, deltas.size() - first), deltas.subspan(first).begin());
    }
}

/// A number of `T`, its least significant byte first, whose bytes lie `step` apart.
template <typename T>
T gather(const unsigned char* bytes, std::size_t step) {
    std::uint32_t value = 0;
    for (std::size_t b = 0; b < sizeof(T); ++b) value |= std::uint32_t{bytes[b * step]} << (8 * b);
    return static_cast<T>(value);
}

template <typename T>
void scatter(T value, unsigned char* bytes) {
    for (std::size_t b = 0; b < sizeof(T); ++b) bytes[b] = static_cast<unsigned char>(value >> (8 * b));
}

/// Numbers of `T` from the deltas of their bytes, `count` for each byte, the first from `previous`, which becomes the
/// last. `add(number, delta)` is the next number.
template <typename T, typename Add>
void accumulate(const unsigned char* deltas, std::size_t count, unsigned char* previous, unsigned char* out,
                std::size_t stride, const Add& add) {
    T number = gather<T>(previous, 1);
    for (std::size_t i = 0; i < count; ++i) {
        number = add(number, gather<T>(deltas + i, count));
        scatter(number, out + i * stride);
    }
    scatter(number, previous);
}

/// Four bytes of each element of a block.
void decode_channel(unsigned mode, const unsigned char* deltas, std::size_t count, unsigned char* previous,
                    unsigned char* out, std::size_t stride) {
    const auto add_zigzag = []<typename T>(T number, T delta) {
        const auto magnitude = static_cast<T>(delta >> 1);
        return static_cast<T>(number + ((delta & 1) != 0 ? static_cast<T>(~magnitude) : magnitude));
    };
    const int rotation = static_cast<int>(mode >> 4);
    switch (mode & 15) {
        case 0:
            for (std::size_t b = 0; b < 4; ++b)
                accumulate<std::uint8_t>(deltas + b * count, count, previous + b, out + b, stride, add_zigzag);
            break;
        case 1:
            for (std::size_t b = 0; b < 4; b += 2)
                accumulate<std::uint16_t>(deltas + b * count, count, previous + b, out + b, stride, add_zigzag);
            break;
        default:
            accumulate<std::uint32_t>(
                deltas, count, previous, out, stride,
                [rotation](std::uint32_t number, std::uint32_t delta) { return number ^ std::rotr(delta, rotation); });
    }
}

bool is_channel_mode(unsigned char mode) {
    return mode < 2 || (mode & 15) == 2;
}

/// The colour of one element, of components of `T`.
template <typename T>
void decode_color(unsigned char* element) {
    constexpr int kValues = 1 << std::numeric_limits<T>::digits;
    const auto with_sign = [](T bits) { return int{bits} < kValues / 2 ? int{bits} : int{bits} - kValues; };
    std::array<T, 4> in;
    std::memcpy(in.data(), element, sizeof(in));
    const int y = in[0];
    const int orange = with_sign(in[1]);
    const int green = with_sign(in[2]);
    // The highest bit of alpha says how many bits the others have.
    const unsigned most = (1u << std::bit_width(unsigned{in[3]})) - 1;
    unsigned alpha = in[3] & (most >> 1);
    alpha = (alpha << 1) | (alpha & 1u);
    const float largest = std::numeric_limits<T>::max();
    const float scale = most > 0 ? largest / static_cast<float>(most) : 0.0f;
    const auto store = [scale, largest](int value) {
        return static_cast<T>(std::lround(std::clamp(static_cast<float>(value) * scale, 0.0f, largest)));
    };
    const std::array<T, 4> out{store(y + orange - green), store(y + green), store(y - orange - green),
                               store(static_cast<int>(alpha))};
    std::memcpy(element, out.data(), sizeof(out));
}

}  // namespace

bool is_meshopt_attributes_v1(std::span<const unsigned char> bytes) {
    return !bytes.empty() && bytes.front() == kVersion1;
}

std::vector<unsigned char> decode_meshopt_attributes_v1(std::span<const unsigned char> bytes, std::size_t count,
                                                        std::size_t stride) {
    constexpr std::size_t kLeastTail = 24;
    const std::size_t channels = stride / 4;
    const std::size_t tail = std::max(kLeastTail, stride + channels);
    if (!is_meshopt_attributes_v1(bytes) || bytes.size() < 1 + tail) refuse();
    const Bytes modes = bytes.last(channels);
    if (!std::ranges::all_of(modes, is_channel_mode)) refuse();
    const Bytes baseline = bytes.last(stride + channels).first(stride);
    std::vector<unsigned char> previous(baseline.begin(), baseline.end());

    ByteReader in(bytes.subspan(1, bytes.size() - 1 - tail));
    std::vector<unsigned char> result(count * stride);
    std::vector<unsigned char> deltas(stride * kMostInBlock);
    const std::size_t block = std::min(8192 / stride / kGroup * kGroup, kMostInBlock);
    for (std::size_t first = 0; first < count; first += block) {
        const std::size_t n = std::min(block, count - first);
        const Bytes controls = in.take(channels);
        for (std::size_t k = 0; k < stride; ++k)
            read_deltas(in, two_bits(controls, k), std::span(deltas).subspan(k * n, n));
        for (std::size_t c = 0; c < channels; ++c)
            decode_channel(modes[c], deltas.data() + 4 * c * n, n, previous.data() + 4 * c,
                           result.data() + first * stride + 4 * c, stride);
    }
    if (!in.empty()) refuse();
    return result;
}

void decode_meshopt_colors(std::span<unsigned char> colors, std::size_t stride) {
    for (std::size_t i = 0; i + stride <= colors.size(); i += stride) {
        if (stride == 4)
            decode_color<std::uint8_t>(&colors[i]);
        else
            decode_color<std::uint16_t>(&colors[i]);
    }
}

}  // namespace etendue
