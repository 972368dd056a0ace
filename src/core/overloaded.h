// One visitor made of several functions.
#pragma once

namespace etendue {

/// Calls, for `std::visit`, the one of the functions that takes what a variant holds.
template <typename... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace etendue
