// Between the words of the rooms and those of the public headers.
#pragma once

#include "core/error.h"

#include <exception>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <etendue/error.h>
#include <etendue/message.h>

namespace etendue {

/// Settings that a caller gave beside those of a render.json.
struct GivenSettings {
    std::string text;         ///< empty if there are none
    std::string render_json;  ///< the file that they override
};

/// `problem`, located in the given settings if it is about a member that stands there.
[[nodiscard]] Message to_message(const Problem& problem, const GivenSettings& given);

/// `error` with its errors; notes and warnings are left out.
[[nodiscard]] Error to_error(const SceneError& error, const GivenSettings& given);

/// An error that is about no file.
[[nodiscard]] Error failure(Error::Kind kind, const std::string& text);

/// The result of `work`. Whatever it throws is thrown as Error.
template <typename Work>
auto translating(const GivenSettings& given, const Work& work) -> decltype(work()) {
    try {
        return work();
    } catch (const Error&) {
        throw;
    } catch (const SceneError& error) {
        throw to_error(error, given);
    } catch (const std::bad_alloc&) {
        throw failure(Error::Kind::Failed, "there is not enough memory");
    } catch (const std::exception& error) {
        throw failure(Error::Kind::Failed, error.what());
    }
}

}  // namespace etendue
