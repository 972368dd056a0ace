#include "loader/ies/ies_file.h"

#include "loader/ies/ies_tokens.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr double kAnyPositive = DBL_MAX;

/// The numbers that are used, as they stand in the file.
struct IesNumbers {
    double factor = 1.0;  ///< on all candela values
    std::vector<double> vertical;
    std::vector<double> horizontal;
    std::vector<double> candela;  ///< the vertical angles of each horizontal one after the other
};

/// Reads up to and including the line TILT=, whose value is returned, and says of which year the file is: 0 for the
/// first edition, which had no first line to tell.
std::pair<std::string_view, int> read_header(IesTokens& tokens) {
    int year = 0;
    for (bool first = true; !tokens.at_end(); first = false) {
        std::string_view line = tokens.line();
        if (first && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
        if (first && line.starts_with("IESNA91")) year = 1991;
        if (first && line.starts_with("IESNA:LM-63-1995")) year = 1995;
        if (first && line.starts_with("IESNA:LM-63-2002")) year = 2002;
        if (first && line.starts_with("IES:LM-63-2019")) year = 2019;
        if (line.starts_with("TILT=")) return {line.substr(5), year};
    }
    tokens.fail("there is no line TILT=, so this is no IES file (LM-63)");
}

void skip_tilt(IesTokens& tokens, std::string_view tilt) {
    if (!tilt.starts_with("INCLUDE")) return;
    (void)tokens.integer("the lamp-to-luminaire geometry", 1, 3);
    const int count = tokens.integer("the number of tilt angles", 1, kMaxIesAngles);
    (void)tokens.numbers("a tilt angle or its factor", 2 * static_cast<std::size_t>(count), -DBL_MAX, DBL_MAX);
}

/// The standard lets the angles begin and end at a few places, each of which says how the rest is to be mirrored.
void check_angles(const IesTokens& tokens, const IesNumbers& n) {
    // By more than what single precision tells apart.
    constexpr double kLeastStep = 1e-3;
    const auto ascending = [](const std::vector<double>& v) {
        return std::ranges::adjacent_find(v, [](double a, double b) { return !(b - a >= kLeastStep); }) == v.end();
    };
    if (!ascending(n.vertical)) tokens.fail("the vertical angles do not ascend");
    if (!ascending(n.horizontal)) tokens.fail("the horizontal angles do not ascend");
    const double first = n.horizontal.front();
    const double last = n.horizontal.back();
    if (last != 360.0 && std::abs(360.0 - last) < kLeastStep) tokens.fail("the horizontal angles end beside 360");
    const bool from_zero = first == 0.0 && (last == 0.0 || last == 90.0 || last == 180.0 || last > 180.0);
    const bool from_ninety = first == 90.0 && last == 270.0 && std::ranges::binary_search(n.horizontal, 180.0);
    if (!from_zero && !from_ninety)
        tokens.fail(
            fmt::format("the horizontal angles go from {} to {}, but must go from 0 to 0, 90, 180 or 360, or "
                        "from 90 over 180 to 270",
                        first, last));
}

IesNumbers read_numbers(IesTokens& tokens) {
    const auto [tilt, year] = read_header(tokens);
    skip_tilt(tokens, tilt);
    IesNumbers result;
    (void)tokens.number("the number of lamps", 0.0, kAnyPositive);
    (void)tokens.number("lumens per lamp", -1.0, kAnyPositive);
    result.factor = tokens.number("the candela multiplier", 0.0, kAnyPositive);
    const auto vertical = static_cast<std::size_t>(tokens.integer("the number of vertical angles", 2, kMaxIesAngles));
    const auto horizontal =
        static_cast<std::size_t>(tokens.integer("the number of horizontal angles", 1, kMaxIesAngles));
    if (vertical * horizontal > kMaxIesValues)
        tokens.fail(fmt::format("{} x {} values are more than the limit of {}", vertical, horizontal, kMaxIesValues));
    const int type = tokens.integer("the photometric type", 1, 3);
    if (type != 1) tokens.fail(fmt::format("type {} photometry is not supported, only type C", type == 2 ? 'B' : 'A'));
    (void)tokens.integer("the units type", 1, 2);
    (void)tokens.numbers("a dimension of the luminaire", 3, -DBL_MAX, DBL_MAX);  // negative ones mean round shapes
    result.factor *= tokens.number("the ballast factor", 0.0, kAnyPositive);
    // The same place is "future use" in 2002 and says how the file was generated in 2019.
    const double photometric_factor = tokens.number("the ballast-lamp factor", 0.0, kAnyPositive);
    if (year <= 1995) result.factor *= photometric_factor;
    (void)tokens.number("the input watts", 0.0, kAnyPositive);

    result.vertical = tokens.numbers("a vertical angle", vertical, 0.0, 180.0);
    result.horizontal = tokens.numbers("a horizontal angle", horizontal, 0.0, 360.0);
    check_angles(tokens, result);
    result.candela = tokens.numbers("an intensity", vertical * horizontal, 0.0, kAnyPositive);
    for (double& candela : result.candela) {
        candela *= result.factor;
        if (!(candela <= static_cast<double>(FLT_MAX))) tokens.fail("an intensity is beyond single precision");
    }
    return result;
}

/// A measured plane, and the angle at which it stands.
struct Plane {
    double degrees;
    std::size_t column;
};

/// Adds `planes` mirrored at `axis` degrees, beyond those that are there.
void mirror(std::vector<Plane>& planes, double axis) {
    for (std::size_t i = planes.size(); i-- > 0;)
        if (planes[i].degrees < axis) planes.push_back({2.0 * axis - planes[i].degrees, planes[i].column});
}

/// The planes of the whole circle, from 0 to 360 degrees.
std::vector<Plane> full_circle(const std::vector<double>& horizontal) {
    std::vector<Plane> planes;
    for (std::size_t i = 0; i < horizontal.size(); ++i) planes.push_back({horizontal[i], i});
    const double last = horizontal.back();
    if (horizontal.size() == 1) return {{0.0, 0}, {360.0, 0}};
    if (horizontal.front() == 90.0) {
        // Symmetric about the plane through 90 and 270: the quarter beyond 180 is mirrored to what follows 270, the one
        // before it to what precedes 90.
        mirror(planes, 270.0);
        std::erase_if(planes, [](const Plane& p) { return p.degrees > 360.0; });
        std::vector<Plane> front;
        for (std::size_t i = horizontal.size(); i-- > 0;)
            if (horizontal[i] > 90.0 && horizontal[i] <= 180.0) front.push_back({180.0 - horizontal[i], i});
        planes.insert(planes.begin(), front.begin(), front.end());
        return planes;
    }
    if (last == 90.0) mirror(planes, 90.0);
    if (last <= 180.0) mirror(planes, 180.0);
    if (planes.back().degrees < 360.0) planes.push_back({360.0, 0});
    return planes;
}

float radians(double degrees) {
    return static_cast<float>(degrees * std::numbers::pi / 180.0);
}

}  // namespace

IesProfileDesc parse_ies(std::string_view text, std::string name, const SourceLocation& where) {
    IesTokens tokens(text, where);
    const IesNumbers numbers = read_numbers(tokens);
    IesProfileDesc profile;
    profile.name = std::move(name);
    profile.location = where;
    for (const double angle : numbers.vertical) profile.vertical.push_back(radians(angle));
    const std::size_t height = numbers.vertical.size();
    for (const Plane& plane : full_circle(numbers.horizontal)) {
        profile.horizontal.push_back(radians(plane.degrees));
        const auto first = numbers.candela.begin() + static_cast<std::ptrdiff_t>(plane.column * height);
        for (auto value = first; value != first + static_cast<std::ptrdiff_t>(height); ++value)
            profile.candela.push_back(static_cast<float>(*value));
    }
    return profile;
}

}  // namespace etendue
