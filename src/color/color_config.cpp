#include "color/color_config.h"

#include "color/built_in_config.h"
#include "color/color_transform_impl.h"
#include "color/config_files.h"
#include "color/primaries.h"
#include "core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string_view>

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

namespace OCIO = OCIO_NAMESPACE;

namespace etendue {

struct ColorConfig::Impl {
    OCIO::ConstConfigRcPtr config;
    std::string origin;
    std::vector<std::filesystem::path> files;

    [[nodiscard]] OCIO::ConstColorSpaceRcPtr find_space(const std::string& name) const;
    [[nodiscard]] OCIO::ConstCPUProcessorRcPtr processor(const std::string& from, const std::string& to) const;
    [[nodiscard]] Matrix3d probe_matrix(const std::string& from, const std::string& to) const;
    void require_linear(const std::string& space) const;
    [[nodiscard]] std::string aces_space() const;
    [[nodiscard]] std::optional<Matrix3d> to_ap0(const std::string& space) const;
    void require_view(const std::string& display, const std::string& view, const std::vector<std::string>& known) const;
    void require_look(const std::string& look, const std::vector<std::string>& known) const;
    [[noreturn]] void fail(const std::string& message) const;
    [[noreturn]] void fail_unknown(std::string_view what, const std::string& name,
                                   const std::vector<std::string>& known) const;
    [[noreturn]] void fail_unknown_of_few(std::string_view what, const std::string& name,
                                          const std::vector<std::string>& known) const;
};

namespace {

constexpr std::string_view kBuiltIn = "built-in";

// Without OpenColorIO's fast approximations of log and pow, whose errors of 1e-5 show in 16-bit textures and whose
// results depend on the processor.
constexpr OCIO::OptimizationFlags kExact = OCIO::OPTIMIZATION_LOSSLESS;

std::vector<std::string> names_of_spaces(const OCIO::Config& config) {
    std::vector<std::string> names;
    names.reserve(static_cast<std::size_t>(config.getNumColorSpaces()));
    for (int i = 0; i < config.getNumColorSpaces(); ++i) names.emplace_back(config.getColorSpaceNameByIndex(i));
    return names;
}

// Spaces, their aliases and roles: everything that stands for a space.
std::vector<std::string> everything_that_names_a_space(const OCIO::Config& config) {
    std::vector<std::string> names = names_of_spaces(config);
    const std::size_t space_count = names.size();
    for (std::size_t i = 0; i < space_count; ++i) {
        const auto space = config.getColorSpace(names[i].c_str());
        for (std::size_t alias = 0; alias < space->getNumAliases(); ++alias) names.emplace_back(space->getAlias(alias));
    }
    for (int i = 0; i < config.getNumRoles(); ++i) names.emplace_back(config.getRoleName(i));
    return names;
}

// OpenColorIO's processors work in floats, so a matrix is found by sending black, the unit vectors and a few checks
// through them. Empty if the conversion is not linear.
std::optional<Matrix3d> matrix_of(const OCIO::CPUProcessor& processor) {
    const auto send = [&processor](float r, float g, float b) {
        std::array<float, 3> values{r, g, b};
        processor.applyRGB(values.data());
        return values;
    };
    const auto near = [](double a, double b, double scale) { return std::abs(a - b) <= 1e-4 * scale; };

    const auto black = send(0.0f, 0.0f, 0.0f);
    const std::array<std::array<float, 3>, 3> columns{send(1.0f, 0.0f, 0.0f), send(0.0f, 1.0f, 0.0f),
                                                      send(0.0f, 0.0f, 1.0f)};
    Matrix3d m{};
    for (std::size_t row = 0; row < 3; ++row) {
        if (!near(black[row], 0.0, 1.0)) return std::nullopt;
        for (std::size_t column = 0; column < 3; ++column) {
            m[3 * row + column] = static_cast<double>(columns[column][row]);
        }
    }
    constexpr std::array<std::array<double, 3>, 4> kChecks{
        {{0.18, 0.18, 0.18}, {0.5, 0.25, 0.0625}, {100.0, 20.0, 3.0}, {-0.5, 1.5, 0.01}}};
    for (const auto& check : kChecks) {
        const auto found =
            send(static_cast<float>(check[0]), static_cast<float>(check[1]), static_cast<float>(check[2]));
        const auto expected = m * check;
        const double scale = std::abs(check[0]) + std::abs(check[1]) + std::abs(check[2]);
        for (std::size_t row = 0; row < 3; ++row) {
            if (!near(found[row], expected[row], scale)) return std::nullopt;
        }
    }
    return m;
}

Matrix3d ap0_to_xyz_d65() {
    return bradford_adaptation(kAp0.white, kD65) * rgb_to_xyz(kAp0);
}

}  // namespace

void ColorConfig::Impl::fail(const std::string& message) const {
    throw SceneError(SourceLocation{}, fmt::format("{} (OpenColorIO config: {})", message, origin));
}

void ColorConfig::Impl::fail_unknown(std::string_view what, const std::string& name,
                                     const std::vector<std::string>& known) const {
    const std::vector<std::string_view> views(known.begin(), known.end());
    fail(fmt::format("there is no {} '{}'; {}", what, name, name_hint(name, views)));
}

// Displays, views and looks are few, so that all can be named beside the nearest.
void ColorConfig::Impl::fail_unknown_of_few(std::string_view what, const std::string& name,
                                            const std::vector<std::string>& known) const {
    const std::vector<std::string_view> views(known.begin(), known.end());
    const std::string nearest = nearest_name(name, views);
    const std::string all = known.empty() ? "there are none" : fmt::format("there are '{}'", fmt::join(known, "', '"));
    fail(fmt::format("there is no {} '{}'; {}{}", what, name,
                     nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest), all));
}

