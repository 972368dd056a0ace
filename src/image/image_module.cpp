#include "image/image_module.h"

#include "image/module_bytes.h"

#include <cerrno>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace etendue {

namespace {

[[noreturn]] void fail(const std::string& reason) {
    throw std::runtime_error("images cannot be read or written: " + reason);
}

std::string system_message() {
    return std::generic_category().message(errno);
}

/// While it lives, this process can write files of a size, also beyond its own limit (ulimit -f), which counts files in
/// memory too. No process passes its hard limit: then it fails.
class FileSize {
  public:
    explicit FileSize(std::size_t bytes) {
        if (::getrlimit(RLIMIT_FSIZE, &limit_) != 0) fail("getrlimit: " + system_message());
        if (limit_.rlim_cur >= bytes) return;
        constexpr rlim_t kKiB = 1024;
        if (limit_.rlim_max < bytes)
            fail(
                fmt::format("OpenImageIO is loaded through a file in memory of {} KiB, and no file may have more "
                            "than {} KiB here: raise that limit (ulimit -f)",
                            (bytes + kKiB - 1) / kKiB, limit_.rlim_max / kKiB));
        const rlimit raised{bytes, limit_.rlim_max};
        if (::setrlimit(RLIMIT_FSIZE, &raised) != 0) fail("setrlimit: " + system_message());
        is_raised_ = true;
    }
    ~FileSize() {
        if (is_raised_) ::setrlimit(RLIMIT_FSIZE, &limit_);
    }
    FileSize(const FileSize&) = delete;
    FileSize& operator=(const FileSize&) = delete;

  private:
    rlimit limit_{};
    bool is_raised_ = false;
};

/// A file in memory with these bytes, which can be opened by the name that is returned. It is never closed, since
/// debuggers and sanitizers look at the files of loaded code.
std::string memory_file(std::span<const std::byte> bytes) {
    const FileSize size(bytes.size());
    const int file = ::memfd_create("etendue_oiio.so", MFD_CLOEXEC);
    if (file < 0) fail("memfd_create: " + system_message());
    while (!bytes.empty()) {
        const ssize_t count = ::write(file, bytes.data(), bytes.size());
        if (count > 0)
            bytes = bytes.subspan(static_cast<std::size_t>(count));
        else if (count == 0 || errno != EINTR)
            fail("writing a file in memory: " + system_message());
    }
    return fmt::format("/proc/self/fd/{}", file);
}

/// docs/image-module.md tells why the module comes out of the program itself. Never unloaded: OpenImageIO is not made
/// for that.
void* load_module() {
    void* const module = ::dlopen(memory_file(module_bytes()).c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (module == nullptr) fail(fmt::format("OpenImageIO cannot be loaded: {}", ::dlerror()));
    return module;
}

void* module_handle() {
    static void* const module = load_module();
    return module;
}

}  // namespace

void* image_module_symbol(const char* symbol) {
    void* const address = ::dlsym(module_handle(), symbol);
    if (address == nullptr) fail(fmt::format("OpenImageIO's module has no '{}': {}", symbol, ::dlerror()));
    return address;
}

std::future<void> load_image_module_early() {
    try {
        return std::async(std::launch::async, [] { module_handle(); });
    } catch (const std::system_error& error) {
        fail(fmt::format("no thread can be started: {}; raise that limit (ulimit -u)", error.code().message()));
    }
}

}  // namespace etendue
