#include "loader/gltf/gltf_instancing.h"

#include "loader/gltf/gltf_value.h"

#include <string>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Reads the attributes and keeps watch over their common length.
class InstanceAttributes {
  public:
    InstanceAttributes(const tinygltf::Value& attributes, AccessorReader& accessors, const SourceLocation& where,
                       ProblemList& problems)
        : attributes_(attributes), accessors_(accessors), where_(where), problems_(problems) {}

    /// `components` numbers for each instance; empty if there is no such attribute.
    std::vector<float> read(const std::string& name, int components, IntegerTypes integers) {
        if (!attributes_.Has(name)) return {};
        const SourceLocation where{where_.file, fmt::format("{}/attributes/{}", where_.pointer, name)};
        std::optional<AttributeData> data =
            accessors_.attribute(integer_or(attributes_, name, -1), {components, components, integers}, where);
        if (!data) {
            failed_ = true;
            return {};
        }
        const std::size_t count = data->values.size() / static_cast<std::size_t>(components);
        if (count_ > 0 && count != count_) {
            problems_.error(where, fmt::format("{} values for {} instances", count, count_));
            failed_ = true;
            return {};
        }
        count_ = count;
        return std::move(data->values);
    }

    /// Takes the number of instances from an attribute that is not read, if all are such.
    void count_others() {
        if (count_ > 0 || failed_) return;
        for (const std::string& name : attributes_.Keys())
            count_ = std::max(count_, accessors_.count(integer_or(attributes_, name, -1)));
    }

    [[nodiscard]] bool failed() const { return failed_; }
    [[nodiscard]] std::size_t count() const { return count_; }

  private:
    const tinygltf::Value& attributes_;
    AccessorReader& accessors_;
    const SourceLocation& where_;
    ProblemList& problems_;
    std::size_t count_ = 0;
    bool failed_ = false;
};

}  // namespace

std::optional<std::vector<Mat4d>> read_instance_transforms(const tinygltf::Value& extension, AccessorReader& accessors,
                                                           const SourceLocation& where, ProblemList& problems) {
    InstanceAttributes attributes(extension.Get("attributes"), accessors, where, problems);
    const std::vector<float> translations = attributes.read("TRANSLATION", 3, kNoIntegers);
    const std::vector<float> rotations = attributes.read("ROTATION", 4, kSignedFractions);
    const std::vector<float> scales = attributes.read("SCALE", 3, kNoIntegers);
    attributes.count_others();
    if (attributes.failed() || !accessors.allocate(attributes.count(), sizeof(Mat4d), where)) return std::nullopt;

    std::vector<Mat4d> transforms(attributes.count());
    std::size_t zero_rotations = 0;
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        const auto number = [i](const std::vector<float>& values, std::size_t components, std::size_t c) {
            return static_cast<double>(values[i * components + c]);
        };
        Mat4d& m = transforms[i];
        if (!scales.empty()) m.setScale(Imath::V3d(number(scales, 3, 0), number(scales, 3, 1), number(scales, 3, 2)));
        if (!rotations.empty()) {
            const std::optional<Mat4d> rotation = rotation_matrix(
                {number(rotations, 4, 0), number(rotations, 4, 1), number(rotations, 4, 2), number(rotations, 4, 3)});
            if (!rotation) ++zero_rotations;
            m *= rotation.value_or(Mat4d());
        }
        if (!translations.empty())
            for (std::size_t axis = 0; axis < 3; ++axis) m[3][axis] = number(translations, 3, axis);
    }
    if (zero_rotations > 0)
        problems.warning(where, fmt::format("{} instances have a zero quaternion, which is ignored", zero_rotations));
    return transforms;
}

}  // namespace etendue
