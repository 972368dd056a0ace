#include "bsdf/measured_metals.h"

#include "bsdf/reflectance_color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

namespace etendue {

namespace {

/// Complex refractive index n + ik at one wavelength.
struct OpticalConstant {
    double nm, n, k;
};

// Johnson and Christy 1972.
constexpr std::array<OpticalConstant, 16> kSilver{{{367.9, 0.07, 1.657},
                                                   {381.5, 0.05, 1.864},
                                                   {397.4, 0.05, 2.070},
                                                   {413.3, 0.05, 2.275},
                                                   {430.5, 0.04, 2.462},
                                                   {450.9, 0.04, 2.657},
                                                   {471.4, 0.05, 2.869},
                                                   {495.9, 0.05, 3.093},
                                                   {520.9, 0.05, 3.324},
                                                   {548.6, 0.06, 3.586},
                                                   {582.1, 0.05, 3.858},
                                                   {616.8, 0.06, 4.152},
                                                   {659.5, 0.05, 4.483},
                                                   {704.5, 0.04, 4.838},
                                                   {756.0, 0.03, 5.242},
                                                   {821.1, 0.04, 5.727}}};

// Rakić 1995.
constexpr std::array<OpticalConstant, 12> kAluminium{{{364.7, 0.39877, 4.3957},
                                                      {413.3, 0.52135, 5.0008},
                                                      {442.8, 0.60790, 5.3676},
                                                      {476.9, 0.72780, 5.7781},
                                                      {516.6, 0.87340, 6.2418},
                                                      {563.6, 1.0728, 6.7839},
                                                      {619.9, 1.3660, 7.4052},
                                                      {652.2, 1.5724, 7.7354},
                                                      {688.8, 1.8301, 8.0601},
                                                      {729.3, 2.1606, 8.3565},
                                                      {774.9, 2.6154, 8.4914},
                                                      {794.8, 2.7675, 8.3866}}};

// Johnson and Christy 1972.
constexpr std::array<OpticalConstant, 16> kGold{{{367.9, 1.48, 1.895},
                                                 {381.5, 1.46, 1.933},
                                                 {397.4, 1.47, 1.952},
                                                 {413.3, 1.46, 1.958},
                                                 {430.5, 1.45, 1.948},
                                                 {450.9, 1.38, 1.914},
                                                 {471.4, 1.31, 1.849},
                                                 {495.9, 1.04, 1.833},
                                                 {520.9, 0.62, 2.081},
                                                 {548.6, 0.43, 2.455},
                                                 {582.1, 0.29, 2.863},
                                                 {616.8, 0.21, 3.272},
                                                 {659.5, 0.14, 3.697},
                                                 {704.5, 0.13, 4.103},
                                                 {756.0, 0.14, 4.542},
                                                 {821.1, 0.16, 5.083}}};

// Johnson and Christy 1974.
constexpr std::array<OpticalConstant, 16> kChromium{{{368.0, 1.87, 2.69},
                                                     {381.0, 1.92, 2.74},
                                                     {397.0, 2.00, 2.83},
                                                     {413.0, 2.08, 2.93},
                                                     {431.0, 2.19, 3.04},
                                                     {451.0, 2.33, 3.14},
                                                     {471.0, 2.51, 3.24},
                                                     {496.0, 2.75, 3.30},
                                                     {521.0, 2.94, 3.33},
                                                     {549.0, 3.18, 3.33},
                                                     {582.0, 3.22, 3.30},
                                                     {617.0, 3.17, 3.30},
                                                     {659.0, 3.09, 3.34},
                                                     {704.0, 3.05, 3.39},
                                                     {756.0, 3.08, 3.42},
                                                     {821.0, 3.20, 3.48}}};

// Johnson and Christy 1972.
constexpr std::array<OpticalConstant, 16> kCopper{{{367.9, 1.36, 1.975},
                                                   {381.5, 1.33, 2.045},
                                                   {397.4, 1.32, 2.116},
                                                   {413.3, 1.28, 2.207},
                                                   {430.5, 1.25, 2.305},
                                                   {450.9, 1.24, 2.397},
                                                   {471.4, 1.25, 2.483},
                                                   {495.9, 1.22, 2.564},
                                                   {520.9, 1.18, 2.608},
                                                   {548.6, 1.02, 2.577},
                                                   {582.1, 0.70, 2.704},
                                                   {616.8, 0.30, 3.205},
                                                   {659.5, 0.22, 3.747},
                                                   {704.5, 0.21, 4.205},
                                                   {756.0, 0.24, 4.665},
                                                   {821.1, 0.26, 5.180}}};

// Johnson and Christy 1974.
constexpr std::array<OpticalConstant, 16> kIron{{{368.0, 2.02, 2.43},
                                                 {381.0, 2.12, 2.50},
                                                 {397.0, 2.24, 2.58},
                                                 {413.0, 2.35, 2.65},
                                                 {431.0, 2.48, 2.71},
                                                 {451.0, 2.59, 2.77},
                                                 {471.0, 2.67, 2.82},
                                                 {496.0, 2.74, 2.88},
                                                 {521.0, 2.86, 2.91},
                                                 {549.0, 2.95, 2.93},
                                                 {582.0, 2.94, 2.99},
                                                 {617.0, 2.88, 3.05},
                                                 {659.0, 2.92, 3.10},
                                                 {704.0, 2.86, 3.19},
                                                 {756.0, 2.87, 3.28},
                                                 {821.0, 2.94, 3.39}}};

// Johnson and Christy 1974.
constexpr std::array<OpticalConstant, 16> kTitanium{{{368.0, 1.90, 2.90},
                                                     {381.0, 1.99, 2.93},
                                                     {397.0, 2.08, 2.95},
                                                     {413.0, 2.14, 2.98},
                                                     {431.0, 2.21, 3.01},
                                                     {451.0, 2.27, 3.04},
                                                     {471.0, 2.32, 3.10},
                                                     {496.0, 2.36, 3.19},
                                                     {521.0, 2.44, 3.30},
                                                     {549.0, 2.54, 3.43},
                                                     {582.0, 2.60, 3.58},
                                                     {617.0, 2.67, 3.72},
                                                     {659.0, 2.76, 3.84},
                                                     {704.0, 2.86, 3.96},
                                                     {756.0, 3.00, 4.01},
                                                     {821.0, 3.21, 4.01}}};

// Palik 1985, every 0.1 eV from 3.3 to 1.6 eV, and 1.55 eV.
constexpr std::array<OpticalConstant, 19> kTungsten{{{375.7, 3.45, 2.55},
                                                     {387.4, 3.43, 2.45},
                                                     {399.9, 3.39, 2.41},
                                                     {413.3, 3.35, 2.42},
                                                     {427.5, 3.32, 2.45},
                                                     {442.8, 3.30, 2.49},
                                                     {459.2, 3.31, 2.55},
                                                     {476.8, 3.34, 2.62},
                                                     {495.9, 3.38, 2.68},
                                                     {516.6, 3.45, 2.72},
                                                     {539.0, 3.50, 2.72},
                                                     {563.5, 3.49, 2.75},
                                                     {590.4, 3.54, 2.84},
                                                     {619.9, 3.60, 2.89},
                                                     {652.5, 3.70, 2.94},
                                                     {688.8, 3.82, 2.91},
                                                     {729.3, 3.84, 2.78},
                                                     {774.9, 3.67, 2.68},
                                                     {799.9, 3.56, 2.73}}};

struct Metal {
    std::string_view symbol;
    std::span<const OpticalConstant> constants;  ///< in order of wavelength, covering 380 to 780 nm
};

constexpr std::array<Metal, 8> kMetals{{{"Ag", kSilver},
                                        {"Al", kAluminium},
                                        {"Au", kGold},
                                        {"Cr", kChromium},
                                        {"Cu", kCopper},
                                        {"Fe", kIron},
                                        {"Ti", kTitanium},
                                        {"W", kTungsten}}};

constexpr std::array<std::string_view, kMetals.size()> kNames = [] {
    std::array<std::string_view, kMetals.size()> names;
    std::ranges::transform(kMetals, names.begin(), &Metal::symbol);
    return names;
}();

std::complex<double> refractive_index(std::span<const OpticalConstant> constants, double nm) {
    const auto upper = std::clamp(std::ranges::lower_bound(constants, nm, {}, &OpticalConstant::nm),
                                  constants.begin() + 1, constants.end() - 1);
    const OpticalConstant& a = *(upper - 1);
    const OpticalConstant& b = *upper;
    const double t = (nm - a.nm) / (b.nm - a.nm);
    return {std::lerp(a.n, b.n, t), std::lerp(a.k, b.k, t)};
}

/// Reflectance for unpolarised light coming from vacuum onto a medium of refractive index `eta` = n + ik: Fresnel's
/// amplitudes with the complex cosine of Snell's law (Born and Wolf, "Principles of Optics", section 14.2).
double fresnel_conductor(double cos_i, const std::complex<double>& eta) {
    const std::complex<double> cos_t = std::sqrt(1.0 - (1.0 - cos_i * cos_i) / (eta * eta));
    const std::complex<double> perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const std::complex<double> parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return 0.5 * (std::norm(perpendicular) + std::norm(parallel));
}

Rgb reflectance_of(const Metal& metal, double cos_i) {
    const Rgb color =
        reflectance_color([&](double nm) { return fresnel_conductor(cos_i, refractive_index(metal.constants, nm)); });
    // A reflectance above 1 in a channel would create energy in a renderer that works in three channels.
    return {std::clamp(color.r, 0.0f, 1.0f), std::clamp(color.g, 0.0f, 1.0f), std::clamp(color.b, 0.0f, 1.0f)};
}

const Metal* find_metal(std::string_view symbol) {
    const auto found = std::ranges::find(kMetals, symbol, &Metal::symbol);
    return found == kMetals.end() ? nullptr : &*found;
}

}  // namespace

std::optional<Rgb> measured_metal_reflectance(std::string_view symbol, double cos_i) {
    const Metal* metal = find_metal(symbol);
    if (!metal) return std::nullopt;
    return reflectance_of(*metal, cos_i);
}

std::optional<MetalReflectance> measured_metal(std::string_view symbol) {
    const Metal* metal = find_metal(symbol);
    if (!metal) return std::nullopt;
    return MetalReflectance{.f0 = reflectance_of(*metal, 1.0), .f82 = reflectance_of(*metal, 1.0 / 7.0)};
}

std::span<const std::string_view> measured_metal_names() {
    return kNames;
}

}  // namespace etendue
