#include "render/checkpoint.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/write_file.h"
#include "render/tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are written as numbers lie in memory");
static_assert(sizeof(PixelSum) == 48 && sizeof(SplatSum) == 24 && sizeof(DeepBin) == 64,
              "sums have no padding, and old files hold them so");

constexpr std::array<char, 8> kMagic{'E', 'T', 'D', 'C', 'K', 'P', 'T', '6'};

/// Writes and hashes.
class Writer {
  public:
    explicit Writer(const ByteSink& sink) : sink_(sink) {}

    template <typename T>
    void put(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        hash_.add(std::as_bytes(values));
        sink_(std::as_bytes(values));
    }
    template <typename T>
    void put(const T& value) {
        put(std::span(&value, 1));
    }
    void put(const std::string& text) {
        put(std::uint64_t{text.size()});
        put(std::span<const char>(text));
    }
    void finish() {
        const ContentHash::Digest digest = hash_.digest();
        sink_(digest);
    }

  private:
    const ByteSink& sink_;
    ContentHash hash_;
};

/// Reads no further than the file is long.
class Reader {
  public:
    Reader(const std::filesystem::path& path, std::uint64_t size)
        : path_(path), file_(path, std::ios::binary), left_(size) {}

    template <typename T>
    void get(std::span<T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (values.size_bytes() > left_) fail();
        file_.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size_bytes()));
        if (!file_) fail();
        left_ -= values.size_bytes();
    }
    template <typename T>
    [[nodiscard]] T get() {
        T value;
        get(std::span(&value, 1));
        return value;
    }
    /// `count` of them, which the file must have room for.
    template <typename T>
    [[nodiscard]] std::vector<T> get_many(std::uint64_t count) {
        if (count > left_ / sizeof(T)) fail();
        std::vector<T> values(static_cast<std::size_t>(count));
        get(std::span(values));
        return values;
    }
    [[nodiscard]] std::string get_text() {
        const std::vector<char> text = get_many<char>(get<std::uint64_t>());
        return {text.begin(), text.end()};
    }
    [[nodiscard]] std::uint64_t left() const { return left_; }
    [[noreturn]] void fail() const {
        throw DamagedCheckpoint(fmt::format("{} is damaged, or no checkpoint of this program", path_.string()));
    }

  private:
    const std::filesystem::path& path_;
    std::ifstream file_;
    std::uint64_t left_;
};

void put_counters(Writer& out, const RenderCounters& counters) {
    out.put(std::span<const std::uint64_t>(counters.rays.counts));
    out.put(counters.samples);
    out.put(counters.dropped);
    out.put(std::uint64_t{counters.first_dropped.size()});
    out.put(std::span<const DroppedSample>(counters.first_dropped));
    out.put(std::uint64_t{counters.brightest.capacity()});
    out.put(std::uint64_t{counters.brightest.samples().size()});
    out.put(counters.brightest.samples());
}

RenderCounters get_counters(Reader& in) {
    RenderCounters counters;
    in.get(std::span<std::uint64_t>(counters.rays.counts));
    counters.samples = in.get<std::uint64_t>();
    counters.dropped = in.get<std::uint64_t>();
    counters.first_dropped = in.get_many<DroppedSample>(in.get<std::uint64_t>());
    const auto capacity = in.get<std::uint64_t>();
    std::vector<BrightSample> brightest = in.get_many<BrightSample>(in.get<std::uint64_t>());
    // Words are texts that end; numbers that nobody else has read are not believed in either.
    if (capacity > BrightestSamples::kMost || brightest.size() > capacity) in.fail();
    for (const BrightSample& sample : brightest)
        if (sample.word.back() != '\0') in.fail();
    counters.brightest.restore(static_cast<std::size_t>(capacity), std::move(brightest));
    return counters;
}

void put_adaptive(Writer& out, const AdaptiveState& adaptive) {
    out.put(adaptive.passes);
    out.put(std::uint64_t{adaptive.samples.size()});
    out.put(std::span<const std::uint32_t>(adaptive.samples));
    out.put(std::uint64_t{adaptive.is_active.size()});
    out.put(std::span<const std::uint8_t>(adaptive.is_active));
}