OCIO::ConstColorSpaceRcPtr ColorConfig::Impl::find_space(const std::string& name) const {
    auto space = config->getColorSpace(name.c_str());
    if (!space) fail_unknown("colour space", name, everything_that_names_a_space(*config));
    return space;
}

OCIO::ConstCPUProcessorRcPtr ColorConfig::Impl::processor(const std::string& from, const std::string& to) const {
    const auto source = find_space(from);
    const auto target = find_space(to);
    try {
        return config->getProcessor(source, target)->getOptimizedCPUProcessor(kExact);
    } catch (const OCIO::Exception& error) {
        fail(fmt::format("cannot convert from '{}' to '{}': {}", from, to, error.what()));
    }
}

Matrix3d ColorConfig::Impl::probe_matrix(const std::string& from, const std::string& to) const {
    const auto matrix = matrix_of(*processor(from, to));
    if (!matrix) fail(fmt::format("the conversion from '{}' to '{}' is not linear", from, to));
    return *matrix;
}

void ColorConfig::Impl::require_linear(const std::string& space) const {
    const bool data = find_space(space)->isData();
    if (data || !matrix_of(*processor(space, OCIO::ROLE_SCENE_LINEAR))) {
        fail(fmt::format("'{}' is no scene-linear colour space", space));
    }
}

// Configs without the role call ACES2065-1 by one of these names.
std::string ColorConfig::Impl::aces_space() const {
    for (const char* name : {OCIO::ROLE_INTERCHANGE_SCENE, "ACES2065-1", "ACES - ACES2065-1", "lin_ap0"}) {
        if (const auto space = config->getColorSpace(name)) return space->getName();
    }
    return {};
}

std::optional<Matrix3d> ColorConfig::Impl::to_ap0(const std::string& space) const {
    const std::string aces = aces_space();
    if (aces.empty()) return std::nullopt;
    return probe_matrix(space, aces);
}

void ColorConfig::Impl::require_view(const std::string& display, const std::string& view,
                                     const std::vector<std::string>& known) const {
    if (std::find(known.begin(), known.end(), view) == known.end())
        fail_unknown_of_few(fmt::format("view of display '{}' called", display), view, known);
}

