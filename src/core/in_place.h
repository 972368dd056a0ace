// Values made where they stay. What a function has just returned through memory waits, when it is copied from there,
// for all that was written number by number to reach the cache.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace etendue {

/// Stands for the value that `make` returns, as the argument of a constructor, such as that of std::optional::emplace:
/// the value is made in its place and never copied.
template <typename Make>
struct InPlace {
    Make make;

    // NOLINTNEXTLINE(google-explicit-constructor): it stands for the value
    operator std::invoke_result_t<const Make&>() const { return make(); }
};
template <typename Make>
InPlace(Make) -> InPlace<Make>;

/// `object` becomes what `make` returns, which must not look at it.
template <typename T, typename Make>
requires std::is_trivially_destructible_v<T>
inline void make_in_place(T& object, Make make) {
    std::construct_at(&object, InPlace{std::move(make)});
}

}  // namespace etendue
