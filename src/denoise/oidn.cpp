#include "denoise/oidn.h"

#include "core/error.h"

#include <cstddef>

#include <OpenImageDenoise/oidn.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

/// Tells the library whether to go on; false ends its work.
bool may_go_on(void* stop, double) {
    return !static_cast<const std::atomic<bool>*>(stop)->load(std::memory_order_relaxed);
}

void set_image(oidn::FilterRef& filter, const char* name, const ImageF& image) {
    // The library takes what it only reads by the same call as what it writes.
    filter.setImage(name, const_cast<float*>(image.pixels.data()), oidn::Format::Float3,
                    static_cast<std::size_t>(image.width), static_cast<std::size_t>(image.height));
}

/// Throws if the library reports an error; returns false if it was stopped.
bool check(oidn::DeviceRef& device) {
    const char* reason = nullptr;
    const oidn::Error error = device.getError(reason);
    if (error == oidn::Error::Cancelled) return false;
    if (error != oidn::Error::None)
        throw IoError(fmt::format("Open Image Denoise: {}", reason ? reason : "unknown error"));
    return true;
}

}  // namespace

bool has_oidn() {
    return true;
}

std::optional<ImageF> denoise_oidn(const ImageF& light, const OidnFeatures& features, const OidnSettings& settings) {
    // Of all devices only this one reads our memory without copies on every machine.
    oidn::DeviceRef device = oidn::newDevice(oidn::DeviceType::CPU);
    if (settings.threads > 0) device.set("numThreads", settings.threads);
    device.set("setAffinity", false);
    device.commit();
    check(device);

    ImageF output(light.width, light.height, 3);
    oidn::FilterRef filter = device.newFilter("RT");
    set_image(filter, "color", light);
    if (!features.albedo.pixels.empty()) {
        set_image(filter, "albedo", features.albedo);
        if (!features.normal.pixels.empty()) set_image(filter, "normal", features.normal);
    }
    set_image(filter, "output", output);
    filter.set("hdr", true);
    if (settings.stop != nullptr)
        filter.setProgressMonitorFunction(may_go_on, const_cast<std::atomic<bool>*>(settings.stop));
    filter.commit();
    filter.execute();
    if (!check(device)) return std::nullopt;
    return output;
}

}  // namespace etendue
