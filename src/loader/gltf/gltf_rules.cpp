#include "loader/gltf/gltf_rules.h"

#include "loader/gltf/repair_log.h"
#include "loader/json_text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;

/// A place in the document: its pointer is put together only where something is wrong, as keys may be long.
struct JsonPlace {
    const JsonPlace* parent;  ///< none of the document itself
    const std::string* key;   ///< none of an element of an array
    std::size_t index;
};

std::string pointer_of(const JsonPlace& place) {
    if (place.parent == nullptr) return {};
    const std::string parent = pointer_of(*place.parent);
    return place.key != nullptr ? child_pointer(parent, *place.key) : child_pointer(parent, place.index);
}

class RuleCheck {
  public:
    RuleCheck(const Json& document, const SourceLocation& file, ProblemList& problems)
        : document_(document), file_(file), problems_(problems) {}

    void run() {
        for (const Json& used : list("extensionsUsed")) used_.insert(used.get<std::string>());
        check_tree(document_, {nullptr, nullptr, 0});
        for (const Json& required : list("extensionsRequired"))
            if (!used_.contains(required.get<std::string>()))
                repairs_.add(Repair::RequiredNotUsed, 1, at("/extensionsRequired"));
        for_each("nodes", [this](const Json& node, const std::string& pointer) { check_node(node, pointer); });
        for_each("meshes", [this](const Json& mesh, const std::string& pointer) { check_mesh(mesh, pointer); });
        for_each("cameras", [this](const Json& camera, const std::string& pointer) { check_camera(camera, pointer); });
        for_each("accessors", [this](const Json& accessor, const std::string& pointer) {
            const std::uint64_t size = bytes_of_component(accessor["componentType"].get<int>());
            const std::uint64_t offset = offset_of(accessor);
            if (offset % size != 0 || (view_offset_of(accessor) + offset) % size != 0)
                repairs_.add(Repair::Unaligned, 1, at(pointer));
        });
        for_each("images", [this](const Json& image, const std::string& pointer) {
            if (image.contains("bufferView") && !image.contains("mimeType"))
                repairs_.add(Repair::NoMimeType, 1, at(pointer));
        });
        for_each("animations",
                 [this](const Json& animation, const std::string& pointer) { check_animation(animation, pointer); });
        for_each("skins", [this](const Json& skin, const std::string& pointer) {
            std::set<std::uint64_t> joints;
            for (const Json& joint : skin["joints"])
                if (!joints.insert(joint.get<std::uint64_t>()).second)
                    repairs_.add(Repair::RepeatedJoints, 1, at(pointer + "/joints"));
        });
        for_each("bufferViews", [this](const Json& view, const std::string& pointer) {
            if (!view.contains("byteStride")) return;
            const auto stride = view["byteStride"].get<std::uint64_t>();
            constexpr std::uint64_t kMostStride = 252;
            if (stride % 4 != 0 || stride > kMostStride)
                repairs_.add(Repair::OddStride, 1, at(pointer + "/byteStride"));
            if (stride == 0) repairs_.add(Repair::StrideOfZero, 1, at(pointer + "/byteStride"));
        });
        repairs_.report(problems_);
    }

  private:
    [[nodiscard]] SourceLocation at(std::string pointer) const { return {file_.file, std::move(pointer)}; }

    [[nodiscard]] const Json& list(const char* key) const {
        static const Json kNone = Json::array();
        return document_.contains(key) ? document_[key] : kNone;
    }
    template <typename Visit>
    void for_each(const char* key, const Visit& visit) const {
        const Json& elements = list(key);
        for (std::size_t i = 0; i < elements.size(); ++i) visit(elements[i], child_pointer(std::string("/") + key, i));
    }

    void repair(Repair kind, const JsonPlace& place) {
        repairs_.add(kind, 1, at(repairs_.has(kind) ? std::string() : pointer_of(place)));
    }

    /// Empty arrays, and extensions that are not declared, wherever they are. `extras` may hold what they like.
    void check_tree(const Json& part, const JsonPlace& place) {
        if (part.is_array()) {
            if (part.empty()) repair(Repair::EmptyArrays, place);
            for (std::size_t i = 0; i < part.size(); ++i)
                if (part[i].is_structured()) check_tree(part[i], {&place, nullptr, i});
        } else if (part.is_object()) {
            for (const auto& [key, value] : part.items()) {
                const JsonPlace child{&place, &key, 0};
                if (key == "extensions" && value.is_object())
                    check_declared(value, child);
                else if (key != "extras" && value.is_structured())
                    check_tree(value, child);
            }
        }
    }

    void check_declared(const Json& extensions, const JsonPlace& place) {
        for (const auto& [name, value] : extensions.items()) {
            const JsonPlace child{&place, &name, 0};
            if (!used_.contains(name)) repair(Repair::Undeclared, child);
            check_tree(value, child);
        }
    }

