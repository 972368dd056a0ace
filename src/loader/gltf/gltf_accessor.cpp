#include "loader/gltf/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// An accessor without a buffer view is all zeros, whatever its count: nothing else bounds it.
constexpr std::size_t kMaxZeros = std::size_t{1} << 24;

std::size_t component_size(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        default:
            return 4;
    }
}

/// A number as it is, or as a fraction of its type's largest (3.11 of the specification: -128 counts as -127).
template <typename In, typename Out, bool Normalized>
Out convert(const unsigned char* bytes) {
    In value;
    std::memcpy(&value, bytes, sizeof(value));
    if constexpr (Normalized) {
        return std::max(Out{-1}, static_cast<Out>(value) / static_cast<Out>(std::numeric_limits<In>::max()));
    } else {
        return static_cast<Out>(value);
    }
}

/// Copies `components` numbers of type `In` from `bytes`.
template <typename In, typename Out, bool Normalized>
void convert_element(const unsigned char* bytes, std::size_t components, Out* out) {
    for (std::size_t c = 0; c < components; ++c) out[c] = convert<In, Out, Normalized>(bytes + c * sizeof(In));
}

template <typename Out, bool Normalized>
auto integer_converter(int component_type) -> void (*)(const unsigned char*, std::size_t, Out*) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return convert_element<std::int8_t, Out, Normalized>;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return convert_element<std::uint8_t, Out, Normalized>;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return convert_element<std::int16_t, Out, Normalized>;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return convert_element<std::uint16_t, Out, Normalized>;
        default:
            return convert_element<std::uint32_t, Out, Normalized>;
    }
}

template <typename Out>
auto element_converter(int component_type, bool normalized) -> void (*)(const unsigned char*, std::size_t, Out*) {
    if (component_type == TINYGLTF_COMPONENT_TYPE_FLOAT) return convert_element<float, Out, false>;
    if constexpr (std::is_floating_point_v<Out>) {
        if (normalized) return integer_converter<Out, true>(component_type);
    }
    return integer_converter<Out, false>(component_type);
}

/// The set that an accessor's integers belong to; none for floats and 32 bits.
unsigned integer_types(const tinygltf::Accessor& a) {
    switch (a.componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return a.normalized ? kSignedFractions : kSigned;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return a.normalized ? kUnsignedFractions : kUnsigned;
        default:
            return kNoIntegers;
    }
}

std::size_t as_index(int index) {
    return static_cast<std::size_t>(index);
}

}  // namespace

int component_count(const tinygltf::Accessor& accessor) {
    switch (accessor.type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        case TINYGLTF_TYPE_MAT4:
            return 16;
        default:
            return 0;
    }
}

AccessorReader::AccessorReader(const GltfDocument& document, ProblemList& problems)
    : document_(document),
      problems_(problems),
      budget_(document.budget),
      work_(document.budget),
      is_quantized_(std::ranges::find(document.extensions_used, "KHR_mesh_quantization") !=
                    document.extensions_used.end()) {}