AdaptiveState get_adaptive(Reader& in) {
    AdaptiveState adaptive;
    adaptive.passes = in.get<std::uint32_t>();
    adaptive.samples = in.get_many<std::uint32_t>(in.get<std::uint64_t>());
    adaptive.is_active = in.get_many<std::uint8_t>(in.get<std::uint64_t>());
    return adaptive;
}

void put_layers(Writer& out, const LayerBuffer& layers) {
    const LayerLayout& layout = layers.layout();
    for (const std::size_t count : {layout.light, layout.values, layout.nearest}) out.put(std::uint64_t{count});
    out.put(std::uint64_t{layout.has_moments});
    out.put(std::uint64_t{layout.has_ray_counts});
    for (const std::size_t count : {layout.mattes, layout.matte_slots, std::size_t{layout.is_deep}})
        out.put(std::uint64_t{count});
    out.put(layers.all_sums());
    out.put(layers.all_nearest());
    out.put(layers.mattes().all_ids());
    out.put(layers.mattes().all_weights());
    for (std::size_t p = 0; p < layers.deep().pixels(); ++p) {
        out.put(std::uint64_t{layers.deep().bins(p).size()});
        out.put(layers.deep().bins(p));
    }
}

void put_film(Writer& out, const Film& film) {
    const PixelRect& window = film.window();
    const PixelRect& around = film.splat_window();
    for (const int number : {film.full_width(), film.full_height(), window.x0, window.y0, window.x1, window.y1,
                             around.x0, around.y0, around.x1, around.y1})
        out.put(number);
    put_layers(out, film.layers());
    out.put(film.sums());
    const SplatFilm* splats = film.splats();
    out.put(std::uint64_t{splats != nullptr});
    if (splats == nullptr) return;
    out.put(static_cast<std::uint32_t>(splats->filter().shape()));
    out.put(splats->filter().radius());
    out.put(splats->light_paths());
    out.put(splats->sums());
}

PixelFilter get_filter(Reader& in) {
    constexpr float kLargestRadius = 1000.0f;
    const auto shape = in.get<std::uint32_t>();
    const auto radius = in.get<float>();
    if (shape > static_cast<std::uint32_t>(FilterShape::Mitchell) || !(radius > 0.0f && radius < kLargestRadius))
        in.fail();
    return PixelFilter(static_cast<FilterShape>(shape), radius);
}

/// A window with pixels, none of them farther beyond the image than that is large.
PixelRect get_window(Reader& in, int width, int height) {
    std::array<int, 4> edges;
    in.get(std::span<int>(edges));
    const PixelRect window{edges[0], edges[1], edges[2], edges[3]};
    if (window.empty() || intersection(window, {-width, -height, 2 * width, 2 * height}) != window) in.fail();
    return window;
}

LayerBuffer get_layers(Reader& in, std::size_t pixels) {
    constexpr std::uint64_t kMost = 4096;  // far more than can be asked for
    std::array<std::uint64_t, 8> counts;
    in.get(std::span<std::uint64_t>(counts));
    for (const std::uint64_t count : counts)
        if (count > kMost) in.fail();
    const LayerLayout layout{counts[0],      counts[1], counts[2], counts[3] != 0,
                             counts[4] != 0, counts[5], counts[6], counts[7] != 0};
    if (in.left() / sizeof(double) / std::max<std::size_t>(1, layout.sums()) < pixels ||
        in.left() / sizeof(float) / (layout.nearest + 1) < pixels ||
        (layout.is_deep && in.left() / sizeof(std::uint64_t) < pixels) ||
        in.left() / sizeof(double) / std::max<std::size_t>(1, layout.mattes * layout.matte_slots) < pixels)
        in.fail();
    LayerBuffer layers(layout, pixels);
    in.get(layers.all_sums());
    in.get(layers.all_nearest());
    in.get(layers.mattes().all_ids());
    in.get(layers.mattes().all_weights());
    for (std::size_t p = 0; p < layers.deep().pixels(); ++p) {
        const auto count = in.get<std::uint64_t>();
        if (count > 2 * DeepBuffer::kMostBins) in.fail();
        layers.deep().restore(p, in.get_many<DeepBin>(count));
    }
    return layers;
}

