#include "loader/gltf/gltf_meshopt.h"

#include "loader/gltf/meshopt_attributes.h"
#include "loader/json_text.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;

/// The name of the extension that compresses a view; null if none does.
const char* compression_of(const Json& view) {
    if (!view.contains("extensions")) return nullptr;
    for (const char* name : {"KHR_meshopt_compression", "EXT_meshopt_compression"})
        if (view["extensions"].contains(name)) return name;
    return nullptr;
}

/// Marks in `named` the buffer views that something in `place` names.
void mark_named_views(const Json& place, std::vector<bool>& named) {
    const auto view = place.find("bufferView");
    if (view != place.end() && view->is_number_unsigned() && view->get<std::size_t>() < named.size())
        named[view->get<std::size_t>()] = true;
    for (const Json& part : place)
        if (part.is_structured()) mark_named_views(part, named);
}

struct CompressedView {
    std::span<const unsigned char> bytes;
    std::string mode;
    std::string filter;
    std::uint64_t count;
    std::uint64_t stride;

    [[nodiscard]] std::uint64_t decoded_size() const { return count * stride; }
};

/// Returns what the codecs would refuse in the numbers of `view`, as a message; an empty text if all numbers are right.
std::string find_fault(const CompressedView& view) {
    if (view.count == 0) return "there are no elements";
    if (view.mode == "ATTRIBUTES") {
        if (view.stride % 4 != 0 || view.stride == 0 || view.stride > 256)
            return fmt::format("attributes have a stride that is a multiple of 4 up to 256, not {}", view.stride);
    } else if (view.stride != 2 && view.stride != 4) {
        return fmt::format("indices have a stride of 2 or 4, not {}", view.stride);
    }
    if (view.mode == "TRIANGLES" && view.count % 3 != 0)
        return fmt::format("{} indices make no whole triangles", view.count);
    if (view.filter != "NONE" && view.mode != "ATTRIBUTES") return "only attributes have filters";
    if (view.filter == "OCTAHEDRAL" && view.stride != 4 && view.stride != 8)
        return fmt::format("the octahedral filter needs a stride of 4 or 8, not {}", view.stride);
    if (view.filter == "COLOR" && view.stride != 4 && view.stride != 8)
        return fmt::format("the colour filter needs a stride of 4 or 8, not {}", view.stride);
    if (view.filter == "QUATERNION" && view.stride != 8)
        return fmt::format("the quaternion filter needs a stride of 8, not {}", view.stride);
    // The densest codes are two bits for 16 bytes of a vertex, or in version 1 for 256 of them, and a byte for a
    // triangle, so a file that claims more lies, and must not get the memory first.
    const std::uint64_t densest = is_meshopt_attributes_v1(view.bytes) ? 1024 : 64;
    if (view.decoded_size() > densest * (view.bytes.size() + 64))
        return fmt::format("{} elements of {} bytes cannot come out of {} bytes", view.count, view.stride,
                           view.bytes.size());
    return {};
}

void apply_filter(const CompressedView& view, std::vector<unsigned char>& decoded) {
    if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(decoded.data(), view.count, view.stride);
    if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(decoded.data(), view.count, view.stride);
    if (view.filter == "COLOR") decode_meshopt_colors(decoded, view.stride);
    if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(decoded.data(), view.count, view.stride);
}

/// Throws IoError if the codec refuses the bytes.
std::vector<unsigned char> decode_codec(const CompressedView& view) {
    if (view.mode == "ATTRIBUTES" && is_meshopt_attributes_v1(view.bytes))
        return decode_meshopt_attributes_v1(view.bytes, view.count, view.stride);
    std::vector<unsigned char> decoded(view.decoded_size());
    const auto* bytes = view.bytes.data();
    const std::size_t size = view.bytes.size();
    const int failure =
        view.mode == "ATTRIBUTES"  ? meshopt_decodeVertexBuffer(decoded.data(), view.count, view.stride, bytes, size)
        : view.mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(decoded.data(), view.count, view.stride, bytes, size)
                                   : meshopt_decodeIndexSequence(decoded.data(), view.count, view.stride, bytes, size);
    if (failure != 0) throw IoError("the compressed bytes are damaged");
    return decoded;
}

std::vector<unsigned char> decode(const CompressedView& view) {
    std::vector<unsigned char> decoded = decode_codec(view);
    apply_filter(view, decoded);
    return decoded;
}

/// The compressed bytes and how to read them. Throws IoError.
CompressedView find_view(const Json& extension, const GltfBuffers& buffers, const AbsentBuffers& absent) {
    const auto buffer = extension["buffer"].get<std::size_t>();
    if (const auto reason = absent.find(buffer); reason != absent.end())
        throw IoError(fmt::format("buffer {} is not there: {}", buffer, reason->second));
    const std::vector<unsigned char>& data = buffers.at(buffer_name(buffer));
    const auto offset = extension.value("byteOffset", std::uint64_t{0});
    const auto length = extension["byteLength"].get<std::uint64_t>();
    if (offset > data.size() || length > data.size() - offset) {
        throw IoError(fmt::format("it covers {} bytes from {}, but the buffer has {}", length, offset, data.size()));
    }
    return {std::span(data).subspan(offset, length), extension["mode"].get<std::string>(),
            extension.value("filter", "NONE"), extension["count"].get<std::uint64_t>(),
            extension["byteStride"].get<std::uint64_t>()};
}

}  // namespace

void expand_meshopt_views(Json& document, GltfBuffers& buffers, const AbsentBuffers& absent, DecodeBudget& budget,
                          const SourceLocation& file, ProblemList& problems) {
    if (!document.contains("bufferViews")) return;
    Json& views = document["bufferViews"];
    if (std::ranges::none_of(views, [](const Json& view) { return compression_of(view) != nullptr; })) return;
    std::vector<bool> named(views.size());
    mark_named_views(document, named);
    for (std::size_t i = 0; i < views.size(); ++i) {
        Json& view = views[i];
        const char* const extension = compression_of(view);
        if (extension == nullptr || !named[i]) continue;
        const SourceLocation where{file.file,
                                   child_pointer(child_pointer("/bufferViews", i), "extensions") + "/" + extension};
        try {
            const CompressedView compressed = find_view(view["extensions"][extension], buffers, absent);
            const std::string fault = find_fault(compressed);
            if (!fault.empty()) throw IoError(fault);
            if (!budget.take(compressed.decoded_size())) {
                // The file is refused; whatever else would take too much is no news.
                problems.error(where, DecodeBudget::kExceeded);
                return;
            }
            std::vector<unsigned char> decoded = decode(compressed);

            const std::size_t index = document["buffers"].size();
            document["buffers"].push_back({{"uri", buffer_name(index)}, {"byteLength", decoded.size()}});
            view["buffer"] = index;
            view["byteOffset"] = 0;
            view["byteLength"] = decoded.size();
            if (compressed.mode == "ATTRIBUTES")
                view["byteStride"] = compressed.stride;
            else
                view.erase("byteStride");
            view.erase("extensions");
            buffers.emplace(buffer_name(index), std::move(decoded));
        } catch (const IoError& error) {
            problems.error(where, error.what());
        }
    }
}

}  // namespace etendue
