#include "wave/aov/path_words.h"

namespace etendue {

namespace {

void add_share(ExpressionMask expressions, const Rgb& share, std::vector<ExpressionShare>& shares) {
    if (expressions != 0) shares.push_back({expressions, share});
}

/// Returns which of the events of `event` takes the larger share of the light.
ScatterEvent usual_event(const VertexEvent& event) {
    return average(event.share) >= 0.5f ? event.event : event.other;
}

/// Appends the number of a path that was spelled to `shares`, in place of a mask.
void add_spelled(std::size_t path, std::vector<ExpressionShare>& shares) {
    shares.push_back({ExpressionMask{path}, Rgb(1.0f)});
}

}  // namespace

VertexEvent surface_event(const Scattering& scattering, const Vec3f& wi, bool is_delta, TransportMode mode,
                          std::uint16_t label) {
    const bool is_transmission = scattering.is_transmission(wi);
    VertexEvent event;
    event.label = label;
    if (is_delta) {
        event.event = is_transmission ? ScatterEvent::TransmitSingular : ScatterEvent::ReflectSingular;
        return event;
    }
    event.event = is_transmission ? ScatterEvent::TransmitDiffuse : ScatterEvent::ReflectDiffuse;
    event.other = is_transmission ? ScatterEvent::TransmitGlossy : ScatterEvent::ReflectGlossy;
    event.share = scattering.diffuse_share(wi, mode);
    return event;
}

WordRange PathWords::begin(PathAutomaton::State state) {
    words_.push_back({state, Rgb(1.0f)});
    return {static_cast<std::uint32_t>(words_.size() - 1), 1};
}

void PathWords::add_word(std::size_t first, PathAutomaton::State state, const Rgb& share) {
    if (is_black(share)) return;
    for (std::size_t i = first; i < words_.size(); ++i)
        if (words_[i].state == state) {
            words_[i].share += share;
            return;
        }
    words_.push_back({state, share});
}

template <typename Next>
WordRange PathWords::scatter(WordRange before, const VertexEvent& event, const Next& next) {
    const std::size_t first = words_.size();
    for (std::uint32_t i = 0; i < before.count; ++i) {
        const WordShare word = words_[before.first + i];
        add_word(first, next(word.state, event.event, event.label), word.share * event.share);
        add_word(first, next(word.state, event.other, event.label), word.share * (Rgb(1.0f) - event.share));
    }
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(words_.size() - first)};
}

WordRange PathWords::scatter_from_eye(WordRange before, const VertexEvent& event) {
    if (speller_ != nullptr) return {speller_->scatter(before.first, usual_event(event))};
    return scatter(before, event, [this](PathAutomaton::State state, ScatterEvent what, std::uint16_t label) {
        return automaton_->eye_scatter(state, what, label);
    });
}

WordRange PathWords::scatter_from_light(WordRange before, const VertexEvent& event) {
    if (speller_ != nullptr) return {speller_->scatter(before.first, usual_event(event))};
    return scatter(before, event, [this](PathAutomaton::State state, ScatterEvent what, std::uint16_t label) {
        return automaton_->light_scatter(state, what, label);
    });
}

void PathWords::end_at_light(WordRange range, const AovSet::Source& source,
                             std::vector<ExpressionShare>& shares) const {
    if (speller_ != nullptr) return add_spelled(speller_->meet_light(range.first, source.event, false), shares);
    for (const WordShare& word : (*this)[range])
        add_share(automaton_->eye_ends(word.state, source.event, source.label), word.share, shares);
}

void PathWords::end_at_light(WordRange before, const VertexEvent& event, const AovSet::Source& source,
                             std::vector<ExpressionShare>& shares) {
    if (speller_ != nullptr)
        return add_spelled(speller_->meet_light(scatter_from_eye(before, event).first, source.event, true), shares);
    const std::size_t kept = words_.size();
    end_at_light(scatter_from_eye(before, event), source, shares);
    words_.resize(kept);
}

void PathWords::end_at_camera(WordRange range, std::vector<ExpressionShare>& shares) const {
    if (speller_ != nullptr) return add_spelled(speller_->meet_camera(range.first), shares);
    for (const WordShare& word : (*this)[range])
        add_share(automaton_->join(automaton_->eye_start(), word.state), word.share, shares);
}

void PathWords::end_at_camera(const AovSet::Source& source, std::vector<ExpressionShare>& shares) const {
    if (speller_ != nullptr) return add_spelled(speller_->meet_camera(speller_->begin_at_light(source.event)), shares);
    add_share(automaton_->eye_ends(automaton_->eye_start(), source.event, source.label), Rgb(1.0f), shares);
}

void PathWords::join(WordRange eye, const PathWords& light_words, WordRange light,
                     std::vector<ExpressionShare>& shares) const {
    if (speller_ != nullptr) return add_spelled(speller_->connect(eye.first, light.first), shares);
    for (const WordShare& from_eye : (*this)[eye])
        for (const WordShare& from_light : light_words[light])
            add_share(automaton_->join(from_eye.state, from_light.state), from_eye.share * from_light.share, shares);
}

}  // namespace etendue