Film get_film(Reader& in) {
    const auto width = in.get<int>();
    const auto height = in.get<int>();
    constexpr int kMostSize = 1 << 24;  // far more than can be asked for
    if (width < 1 || width > kMostSize || height < 1 || height > kMostSize) in.fail();
    const PixelRect window = get_window(in, width, height);
    const PixelRect splat_window = get_window(in, width, height);
    LayerBuffer layers = get_layers(in, window.area());
    std::vector<PixelSum> sums = in.get_many<PixelSum>(window.area());
    std::optional<SplatFilm> splats;
    if (in.get<std::uint64_t>() != 0) {
        const PixelFilter filter = get_filter(in);
        const auto light_paths = in.get<std::uint64_t>();
        const LayerLayout& layout = layers.layout();
        const std::uint64_t images = 1 + layout.light + (layout.has_moments ? 1 : 0);
        if (in.left() / sizeof(SplatSum) / images < splat_window.area()) in.fail();
        splats.emplace(width, height, splat_window, filter, layout.light, layout.has_moments);
        std::vector<SplatSum> splat_sums = in.get_many<SplatSum>(splats->sums().size());
        splats->restore(std::move(splat_sums), light_paths);
    }
    Film film(width, height, window, splat_window, layers.layout());
    film.restore(std::move(sums), std::move(layers), std::move(splats));
    return film;
}

/// The size of the file without its hash, which must be right.
std::uint64_t checked_size(const std::filesystem::path& path) {
    require_regular_file(path);
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) throw IoError(fmt::format("cannot read {}", path.string()));
    const auto size = static_cast<std::uint64_t>(file.tellg());
    file.seekg(0);
    std::vector<char> buffer(std::size_t{1} << 20);
    ContentHash hash;
    std::uint64_t left = size > ContentHash::kSize ? size - ContentHash::kSize : 0;
    const std::uint64_t content = left;
    while (left > 0 && file) {
        const std::size_t part = std::min<std::uint64_t>(left, buffer.size());
        file.read(buffer.data(), static_cast<std::streamsize>(part));
        hash.add(std::as_bytes(std::span(buffer).first(part)));
        left -= part;
    }
    ContentHash::Digest kept{};
    file.read(reinterpret_cast<char*>(kept.data()), kept.size());
    if (file.bad()) throw IoError(fmt::format("cannot read {}", path.string()));
    if (!file || content == 0 || kept != hash.digest()) Reader(path, 0).fail();
    return content;
}

bool is_consistent(const AdaptiveState& adaptive, const RenderState& state) {
    const std::size_t pixels = state.film.window().area();
    if (adaptive.is_uniform()) return adaptive.passes == 0 && adaptive.is_active.empty();
    const auto [least, most] = std::ranges::minmax(adaptive.samples);
    return adaptive.samples.size() == pixels && least == state.spp_done &&
           std::uint64_t{state.first_sample} + most + state.pass_size <= std::numeric_limits<std::uint32_t>::max() &&
           (adaptive.is_active.empty() || (adaptive.is_active.size() == pixels && state.pass_size > 0)) &&
           std::ranges::all_of(adaptive.is_active, [](auto is_active) { return is_active <= 1; });
}

/// Returns false for states that no render leaves behind, so that nobody need expect them. Only the hash of a file is
/// known to be right, and whoever writes a file can make one: its numbers and windows may be any.
bool is_consistent(const RenderState& state) {
    constexpr std::uint64_t kMostSamples = std::numeric_limits<std::uint32_t>::max();
    const Film& film = state.film;
    if (std::uint64_t{state.first_sample} + state.spp_done + state.pass_size > kMostSamples) return false;
    if (intersection(film.window(), film.splat_window()) != film.window()) return false;
    const std::size_t tiles = state.pass_size > 0 ? make_tiles(film.window()).size() : 0;
    if (state.tiles_done.size() != tiles || std::ranges::any_of(state.tiles_done, [](auto done) { return done > 1; }))
        return false;
    if (!is_consistent(state.adaptive, state)) return false;
    const RenderCounters& counters = state.counters;
    if (counters.first_dropped.size() > counters.dropped || (counters.dropped > 0 && counters.first_dropped.empty()))
        return false;
    if (!state.every_other_pass) return state.every_other_spp == 0;
    const Film& other = *state.every_other_pass;
    return state.every_other_spp <= state.spp_done && other.full_width() == film.full_width() &&
           other.full_height() == film.full_height() && other.window() == film.window() &&
           other.splat_window() == film.splat_window() &&
           other.layers().layout().without_lists() == film.layers().layout().without_lists();
}

