// Reading accessors: every offset, length and index is checked against the bytes that are there.
#pragma once

#include "loader/gltf/gltf_document.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

namespace etendue {

/// Sets of integer types, of 8 and 16 bits each, that an attribute may be stored as besides floats.
enum IntegerTypes : unsigned {
    kNoIntegers = 0,
    kUnsignedFractions = 1,  ///< normalised to [0, 1]
    kSignedFractions = 2,    ///< normalised to [-1, 1]
    kUnsigned = 4,           ///< as they are
    kSigned = 8,
    kAnyIntegers = 15
};

/// Describes the forms in which a vertex attribute may be stored (glTF 2.0 specification, 3.7.2.1).
struct AttributeFormat {
    int min_components;
    int max_components;
    IntegerTypes integers = kNoIntegers;
    IntegerTypes quantized = kNoIntegers;  ///< besides, where the file uses KHR_mesh_quantization
    bool as_fractions = false;             ///< integers count as normalised, whatever the accessor says
};

/// Components per element of an accessor; 0 for matrices other than 4 × 4, which nothing uses.
[[nodiscard]] int component_count(const tinygltf::Accessor& accessor);

/// An attribute as floats, `components` of them per vertex.
struct AttributeData {
    std::vector<float> values;
    int components = 0;
};

class AccessorReader {
  public:
    AccessorReader(const GltfDocument& document, ProblemList& problems);

    /// All values of a vertex attribute, sparse ones included, normalised integers scaled to fractions. Nothing, and an
    /// error at `where`, if the accessor is not of that format or reaches outside its buffer view.
    [[nodiscard]] std::optional<AttributeData> attribute(int accessor, const AttributeFormat& format,
                                                         const SourceLocation& where);

    /// All values of an index accessor; the same on errors.
    [[nodiscard]] std::optional<std::vector<std::uint32_t>> indices(int accessor, const SourceLocation& where);

    /// True if the attribute's accessor has the `format`; otherwise an error at `where`.
    [[nodiscard]] bool check_format(const tinygltf::Accessor& accessor, const AttributeFormat& format,
                                    const SourceLocation& where);

    /// Returns how many elements the accessor says that it has; 0 if there is no such accessor.
    [[nodiscard]] std::size_t count(int accessor) const;

    /// Takes memory for `count` elements of `bytes` each from what may still be decoded; false if that is too much,
    /// with an error at `where` if it is the first time.
    [[nodiscard]] bool allocate(std::uint64_t count, std::uint64_t bytes, const SourceLocation& where);
    /// True if `bytes` may still be decoded, as for a while only; false with an error like that of `allocate`.
    [[nodiscard]] bool has_room(std::uint64_t bytes, const SourceLocation& where);
    /// Takes about as many `steps` of arithmetic from what may be computed: 4 for each byte that a new reader may
    /// decode. False with an error like that of `allocate` if that is too much.
    [[nodiscard]] bool allow_work(std::uint64_t steps, const SourceLocation& where);
    /// Returns whether more was asked for than is allowed.
    [[nodiscard]] bool is_exhausted() const { return is_exhausted_; }
    /// Makes room again for all that was decoded and is gone; work stays done.
    void forget();

    /// The bytes of a buffer view, at most as many as may still be decoded; the same on errors.
    [[nodiscard]] std::optional<std::span<const unsigned char>> copyable_view(int buffer_view,
                                                                              const SourceLocation& where);

  private:
    /// Returns false, with the error `message` if it is the first one of its kind.
    bool refuse(const char* message, const SourceLocation& where);

    /// Evenly spaced elements inside a buffer view.
    struct Elements {
        const unsigned char* first = nullptr;
        std::size_t count = 0;
        std::size_t stride = 0;
    };

    [[nodiscard]] std::optional<std::span<const unsigned char>> view(int buffer_view, const SourceLocation& where);
    [[nodiscard]] std::optional<Elements> elements(int buffer_view, std::size_t offset, std::size_t count,
                                                   std::size_t element_size, const SourceLocation& where);
    [[nodiscard]] std::optional<Elements> elements(const tinygltf::Accessor& accessor, std::size_t element_size,
                                                   const SourceLocation& where);
    template <typename Out>
    [[nodiscard]] std::optional<std::vector<Out>> read(const tinygltf::Accessor& accessor, const SourceLocation& where);
    template <typename Out>
    [[nodiscard]] bool read_sparse(const tinygltf::Accessor& accessor, std::vector<Out>& values,
                                   const SourceLocation& where);

    const GltfDocument& document_;
    ProblemList& problems_;
    DecodeBudget budget_;
    DecodeBudget work_;
    bool is_exhausted_ = false;               ///< more was asked for than is allowed, and that was reported
    std::set<std::size_t> reported_buffers_;  ///< absent buffers that were reported
    bool is_quantized_;                       ///< the file uses KHR_mesh_quantization
};

}  // namespace etendue
