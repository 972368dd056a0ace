#include "image/image_module.h"

#include "image/module_bytes.h"

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace etendue {

namespace {

/// A file in memory with these bytes, which can be opened by the name that is returned. It is never closed, since
/// debuggers and sanitizers look at the files of loaded code.
std::string memory_file(std::span<const std::byte> bytes) {
    const int file = ::memfd_create("etendue_oiio.so", MFD_CLOEXEC);
    if (file < 0 || ::write(file, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
        throw std::runtime_error("images cannot be read or written: there is no memory for what does it");
    return fmt::format("/proc/self/fd/{}", file);
}

/// The module comes out of the program itself, so that this is one file that works wherever it is copied to, whatever
/// takes its name while it runs, and that its build ID stands for all of it. Never unloaded: OpenImageIO is not made
/// for that.
void* load_module() {
    void* const module = ::dlopen(memory_file(module_bytes()).c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (module == nullptr)
        throw std::runtime_error(
            fmt::format("images cannot be read or written: OpenImageIO cannot be loaded: {}", ::dlerror()));
    return module;
}

void* module_handle() {
    static void* const module = load_module();
    return module;
}

}  // namespace

void* image_module_symbol(const char* symbol) {
    return ::dlsym(module_handle(), symbol);
}

std::future<void> load_image_module_early() {
    return std::async(std::launch::async, [] { module_handle(); });
}

}  // namespace etendue