std::optional<std::span<const unsigned char>> AccessorReader::view(int buffer_view, const SourceLocation& where) {
    const tinygltf::Model& model = document_.model;
    const auto fail = [&](const std::string& message) {
        problems_.error(where, message);
        return std::nullopt;
    };
    if (buffer_view < 0 || as_index(buffer_view) >= model.bufferViews.size()) {
        return fail(fmt::format("buffer view {} does not exist", buffer_view));
    }
    const tinygltf::BufferView& view = model.bufferViews[as_index(buffer_view)];
    if (view.buffer < 0 || as_index(view.buffer) >= model.buffers.size()) {
        return fail(fmt::format("buffer {} does not exist", view.buffer));
    }
    if (const auto absent = document_.absent_buffers.find(as_index(view.buffer));
        absent != document_.absent_buffers.end()) {
        // One buffer may hold all that a file has.
        if (reported_buffers_.insert(absent->first).second)
            problems_.error(document_.at(fmt::format("/buffers/{}", absent->first)), absent->second);
        return std::nullopt;
    }
    const std::vector<unsigned char>& data = model.buffers[as_index(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
        return fail(fmt::format("buffer view {} covers {} bytes from {}, but buffer {} has {}", buffer_view,
                                view.byteLength, view.byteOffset, view.buffer, data.size()));
    }
    return std::span(data).subspan(view.byteOffset, view.byteLength);
}

std::optional<std::span<const unsigned char>> AccessorReader::copyable_view(int buffer_view,
                                                                            const SourceLocation& where) {
    const auto bytes = view(buffer_view, where);
    if (!bytes || !allocate(bytes->size(), 1, where)) return std::nullopt;
    return bytes;
}

std::optional<AccessorReader::Elements> AccessorReader::elements(int buffer_view, std::size_t offset, std::size_t count,
                                                                 std::size_t element_size,
                                                                 const SourceLocation& where) {
    const auto bytes = view(buffer_view, where);
    if (!bytes) return std::nullopt;
    const std::size_t view_stride = document_.model.bufferViews[as_index(buffer_view)].byteStride;
    const std::size_t stride = view_stride == 0 ? element_size : view_stride;
    if (stride == 0 || stride < element_size) {
        problems_.error(where, fmt::format("elements of {} bytes overlap: buffer view {} has a stride of {}",
                                           element_size, buffer_view, stride));
        return std::nullopt;
    }
    // Compared by division, so that no product overflows.
    const bool first_fits = offset <= bytes->size() && element_size <= bytes->size() - offset;
    if (!first_fits || count - 1 > (bytes->size() - offset - element_size) / stride) {
        problems_.error(where,
                        fmt::format("{} elements of {} bytes, {} apart, from byte {} do not fit into the {} bytes "
                                    "of buffer view {}",
                                    count, element_size, stride, offset, bytes->size(), buffer_view));
        return std::nullopt;
    }
    return Elements{bytes->data() + offset, count, stride};
}

std::optional<AccessorReader::Elements> AccessorReader::elements(const tinygltf::Accessor& accessor,
                                                                 std::size_t element_size,
                                                                 const SourceLocation& where) {
    if (accessor.bufferView >= 0) {
        return elements(accessor.bufferView, accessor.byteOffset, accessor.count, element_size, where);
    }
    if (accessor.count > kMaxZeros) {
        problems_.error(where, fmt::format("an accessor of {} elements without a buffer view; at most {} are accepted",
                                           accessor.count, kMaxZeros));
        return std::nullopt;
    }
    return Elements{nullptr, accessor.count, 0};
}

std::size_t AccessorReader::count(int accessor) const {
    const std::vector<tinygltf::Accessor>& accessors = document_.model.accessors;
    const auto index = static_cast<std::size_t>(accessor);
    return accessor >= 0 && index < accessors.size() ? accessors[index].count : 0;
}

bool AccessorReader::allocate(std::uint64_t count, std::uint64_t bytes, const SourceLocation& where) {
    // Counts are below 2^32 and sizes below 2^10 here, or `bytes` is 1.
    return has_room(count * bytes, where) && budget_.take(count * bytes);
}

bool AccessorReader::has_room(std::uint64_t bytes, const SourceLocation& where) {
    return budget_.holds(bytes) || refuse(DecodeBudget::kExceeded, where);
}

bool AccessorReader::allow_work(std::uint64_t steps, const SourceLocation& where) {
    constexpr std::uint64_t kStepsPerByte = 4;
    return work_.take(steps / kStepsPerByte) || refuse(DecodeBudget::kTooMuchWork, where);
}

bool AccessorReader::refuse(const char* message, const SourceLocation& where) {
    // The file is refused; whatever else would take too much is no news.
    if (!std::exchange(is_exhausted_, true)) problems_.error(where, message);
    return false;
}

void AccessorReader::forget() {
    budget_ = document_.budget;
}

template <typename Out>
std::optional<std::vector<Out>> AccessorReader::read(const tinygltf::Accessor& accessor, const SourceLocation& where) {
    if (accessor.count == 0) {
        problems_.error(where, "the accessor has no elements");
        return std::nullopt;
    }
    const std::size_t components = as_index(component_count(accessor));
    const std::size_t element_size = components * component_size(accessor.componentType);
    const std::optional<Elements> source = elements(accessor, element_size, where);
    if (!source || !allocate(source->count, components * sizeof(Out), where)) return std::nullopt;

    std::vector<Out> values(source->count * components);
    if (source->first != nullptr) {
        const auto convert_one = element_converter<Out>(accessor.componentType, accessor.normalized);
        for (std::size_t i = 0; i < source->count; ++i) {
            convert_one(source->first + i * source->stride, components, values.data() + i * components);
        }
    }
    const bool is_sparse = accessor.sparse.isSparse && accessor.sparse.count > 0;
    if (is_sparse && !read_sparse(accessor, values, where)) return std::nullopt;
    return values;
}

template <typename Out>
bool AccessorReader::read_sparse(const tinygltf::Accessor& accessor, std::vector<Out>& values,
                                 const SourceLocation& where) {
    const auto& sparse = accessor.sparse;
    const std::size_t components = as_index(component_count(accessor));
    const std::size_t count = as_index(sparse.count);
    if (count > accessor.count) {
        problems_.error(where, fmt::format("{} sparse values are more than the {} elements of the accessor", count,
                                           accessor.count));
        return false;
    }
    const std::optional<Elements> targets =
        elements(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), count,
                 component_size(sparse.indices.componentType), where);
    const std::optional<Elements> sources =
        elements(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count,
                 components * component_size(accessor.componentType), where);
    if (!targets || !sources) return false;

    const auto read_target = element_converter<std::uint32_t>(sparse.indices.componentType, false);
    const auto convert_one = element_converter<Out>(accessor.componentType, accessor.normalized);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t target = 0;
        read_target(targets->first + i * targets->stride, 1, &target);
        if (target >= accessor.count) {
            problems_.error(where, fmt::format("sparse index {} is {}, but the accessor has {} elements", i, target,
                                               accessor.count));
            return false;
        }
        convert_one(sources->first + i * sources->stride, components, values.data() + target * components);
    }
    return true;
}

