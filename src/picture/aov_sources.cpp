#include "picture/aov_sources.h"

#include "lightpath/usual_expressions.h"
#include "wave/aov/first_hit_value.h"

#include <fmt/format.h>

namespace etendue {

std::vector<std::string_view> aov_source_names() {
    std::vector<std::string_view> names{
        aov_source::kMean.name,     aov_source::kRemoved.name, aov_source::kSamples.name,
        aov_source::kVariance.name, aov_source::kRays.name,    aov_source::kDeep.name,
        aov_source::kPasses.name,   aov_source::kLights.name,  aov_source::kDenoising.name};
    for (const UsualExpression& usual : usual_expressions()) names.push_back(usual.name);
    for (const FirstHitEntry& entry : first_hit_table()) names.push_back(entry.name);
    for (const MatteSource& matte : aov_source::kMattes) names.push_back(matte.name);
    names.push_back(aov_source::kCryptomatte.name);
    return names;
}

std::string list_aov_sources() {
    std::string list;
    const auto line = [&](std::string_view name, std::string_view what) {
        list += fmt::format("  {:<22} {}\n", name, what);
    };
    for (const OtherSource& source : {aov_source::kPasses, aov_source::kLights, aov_source::kDenoising})
        line(source.name, source.summary);
    for (const FirstHitEntry& entry : first_hit_table()) line(entry.name, entry.summary);
    for (const OtherSource& source : {aov_source::kSamples, aov_source::kVariance, aov_source::kRays, aov_source::kMean,
                                      aov_source::kRemoved, aov_source::kDeep})
        line(source.name, source.summary);
    line(aov_source::kCryptomatte.name, aov_source::kCryptomatte.summary);
    for (const MatteSource& matte : aov_source::kMattes) line(matte.name, matte.summary);
    for (const UsualExpression& usual : usual_expressions())
        line(usual.name, fmt::format("{} ({})", usual.summary, usual.expression));
    return list;
}

}  // namespace etendue
