// Whether sanitizers watch this build, in which everything takes many times as long.
#pragma once

namespace etendue::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kHasSanitizers = true;
#else
inline constexpr bool kHasSanitizers = false;
#endif

}  // namespace etendue::test