/// The last character of kMagic is the format. Before this is asked, the hash has told that the file is whole.
void require_format(Reader& in, const std::filesystem::path& path) {
    const auto magic = in.get<std::array<char, 8>>();
    if (!std::equal(kMagic.begin(), kMagic.end() - 1, magic.begin())) in.fail();
    if (magic != kMagic)
        throw RefusedCheckpoint(
            {path.string(), {}},
            fmt::format("was written by another version of this program: format {} there, {} here; render it anew",
                        magic.back(), kMagic.back()));
}

}  // namespace

std::string difference(const RenderIdentity& kept, const RenderIdentity& wanted, const std::string& kept_place,
                       const std::string& wanted_place) {
    std::string text;
    const auto value = [](const RenderIdentity& identity, const std::string& name) {
        const auto found = identity.find(name);
        return found != identity.end() ? "'" + found->second + "'" : std::string("missing");
    };
    RenderIdentity names = kept;
    names.insert(wanted.begin(), wanted.end());
    for (const auto& [name, ignored] : names)
        if (value(kept, name) != value(wanted, name))
            text += fmt::format("{}{}: {} {}, {} {}", text.empty() ? "" : "\n", name, value(kept, name), kept_place,
                                value(wanted, name), wanted_place);
    return text;
}

void write_checkpoint(const std::filesystem::path& path, const RenderIdentity& identity, const std::string& description,
                      const RenderState& state) {
    write_file(path, [&](const ByteSink& sink) {
        Writer out(sink);
        out.put(kMagic);
        out.put(std::uint64_t{identity.size()});
        for (const auto& [name, value] : identity) {
            out.put(name);
            out.put(value);
        }
        out.put(description);
        for (const std::uint32_t count : {state.first_sample, state.spp_done, state.every_other_spp, state.pass_size})
            out.put(count);
        out.put(std::uint64_t{state.tiles_done.size()});
        out.put(std::span<const std::uint8_t>(state.tiles_done));
        put_adaptive(out, state.adaptive);
        put_counters(out, state.counters);
        out.put(state.wall_seconds);
        out.put(state.cpu_seconds);
        put_film(out, state.film);
        out.put(std::uint64_t{state.every_other_pass.has_value()});
        if (state.every_other_pass) put_film(out, *state.every_other_pass);
        out.finish();
    });
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
    Reader in(path, checked_size(path));
    require_format(in, path);
    RenderIdentity identity;
    for (auto count = in.get<std::uint64_t>(); count > 0; --count) {
        std::string name = in.get_text();
        identity[std::move(name)] = in.get_text();
    }
    std::string description = in.get_text();
    std::array<std::uint32_t, 4> counts;
    in.get(std::span<std::uint32_t>(counts));
    const auto [first_sample, spp_done, every_other_spp, pass_size] = counts;
    std::vector<std::uint8_t> tiles_done = in.get_many<std::uint8_t>(in.get<std::uint64_t>());
    AdaptiveState adaptive = get_adaptive(in);
    RenderCounters counters = get_counters(in);
    const auto wall_seconds = in.get<double>();
    const auto cpu_seconds = in.get<double>();
    RenderState state{.film = get_film(in),
                      .first_sample = first_sample,
                      .spp_done = spp_done,
                      .pass_size = pass_size,
                      .tiles_done = std::move(tiles_done),
                      .counters = std::move(counters),
                      .wall_seconds = wall_seconds,
                      .cpu_seconds = cpu_seconds,
                      .every_other_spp = every_other_spp,
                      .adaptive = std::move(adaptive)};
    if (in.get<std::uint64_t>() != 0) state.every_other_pass = get_film(in);
    if (in.left() != 0 || !is_consistent(state)) in.fail();
    return {std::move(identity), std::move(description), std::move(state)};
}

}  // namespace etendue
