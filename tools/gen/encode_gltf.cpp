// Compresses geometry as extensions of glTF hold it, with the codecs' own encoders: tools/gen/scenegen/encoder.py runs
// it for the rows that tests/regression renders.
//
// Usage: encode_gltf CODEC [ARGUMENT...] < INPUT > OUTPUT
//
//     draco ATTRIBUTE...              POSITION, NORMAL, TEXCOORD_0 or COLOR_0, numbered in this order. INPUT has one
//                                     after the other, each for every corner of every triangle; OUTPUT begins with the
//                                     number of vertices, in 32 bits
//     meshopt-attributes STRIDE       elements of STRIDE bytes, without a filter
//     meshopt-octahedral              normals of four floats each, into bytes
//     meshopt-quaternion              rotations of four floats each
//     meshopt-triangles               indices of 32 bits
//     meshopt-indices                 the same as a plain sequence

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

namespace {

using Bytes = std::vector<unsigned char>;
using Arguments = std::span<const std::string>;

void require(bool condition, const std::string& message) {
    if (!condition) throw std::runtime_error(message);
}

std::size_t number(Arguments arguments, std::size_t index) {
    require(index < arguments.size(), "an argument is missing");
    return std::stoul(arguments[index]);
}

template <typename T>
std::vector<T> values_of(const Bytes& input) {
    require(input.size() % sizeof(T) == 0, "the input has no whole numbers");
    std::vector<T> values(input.size() / sizeof(T));
    std::memcpy(values.data(), input.data(), input.size());
    return values;
}

struct DracoAttribute {
    draco::GeometryAttribute::Type type;
    draco::DataType data_type;
    std::int8_t components;
    int quantization_bits;  ///< 0: none

    [[nodiscard]] std::size_t size() const {
        return static_cast<std::size_t>(components) * static_cast<std::size_t>(draco::DataTypeLength(data_type));
    }
};

const std::map<std::string, DracoAttribute> kDracoAttributes{
    {"POSITION", {draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, 14}},
    {"NORMAL", {draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, 3, 10}},
    {"TEXCOORD_0", {draco::GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, 2, 12}},
    {"COLOR_0", {draco::GeometryAttribute::COLOR, draco::DT_UINT8, 4, 0}}};

Bytes encode_draco(const Bytes& input, Arguments names) {
    std::vector<DracoAttribute> attributes;
    std::size_t corner_size = 0;
    for (const std::string& name : names) {
        attributes.push_back(kDracoAttributes.at(name));
        corner_size += attributes.back().size();
    }
    require(corner_size > 0 && input.size() % (3 * corner_size) == 0, "the input has no whole triangles");
    const std::size_t triangles = input.size() / (3 * corner_size);

    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(triangles));
    draco::Encoder encoder;
    const unsigned char* corner = input.data();
    for (const DracoAttribute& attribute : attributes) {
        const int id = builder.AddAttribute(attribute.type, attribute.components, attribute.data_type);
        for (std::size_t t = 0; t < triangles; ++t, corner += 3 * attribute.size())
            builder.SetAttributeValuesForFace(id, draco::FaceIndex(static_cast<std::uint32_t>(t)), corner,
                                              corner + attribute.size(), corner + 2 * attribute.size());
        if (attribute.quantization_bits > 0)
            encoder.SetAttributeQuantization(attribute.type, attribute.quantization_bits);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    require(mesh != nullptr, "Draco makes no mesh of it");
    encoder.SetTrackEncodedProperties(true);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeMeshToBuffer(*mesh, &buffer);
    require(status.ok(), status.error_msg_string());

    const auto vertices = static_cast<std::uint32_t>(encoder.num_encoded_points());
    Bytes output(sizeof(vertices) + buffer.size());
    std::memcpy(output.data(), &vertices, sizeof(vertices));
    std::memcpy(output.data() + sizeof(vertices), buffer.data(), buffer.size());
    return output;
}

Bytes encode_attributes(const void* elements, std::size_t count, std::size_t stride) {
    Bytes output(meshopt_encodeVertexBufferBound(count, stride));
    output.resize(meshopt_encodeVertexBuffer(output.data(), output.size(), elements, count, stride));
    return output;
}

Bytes encode_plain_attributes(const Bytes& input, Arguments arguments) {
    const std::size_t stride = number(arguments, 0);
    require(stride > 0 && stride % 4 == 0 && input.size() % stride == 0, "the input has no whole elements");
    return encode_attributes(input.data(), input.size() / stride, stride);
}

Bytes encode_octahedral(const Bytes& input, Arguments) {
    constexpr std::size_t kStride = 4;
    const std::vector<float> values = values_of<float>(input);
    const std::size_t count = values.size() / 4;
    Bytes filtered(count * kStride);
    meshopt_encodeFilterOct(filtered.data(), count, kStride, 8, values.data());
    return encode_attributes(filtered.data(), count, kStride);
}

Bytes encode_quaternion(const Bytes& input, Arguments) {
    constexpr std::size_t kStride = 8;
    const std::vector<float> values = values_of<float>(input);
    const std::size_t count = values.size() / 4;
    Bytes filtered(count * kStride);
    meshopt_encodeFilterQuat(filtered.data(), count, kStride, 16, values.data());
    return encode_attributes(filtered.data(), count, kStride);
}

Bytes encode_triangles(const Bytes& input, Arguments) {
    const std::vector<std::uint32_t> indices = values_of<std::uint32_t>(input);
    // More than there are vertices does no harm: it bounds how many bytes an index takes.
    Bytes output(meshopt_encodeIndexBufferBound(indices.size(), UINT32_MAX));
    output.resize(meshopt_encodeIndexBuffer(output.data(), output.size(), indices.data(), indices.size()));
    return output;
}

Bytes encode_indices(const Bytes& input, Arguments) {
    const std::vector<std::uint32_t> indices = values_of<std::uint32_t>(input);
    Bytes output(meshopt_encodeIndexSequenceBound(indices.size(), UINT32_MAX));
    output.resize(meshopt_encodeIndexSequence(output.data(), output.size(), indices.data(), indices.size()));
    return output;
}

const std::map<std::string, Bytes (*)(const Bytes&, Arguments)> kCodecs{{"draco", encode_draco},
                                                                        {"meshopt-attributes", encode_plain_attributes},
                                                                        {"meshopt-octahedral", encode_octahedral},
                                                                        {"meshopt-quaternion", encode_quaternion},
                                                                        {"meshopt-triangles", encode_triangles},
                                                                        {"meshopt-indices", encode_indices}};

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const auto codec = arguments.empty() ? kCodecs.end() : kCodecs.find(arguments[0]);
    if (codec == kCodecs.end()) {
        std::cerr << "usage: encode_gltf CODEC [ARGUMENT...] < INPUT > OUTPUT\n";
        return 2;
    }
    // The versions that the extension knows; later libraries write newer ones of their own accord.
    meshopt_encodeVertexVersion(0);
    meshopt_encodeIndexVersion(1);
    try {
        const Bytes input{std::istreambuf_iterator<char>(std::cin), {}};
        const Bytes output = codec->second(input, Arguments(arguments).subspan(1));
        std::cout.write(reinterpret_cast<const char*>(output.data()), static_cast<std::streamsize>(output.size()));
        require(static_cast<bool>(std::cout.flush()), "cannot write");
    } catch (const std::exception& error) {
        std::cerr << "encode_gltf: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
