#include "api/translate.h"

#include "loader/loader.h"

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

Message::Kind to_kind(Severity severity) {
    switch (severity) {
        case Severity::Note:
            return Message::Kind::Note;
        case Severity::Warning:
            return Message::Kind::Warning;
        case Severity::Error:
            break;
    }
    return Message::Kind::Error;
}

/// True if `pointer` leads to something in the JSON `text`.
bool has_member(const std::string& text, const std::string& pointer) {
    const nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
    try {
        return !pointer.empty() && document.contains(nlohmann::json::json_pointer(pointer));
    } catch (const nlohmann::json::exception&) {
        return false;  // no pointer
    }
}

}  // namespace

Error::Error(Kind kind, const std::string& what, std::vector<Message> messages)
    : std::runtime_error(what), kind_(kind), messages_(std::move(messages)) {
    if (messages_.empty()) messages_.push_back({Message::Kind::Error, {}, {}, what});
}

Message to_message(const Problem& problem, const GivenSettings& given) {
    const bool is_given =
        !given.text.empty() && problem.where.file == given.render_json && has_member(given.text, problem.where.pointer);
    return {to_kind(problem.severity), is_given ? kGivenSettings : problem.where.file, problem.where.pointer,
            problem.message};
}

Error to_error(const SceneError& error, const GivenSettings& given) {
    std::vector<Message> messages;
    std::string what;
    for (const Problem& problem : error.problems().all()) {
        if (problem.severity != Severity::Error) continue;
        const Message& message = messages.emplace_back(to_message(problem, given));
        what += (what.empty() ? "" : "\n") + SourceLocation{message.file, message.pointer}.str() + ": " + message.text;
    }
    return {Error::Kind::InvalidScene, what, std::move(messages)};
}

Error failure(Error::Kind kind, const std::string& text) {
    return {kind, text, {}};
}

}  // namespace etendue
