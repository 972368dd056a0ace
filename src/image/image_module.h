// The module with all code that needs OpenImageIO, which is loaded when the first image is opened or written: Debian's
// OpenImageIO brings some 250 libraries with it, whose loading takes longer than all else that a program does at start.
#pragma once

#include <future>

namespace etendue {

/// The address of what the module exports under the name `symbol`. The first call loads the module. Throws
/// std::runtime_error if it cannot be loaded, and not IoError, which whoever reads an image takes for the image's
/// fault.
[[nodiscard]] void* image_module_symbol(const char* symbol);

/// Loads the module on a thread of its own, for what will need it but has other things to do first. The future throws
/// as `image_module_symbol` does, and its destructor waits for the thread.
[[nodiscard]] std::future<void> load_image_module_early();

}  // namespace etendue
