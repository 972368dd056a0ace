// Whether sanitizers watch this build, in which everything takes many times as long.
#pragma once

namespace etendue::test {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kHasSanitizers = true;
#else
inline constexpr bool kHasSanitizers = false;
#endif

}  // namespace etendue::test