    static std::uint64_t bytes_of_component(int type) {
        switch (type) {
            case 5120:  // signed and unsigned bytes
            case 5121:
                return 1;
            case 5122:  // shorts
            case 5123:
                return 2;
            default:
                return 4;
        }
    }
    /// Bytes from the start of what holds it.
    static std::uint64_t offset_of(const Json& part) { return part.value("byteOffset", std::uint64_t{0}); }
    [[nodiscard]] std::uint64_t view_offset_of(const Json& accessor) const {
        return accessor.contains("bufferView")
                   ? offset_of(list("bufferViews")[accessor["bufferView"].get<std::size_t>()])
                   : 0;
    }

    /// Attributes of vertices must lie at multiples of 4 bytes.
    void check_attributes(const Json& attributes, const std::string& pointer) {
        for (const Json& index : attributes) {
            const Json& accessor = list("accessors")[index.get<std::size_t>()];
            if ((view_offset_of(accessor) + offset_of(accessor)) % 4 != 0)
                repairs_.add(Repair::Unaligned, 1, at(pointer));
        }
    }

    void check_animation(const Json& animation, const std::string& pointer) {
        std::set<std::string> targets;
        const Json& channels = animation["channels"];
        for (std::size_t i = 0; i < channels.size(); ++i) {
            const Json& target = channels[i]["target"];
            // Without a node or a pointer it is to be ignored.
            if (!target.contains("node") && !target.contains("extensions")) continue;
            if (!targets.insert(target.dump()).second)
                repairs_.add(Repair::RepeatedTargets, 1, at(child_pointer(pointer + "/channels", i)));
        }
    }

    /// How many morph targets the mesh's primitives have, at most.
    static std::size_t count_targets(const Json& mesh) {
        std::size_t most = 0;
        for (const Json& primitive : mesh["primitives"])
            if (primitive.contains("targets")) most = std::max(most, primitive["targets"].size());
        return most;
    }

    void check_node(const Json& node, const std::string& pointer) {
        const auto has = [&](const char* key) { return node.contains(key); };
        if (has("matrix") && (has("translation") || has("rotation") || has("scale")))
            repairs_.add(Repair::MatrixWithParts, 1, at(pointer + "/matrix"));
        if (has("rotation")) {
            constexpr double kTolerance = 1e-3;
            double squared = 0.0;
            for (const Json& q : node["rotation"]) squared += q.get<double>() * q.get<double>();
            if (!(std::abs(squared - 1.0) < kTolerance))
                repairs_.add(Repair::RotationNotUnit, 1, at(pointer + "/rotation"));
        }
        if (has("weights"))
            check_weights(node["weights"],
                          has("mesh") ? count_targets(list("meshes")[node["mesh"].get<std::size_t>()]) : 0,
                          pointer + "/weights");
    }

    void check_weights(const Json& weights, std::size_t targets, const std::string& pointer) {
        if (targets == 0)
            repairs_.add(Repair::WeightsOfNothing, 1, at(pointer));
        else if (weights.size() != targets)
            repairs_.add(Repair::TargetCounts, 1, at(pointer));
    }

    void check_mesh(const Json& mesh, const std::string& pointer) {
        const Json& primitives = mesh["primitives"];
        const std::size_t targets = count_targets(mesh);
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            const std::string place = child_pointer(pointer + "/primitives", i);
            const Json& attributes = primitives[i]["attributes"];
            check_attributes(attributes, place);
            if (targets > 0) {
                const bool has_all = primitives[i].contains("targets") && primitives[i]["targets"].size() == targets;
                if (!has_all) repairs_.add(Repair::TargetCounts, 1, at(place));
                if (primitives[i].contains("targets"))
                    for (const Json& target : primitives[i]["targets"]) check_attributes(target, place);
            }
            if (!attributes.contains("POSITION")) continue;
            const Json& accessor = list("accessors")[attributes["POSITION"].get<std::size_t>()];
            if (!accessor.contains("min") || !accessor.contains("max"))
                repairs_.add(Repair::NoPositionBounds, 1, at(place));
        }
        if (mesh.contains("weights")) check_weights(mesh["weights"], targets, pointer + "/weights");
    }

    void check_camera(const Json& camera, const std::string& pointer) {
        const std::string& type = camera["type"].get_ref<const std::string&>();
        if (!camera.contains(type)) {
            problems_.error(at(pointer), fmt::format("the camera is {}, but has no '{}'", type, type));
            return;
        }
        const Json& lens = camera[type];
        if (lens.contains("zfar") && lens["zfar"].get<double>() <= lens["znear"].get<double>())
            repairs_.add(Repair::ClipPlanes, 1, at(pointer + "/" + type));
    }

    const Json& document_;
    SourceLocation file_;
    ProblemList& problems_;
    RepairLog repairs_;
    std::unordered_set<std::string> used_;  ///< extensions that the document declares
};

}  // namespace

void check_rules(const Json& document, const SourceLocation& file, ProblemList& problems) {
    RuleCheck(document, file, problems).run();
}

}  // namespace etendue
