#include "loader/gltf/draco_decoder.h"

#include "core/error.h"

#include <exception>
#include <new>
#include <string>
#include <type_traits>

#include <draco/compression/config/compression_shared.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

namespace etendue {

namespace {

/// Holds the counts at the head of Draco's edgebreaker connectivity.
struct EdgebreakerCounts {
    std::uint32_t vertices = 0, faces = 0;
    std::uint8_t attributes = 0;  ///< that have a connectivity of their own
    std::uint32_t splits = 0;     ///< vertices that are taken apart
};

/// Reads the counts at the head of `buffer`, a copy. Counts that are not there stay 0: the decoder refuses them.
EdgebreakerCounts read_counts(draco::DecoderBuffer buffer) {
    const std::uint16_t version = buffer.bitstream_version();
    const auto read = [&](std::uint32_t& count) {
        return version < DRACO_BITSTREAM_VERSION(2, 0) ? buffer.Decode(&count) : draco::DecodeVarint(&count, &buffer);
    };
    EdgebreakerCounts counts;
    std::uint32_t new_vertices = 0, symbols = 0;
    if (version < DRACO_BITSTREAM_VERSION(2, 2) && !read(new_vertices)) return {};
    const bool are_read = read(counts.vertices) && read(counts.faces) && buffer.Decode(&counts.attributes) &&
                          read(symbols) && read(counts.splits);
    return are_read ? counts : EdgebreakerCounts{};
}

/// Returns the bytes that Draco takes for connectivity: tables of corners, and one more for each attribute.
std::uint64_t bytes_of_connectivity(const EdgebreakerCounts& counts) {
    constexpr std::uint64_t kOfFace = 44, kOfFaceAndAttribute = 16, kOfVertex = 16, kOfVertexAndAttribute = 8;
    return counts.faces * (kOfFace + kOfFaceAndAttribute * counts.attributes) +
           (std::uint64_t{counts.vertices} + counts.splits) * (kOfVertex + kOfVertexAndAttribute * counts.attributes);
}

/// Returns the bytes that Draco takes for the values of all attributes of `mesh`: as decoded and as integers, with the
/// place of each point's.
std::uint64_t bytes_of_attributes(const draco::PointCloud& mesh) {
    std::uint64_t of_point = 0;
    for (std::int32_t i = 0; i < mesh.num_attributes(); ++i) {
        const draco::PointAttribute& attribute = *mesh.attribute(i);
        const auto components = static_cast<std::uint64_t>(attribute.num_components());
        const auto of_component = static_cast<std::uint64_t>(draco::DataTypeLength(attribute.data_type()));
        of_point += components * (of_component + sizeof(std::int32_t)) + 2 * sizeof(std::uint32_t);
    }
    return of_point * mesh.num_points();
}

/// Decodes like `Base`, and asks before it takes memory.
template <typename Base>
class AskingDecoder final : public Base {
  public:
    explicit AskingDecoder(const MayTake& may_take) : may_take_(may_take) {}

    [[nodiscard]] bool was_denied() const { return was_denied_; }

  protected:
    bool DecodeConnectivity() override {
        // Lists of corners have at least a byte for each, which the decoder checks.
        if constexpr (std::is_same_v<Base, draco::MeshEdgebreakerDecoder>)
            if (!ask(bytes_of_connectivity(read_counts(*this->buffer())))) return false;
        return Base::DecodeConnectivity();
    }
    bool DecodeAllAttributes() override {
        return ask(bytes_of_attributes(*this->point_cloud())) && Base::DecodeAllAttributes();
    }

  private:
    bool ask(std::uint64_t bytes) {
        was_denied_ = !may_take_(bytes);
        return !was_denied_;
    }

    const MayTake& may_take_;
    bool was_denied_ = false;
};

template <typename Base>
std::unique_ptr<draco::Mesh> decode_with(draco::DecoderBuffer& buffer, const MayTake& may_take) {
    AskingDecoder<Base> decoder(may_take);
    auto mesh = std::make_unique<draco::Mesh>();
    const draco::Status status = decoder.Decode(draco::DecoderOptions(), &buffer, mesh.get());
    if (decoder.was_denied()) return nullptr;
    if (!status.ok()) throw IoError(status.error_msg_string());
    return mesh;
}

std::unique_ptr<draco::Mesh> decode_by_method(draco::DecoderBuffer& buffer, const MayTake& may_take) {
    draco::DecoderBuffer head(buffer);
    draco::DracoHeader header;
    const draco::Status status = draco::PointCloudDecoder::DecodeHeader(&head, &header);
    if (!status.ok()) throw IoError(status.error_msg_string());
    if (header.encoder_type != draco::TRIANGULAR_MESH) throw IoError("it is no mesh");
    switch (header.encoder_method) {
        case draco::MESH_SEQUENTIAL_ENCODING:
            return decode_with<draco::MeshSequentialDecoder>(buffer, may_take);
        case draco::MESH_EDGEBREAKER_ENCODING:
            return decode_with<draco::MeshEdgebreakerDecoder>(buffer, may_take);
        default:
            throw IoError("its encoding method is unknown");
    }
}

}  // namespace

std::unique_ptr<draco::Mesh> decode_draco_mesh(std::span<const unsigned char> bytes, const MayTake& may_take) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    try {
        return decode_by_method(buffer, may_take);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const IoError&) {
        throw;
    } catch (const std::exception& exception) {
        throw IoError(exception.what());
    }
}

}  // namespace etendue
