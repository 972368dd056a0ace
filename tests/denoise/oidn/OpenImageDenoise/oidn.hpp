// A stand-in for the library's header, whose "RT" filter doubles the colours and notes what it was told: our side of
// the calls is what is tested with it. Names and signatures are those that versions 1 and 2 of the library document.
#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace oidn {

enum class DeviceType { Default, CPU };
enum class Error { None, Unknown, InvalidArgument, InvalidOperation, OutOfMemory, UnsupportedHardware, Cancelled };
enum class Format { Undefined, Float, Float2, Float3 };

struct Told {
    struct Given {
        const float* pixels = nullptr;
        Format format = Format::Undefined;
        std::size_t width = 0;
        std::size_t height = 0;
    };
    std::map<std::string, Given> images{};
    std::map<std::string, int> numbers{};
    std::map<std::string, bool> flags{};
    int executions = 0;
    Error error = Error::None;        ///< what the device will say
    bool was_committed_late = false;  ///< something was set after the commit
};

/// Of the test that runs.
inline Told& told() {
    static Told all;
    return all;
}

class FilterRef {
  public:
    void setImage(const char* name, void* pixels, Format format, std::size_t width, std::size_t height) {
        told().images[name] = {static_cast<float*>(pixels), format, width, height};
        told().was_committed_late |= is_committed_;
        if (std::string(name) == "output") output_ = static_cast<float*>(pixels);
    }
    void set(const char* name, bool value) {
        told().flags[name] = value;
        told().was_committed_late |= is_committed_;
    }
    void setProgressMonitorFunction(bool (*function)(void*, double), void* user) {
        monitor_ = function;
        user_ = user;
    }
    void commit() { is_committed_ = true; }
    void execute() {
        ++told().executions;
        if (!is_committed_) told().error = Error::InvalidOperation;
        if (monitor_ != nullptr && !monitor_(user_, 0.5)) told().error = Error::Cancelled;
        const Told::Given& color = told().images.at("color");
        for (std::size_t i = 0; i < color.width * color.height * 3; ++i) output_[i] = 2.0f * color.pixels[i];
    }

  private:
    bool (*monitor_)(void*, double) = nullptr;
    void* user_ = nullptr;
    float* output_ = nullptr;
    bool is_committed_ = false;
};

class DeviceRef {
  public:
    void set(const char* name, int value) { told().numbers[name] = value; }
    void set(const char* name, bool value) { told().flags[name] = value; }
    void commit() {}
    FilterRef newFilter(const char*) { return {}; }
    Error getError(const char*& message) {
        message = "the stand-in's reason";
        return told().error;
    }
};

inline DeviceRef newDevice(DeviceType) {
    return {};
}

}  // namespace oidn