bool AccessorReader::check_format(const tinygltf::Accessor& a, const AttributeFormat& format,
                                  const SourceLocation& where) {
    const int components = component_count(a);
    if (components < format.min_components || components > format.max_components) {
        problems_.error(
            where,
            fmt::format(
                "the accessor has {} components, but this attribute takes {}{}", components, format.min_components,
                format.max_components > format.min_components ? fmt::format(" to {}", format.max_components) : ""));
        return false;
    }
    const unsigned types = integer_types(a);
    if (a.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT || (types & format.integers) != 0) return true;
    const bool needs_extension = (types & format.quantized) != 0;
    if (needs_extension && is_quantized_) return true;
    problems_.error(where,
                    fmt::format("the accessor stores this attribute as component type {}{}, which {}", a.componentType,
                                a.normalized ? " (normalised)" : "",
                                needs_extension ? "needs KHR_mesh_quantization among the extensions that the file uses"
                                                : "it may not have"));
    return false;
}

std::optional<AttributeData> AccessorReader::attribute(int accessor, const AttributeFormat& format,
                                                       const SourceLocation& where) {
    if (accessor < 0 || as_index(accessor) >= document_.model.accessors.size()) {
        problems_.error(where, fmt::format("accessor {} does not exist", accessor));
        return std::nullopt;
    }
    tinygltf::Accessor a = document_.model.accessors[as_index(accessor)];
    if (!check_format(a, format, where)) return std::nullopt;
    a.normalized = a.normalized || format.as_fractions;
    std::optional<std::vector<float>> values = read<float>(a, where);
    if (!values) return std::nullopt;
    return AttributeData{std::move(*values), component_count(a)};
}

std::optional<std::vector<std::uint32_t>> AccessorReader::indices(int accessor, const SourceLocation& where) {
    if (accessor < 0 || as_index(accessor) >= document_.model.accessors.size()) {
        problems_.error(where, fmt::format("accessor {} does not exist", accessor));
        return std::nullopt;
    }
    const tinygltf::Accessor& a = document_.model.accessors[as_index(accessor)];
    const bool is_index_type = a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                               a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                               a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (a.type != TINYGLTF_TYPE_SCALAR || !is_index_type || a.normalized) {
        problems_.error(where,
                        fmt::format("accessor {} cannot be indices: they are unsigned scalar integers", accessor));
        return std::nullopt;
    }
    return read<std::uint32_t>(a, where);
}

}  // namespace etendue
