#include "wave/aov/path_speller.h"

#include <algorithm>

namespace etendue {

namespace {

char letter_of(ScatterEvent event) {
    switch (event) {
        case ScatterEvent::ReflectDiffuse:
        case ScatterEvent::TransmitDiffuse:
            return 'D';
        case ScatterEvent::ReflectGlossy:
        case ScatterEvent::TransmitGlossy:
            return 'G';
        case ScatterEvent::ReflectSingular:
        case ScatterEvent::TransmitSingular:
            return 'S';
        case ScatterEvent::Volume:
            return 'V';
    }
    return '.';
}

char letter_of(SourceEvent event) {
    switch (event) {
        case SourceEvent::Surface:
            return 'O';
        case SourceEvent::Environment:
            return 'B';
        case SourceEvent::Lamp:
            return 'L';
    }
    return 'L';
}

}  // namespace

void PathSpeller::clear() {
    events_.clear();
    paths_.clear();
    contributions_.clear();
}

PathSpeller::Node PathSpeller::append(Node before, char letter) {
    events_.push_back({before, letter});
    return static_cast<Node>(events_.size() - 1);
}

PathSpeller::Node PathSpeller::begin_at_light(SourceEvent source) {
    return append(kEye, letter_of(source));
}

PathSpeller::Node PathSpeller::scatter(Node before, ScatterEvent event) {
    return append(before, letter_of(event));
}

std::string PathSpeller::letters(Node node) const {
    std::string backwards;
    for (; node != kEye; node = events_[node].before) backwards.push_back(events_[node].letter);
    return {backwards.rbegin(), backwards.rend()};
}

std::size_t PathSpeller::keep(const std::string& letters, std::size_t s, std::size_t t) {
    SpelledPath path{.word = "C", .s = static_cast<int>(s), .t = static_cast<int>(t)};
    for (const char letter : letters) path.word.append({' ', letter});
    path.edges = static_cast<int>(letters.size()) - static_cast<int>(std::ranges::count(letters, 'V'));
    paths_.push_back(std::move(path));
    return paths_.size() - 1;
}

std::size_t PathSpeller::meet_light(Node eye, SourceEvent source, bool is_sampled) {
    const std::string word = letters(eye) + letter_of(source);
    // Without the light, `word` has the vertices between it and the lens.
    return is_sampled ? keep(word, 1, word.size()) : keep(word, 0, word.size() + 1);
}

std::size_t PathSpeller::meet_camera(Node light) {
    std::string word = letters(light);
    std::ranges::reverse(word);
    return keep(word, word.size(), 1);
}

std::size_t PathSpeller::connect(Node eye, Node light) {
    std::string from_light = letters(light);
    std::ranges::reverse(from_light);
    const std::string from_eye = letters(eye);
    return keep(from_eye + from_light, from_light.size(), from_eye.size() + 1);
}

}  // namespace etendue