// OpenColorIO's syntax: options with bars between them, each a list of looks with commas, each with a sign or none.
void ColorConfig::Impl::require_look(const std::string& look, const std::vector<std::string>& known) const {
    const auto is_known = [&](const std::string& name) {
        return std::find(known.begin(), known.end(), name) != known.end();
    };
    if (look.empty() || look == kNoLook || is_known(look)) return;
    std::size_t begin = 0;
    while (begin <= look.size()) {
        const std::size_t end = std::min(look.find_first_of(",|", begin), look.size());
        std::string name = look.substr(begin, end - begin);
        const std::size_t first = name.find_first_not_of(" +-");
        name = first == std::string::npos ? "" : name.substr(first, name.find_last_not_of(' ') - first + 1);
        if (!is_known(name)) fail_unknown_of_few("look", name, known);
        begin = end + 1;
    }
}

ColorConfig::ColorConfig(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

std::filesystem::path ColorConfig::environment_path() {
    const char* path = std::getenv("OCIO");
    return path ? path : "";
}

ColorConfig ColorConfig::from_environment() {
    const std::filesystem::path path = environment_path();
    return path.empty() ? built_in() : from_file(path);
}

std::vector<std::filesystem::path> ColorConfig::environment_files() {
    const std::filesystem::path path = environment_path();
    return path.empty() ? std::vector<std::filesystem::path>() : from_file(path).files();
}

ColorConfig ColorConfig::built_in() {
    auto impl = std::make_shared<Impl>();
    std::istringstream stream{std::string(built_in_config_text())};
    impl->config = OCIO::Config::CreateFromStream(stream);
    impl->origin = kBuiltIn;
    return ColorConfig(std::move(impl));
}

ColorConfig ColorConfig::from_file(const std::filesystem::path& path) {
    auto impl = std::make_shared<Impl>();
    impl->origin = path.string();
    const auto refuse = [&](const std::string& why) {
        throw SceneError(SourceLocation{path.string(), ""},
                         fmt::format("the OpenColorIO config cannot be read: {}", why));
    };
    // OpenColorIO has configs of its own, which are no files.
    const bool is_file = !impl->origin.starts_with("ocio://");
    if (is_file) {
        if (const std::string why = why_not_read(path); !why.empty()) refuse(why);
        impl->files.push_back(path);
    }
    try {
        impl->config = OCIO::Config::CreateFromFile(path.c_str());
        ConfigReferences references = find_references(*impl->config);
        if (!references.problem.empty()) refuse(references.problem);
        impl->files.insert(impl->files.end(), references.files.begin(), references.files.end());
    } catch (const OCIO::Exception& error) {
        refuse(error.what());
    }
    return ColorConfig(std::move(impl));
}

std::string ColorConfig::default_working_space() const {
    return resolve_space(OCIO::ROLE_SCENE_LINEAR);
}

std::vector<std::string> ColorConfig::spaces() const {
    return names_of_spaces(*impl_->config);
}

std::vector<std::string> ColorConfig::displays() const {
    std::vector<std::string> names;
    names.reserve(static_cast<std::size_t>(impl_->config->getNumDisplays()));
    for (int i = 0; i < impl_->config->getNumDisplays(); ++i) names.emplace_back(impl_->config->getDisplay(i));
    return names;
}

std::vector<std::string> ColorConfig::views(const std::string& display) const {
    std::vector<std::string> names;
    names.reserve(static_cast<std::size_t>(impl_->config->getNumViews(display.c_str())));
    for (int i = 0; i < impl_->config->getNumViews(display.c_str()); ++i) {
        names.emplace_back(impl_->config->getView(display.c_str(), i));
    }
    if (names.empty()) impl_->fail_unknown_of_few("display", display, displays());
    return names;
}

std::string ColorConfig::default_display() const {
    return impl_->config->getDefaultDisplay();
}

std::string ColorConfig::default_view(const std::string& display) const {
    if (views(display).empty()) return {};
    return impl_->config->getDefaultView(display.c_str());
}

const std::vector<std::filesystem::path>& ColorConfig::files() const {
    return impl_->files;
}

const std::string& ColorConfig::origin() const {
    return impl_->origin;
}

std::string ColorConfig::resolve_space(const std::string& name) const {
    return impl_->find_space(name)->getName();
}

ColorTransform ColorConfig::transform(const std::string& from, const std::string& to) const {
    ColorTransform result;
    result.impl_ = std::make_shared<ColorTransform::Impl>(ColorTransform::Impl{impl_->processor(from, to)});
    return result;
}

ColorMatrix ColorConfig::matrix(const std::string& from, const std::string& to) const {
    impl_->require_linear(from);
    impl_->require_linear(to);
    const Matrix3d probed = impl_->probe_matrix(from, to);
    ColorMatrix result;
    for (std::size_t i = 0; i < probed.size(); ++i) result.m[i] = static_cast<float>(probed[i]);
    return result;
}

std::vector<std::string> ColorConfig::looks() const {
    std::vector<std::string> names;
    names.reserve(static_cast<std::size_t>(impl_->config->getNumLooks()));
    for (int i = 0; i < impl_->config->getNumLooks(); ++i) names.emplace_back(impl_->config->getLookNameByIndex(i));
    return names;
}

std::string ColorConfig::looks_of_view(const std::string& display, const std::string& view) const {
    impl_->require_view(display, view, views(display));
    return impl_->config->getDisplayViewLooks(display.c_str(), view.c_str());
}

void ColorConfig::require_look(const std::string& look) const {
    impl_->require_look(look, looks());
}

std::string ColorConfig::aces_space() const {
    return impl_->aces_space();
}

ColorTransform ColorConfig::display_transform(const std::string& working, const std::string& display,
                                              const std::string& view, float exposure, const std::string& look) const {
    const std::string source = resolve_space(working);
    impl_->require_view(display, view, views(display));
    require_look(look);
    const auto gain = OCIO::MatrixTransform::Create();
    const double scale = std::exp2(static_cast<double>(exposure));
    const std::array<double, 16> matrix{scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, 1};
    gain->setMatrix(matrix.data());
    const auto to_display = OCIO::DisplayViewTransform::Create();
    to_display->setSrc(source.c_str());
    to_display->setDisplay(display.c_str());
    to_display->setView(view.c_str());
    to_display->setLooksBypass(!look.empty());
    const auto group = OCIO::GroupTransform::Create();
    group->appendTransform(gain);
    if (!look.empty() && look != kNoLook) {
        // To the look's process space and back: what OpenColorIO's own viewing pipeline does for a look that is chosen.
        const auto graded = OCIO::LookTransform::Create();
        graded->setSrc(source.c_str());
        graded->setDst(source.c_str());
        graded->setLooks(look.c_str());
        group->appendTransform(graded);
    }
    group->appendTransform(to_display);

    ColorTransform result;
    try {
        result.impl_ = std::make_shared<ColorTransform::Impl>(
            ColorTransform::Impl{impl_->config->getProcessor(group)->getOptimizedCPUProcessor(kExact)});
    } catch (const OCIO::Exception& error) {
        impl_->fail(fmt::format("cannot show '{}' through view '{}' of '{}'{}: {}", source, view, display,
                                look.empty() ? "" : fmt::format(" with look '{}'", look), error.what()));
    }
    return result;
}

Chromaticities ColorConfig::chromaticities(const std::string& space) const {
    impl_->require_linear(space);
    const auto to_ap0 = impl_->to_ap0(space);
    if (!to_ap0) impl_->fail("the config has no ACES2065-1, so that the primaries of its spaces are not known");
    // Conversions adapt every white to the same one, which hides the space's own; published primaries bring it back.
    if (const auto published = recognise_primaries(*to_ap0)) return *published;
    return chromaticities_of(ap0_to_xyz_d65() * *to_ap0);
}

Rgb ColorConfig::luminance_weights(const std::string& space) const {
    impl_->require_linear(space);
    const auto to_ap0 = impl_->to_ap0(space);
    if (!to_ap0) {
        std::array<double, 3> luma{};
        impl_->config->getDefaultLumaCoefs(luma.data());
        return {static_cast<float>(luma[0]), static_cast<float>(luma[1]), static_cast<float>(luma[2])};
    }
    const auto published = recognise_primaries(*to_ap0);
    const Matrix3d to_xyz = published ? rgb_to_xyz(*published) : ap0_to_xyz_d65() * *to_ap0;
    return {static_cast<float>(to_xyz[3]), static_cast<float>(to_xyz[4]), static_cast<float>(to_xyz[5])};
}

std::string color_library_version() {
    return OCIO::GetVersion();
}

}  // namespace etendue
