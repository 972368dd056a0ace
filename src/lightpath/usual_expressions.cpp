#include "lightpath/usual_expressions.h"

#include <array>
#include <cstddef>

namespace etendue {

namespace {

constexpr std::size_t kPartition = 10;
constexpr std::array<UsualExpression, 14> kUsual{{
    {"emission", "C O", "surfaces that emit, as the eye sees them"},
    {"background", "C B", "the environment, as the eye sees it"},
    {"diffuse_direct", "C <RD> L", "diffuse surfaces lit by lights"},
    {"diffuse_indirect", "C <RD> .+ L", "diffuse surfaces lit by what other surfaces scatter"},
    {"specular_direct", "C [<RG><RS>] L", "lights in what mirrors and shines"},
    {"specular_indirect", "C [<RG><RS>] .+ L", "everything else in what mirrors and shines"},
    {"transmission_direct", "C T L", "lights through surfaces"},
    {"transmission_indirect", "C T .+ L", "everything else through surfaces"},
    {"volume_direct", "C V L", "media lit by lights"},
    {"volume_indirect", "C V .+ L", "media lit by what else scatters"},
    {"caustics", "C D [GS]+ L", "diffuse surfaces lit through glass or by way of mirrors"},
    {"caustics_seen", "C [GS]* D [GS]+ L", "the same, also as mirrors and glass show them"},
    {"direct", "C . L", "one scattering between light and eye"},
    {"indirect", "C . .+ L", "more than one"},
}};

}  // namespace

std::span<const UsualExpression> partition_expressions() {
    return std::span(kUsual).first(kPartition);
}

std::span<const UsualExpression> usual_expressions() {
    return kUsual;
}

}  // namespace etendue
