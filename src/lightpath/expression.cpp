#include "lightpath/expression.h"

#include "core/pointed_text.h"
#include "lightpath/label_classes.h"

#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr EventKinds kReflect = kind_of(ScatterEvent::ReflectDiffuse) | kind_of(ScatterEvent::ReflectGlossy) |
                                kind_of(ScatterEvent::ReflectSingular);
constexpr EventKinds kTransmit = kind_of(ScatterEvent::TransmitDiffuse) | kind_of(ScatterEvent::TransmitGlossy) |
                                 kind_of(ScatterEvent::TransmitSingular);
constexpr EventKinds kVolume = kind_of(ScatterEvent::Volume);
constexpr EventKinds kDiffuse = kind_of(ScatterEvent::ReflectDiffuse) | kind_of(ScatterEvent::TransmitDiffuse);
constexpr EventKinds kGlossy = kind_of(ScatterEvent::ReflectGlossy) | kind_of(ScatterEvent::TransmitGlossy);
constexpr EventKinds kSingular = kind_of(ScatterEvent::ReflectSingular) | kind_of(ScatterEvent::TransmitSingular);

constexpr std::array<std::pair<char, EventKinds>, 12> kLetters{{
    {'C', kCameraKind},
    {'E', kCameraKind},
    {'L', kAllSourceKinds},
    {'O', kind_of(SourceEvent::Surface)},
    {'B', kind_of(SourceEvent::Environment)},
    {'D', kDiffuse},
    {'G', kGlossy},
    {'S', kSingular},
    {'R', kReflect},
    {'T', kTransmit},
    {'V', kVolume},
    {'.', kAllKinds},
}};

std::optional<EventKinds> kinds_of_letter(char letter) {
    for (const auto& [name, kinds] : kLetters)
        if (name == letter) return kinds;
    return std::nullopt;
}

/// Groups in groups: so many that no expression of sense has more, and few enough for the stack.
constexpr int kDeepest = 100;
constexpr std::size_t kLongest = 4096;

class Parser {
  public:
    explicit Parser(std::string_view text) : text_(text) {}

    PathExpression parse() {
        if (text_.size() > kLongest) fail(fmt::format("longer than {} characters", kLongest), 0);
        result_.is_negated = take('!');
        (void)parse_choice(0);
        if (peek() != '\0') fail(fmt::format("'{}' without its beginning", peek()), at_);
        return std::move(result_);
    }

  private:
    [[noreturn]] static void fail(const std::string& what, std::size_t offset) { throw ExpressionError(what, offset); }

    /// The next character that means something; '\0' at the end.
    char peek() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool take(char wanted) {
        if (peek() != wanted) return false;
        ++at_;
        return true;
    }

    std::size_t add(ExpressionNode node) {
        result_.nodes.push_back(std::move(node));
        return result_.nodes.size() - 1;
    }

    std::size_t parse_choice(int depth) {
        if (depth > kDeepest) fail(fmt::format("more than {} groups in each other", kDeepest), at_);
        std::vector<std::size_t> choices{parse_sequence(depth)};
        while (take('|')) choices.push_back(parse_sequence(depth));
        return add({.kind = ExpressionNode::Kind::Choice, .children = std::move(choices)});
    }

    std::size_t parse_sequence(int depth) {
        std::vector<std::size_t> parts;
        for (char next = peek(); next != '\0' && next != '|' && next != ')'; next = peek())
            parts.push_back(parse_repeated(depth));
        if (parts.empty()) fail("nothing where an event should be", at_);
        return add({.kind = ExpressionNode::Kind::Sequence, .children = std::move(parts)});
    }

    std::size_t parse_repeated(int depth) {
        std::size_t node = parse_one(depth);
        const auto repeat = [&](int least, int most) {
            node = add({.kind = ExpressionNode::Kind::Repeat, .children = {node}, .least = least, .most = most});
        };
        constexpr int kMostSigns = 8;
        for (int signs = 0;; ++signs) {
            if (signs > kMostSigns) fail(fmt::format("more than {} signs of repetition in a row", kMostSigns), at_);
            if (take('*'))
                repeat(0, ExpressionNode::kEndless);
            else if (take('+'))
                repeat(1, ExpressionNode::kEndless);
            else if (take('?'))
                repeat(0, 1);
            else if (peek() == '{') {
                const auto [least, most] = parse_counts();
                repeat(least, most);
            } else
                return node;
        }
    }

    /// {2}, {1,3} or {2,}.
    std::pair<int, int> parse_counts() {
        const std::size_t begin = at_;
        (void)take('{');
        const std::optional<int> least = parse_count();
        std::optional<int> most = least;
        if (take(',')) {
            most = parse_count();
            if (!most) most = ExpressionNode::kEndless;
        }
        if (!least || !take('}') || *least > kMostRepetitions || *most > kMostRepetitions ||
            (*most != ExpressionNode::kEndless && (*most < *least || *most == 0)))
            fail(fmt::format("not {{N}}, {{N,M}} or {{N,}} with N <= M, and 1 <= M <= {}", kMostRepetitions), begin);
        return {*least, *most};
    }

    std::optional<int> parse_count() {
        (void)peek();
        int number = 0;
        const char* const begin = text_.data() + at_;
        const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), number);
        if (error != std::errc() || number < 0) return std::nullopt;
        at_ += static_cast<std::size_t>(end - begin);
        return number;
    }

    std::size_t parse_one(int depth) {
        const std::size_t begin = at_;
        if (take('(')) {
            const std::size_t group = parse_choice(depth + 1);
            if (!take(')')) fail("'(' without its ')'", begin);
            return group;
        }
        if (take('[')) {
            EventSet set;
            set.is_negated = take('^');
            while (!take(']')) {
                if (peek() == '\0') fail("'[' without its ']'", begin);
                set.patterns.push_back(parse_pattern());
            }
            if (set.patterns.empty()) fail("a set without events", begin);
            return add({.kind = ExpressionNode::Kind::Event, .event = std::move(set)});
        }
        return add({.kind = ExpressionNode::Kind::Event, .event = {.patterns = {parse_pattern()}}});
    }

    EventPattern parse_pattern() {
        const std::size_t begin = at_;
        if (take('<')) return parse_labelled(begin);
        const std::optional<EventKinds> kinds = kinds_of_letter(peek());
        if (!kinds)
            fail(fmt::format("'{}' is no event; events are C, E, L, O, B, D, G, S, R, T, V and .",
                             character_at(text_, at_)),
                 at_);
        ++at_;
        return {*kinds, {}};
    }

    /// After '<': a letter for the type, one for the scattering if wanted, a label in quotes if wanted.
    EventPattern parse_labelled(std::size_t begin) {
        EventPattern pattern{kAllScatterKinds | kAllSourceKinds, {}};
        int letters = 0;
        for (char next = peek(); next != '>' && next != '\'' && next != '"'; next = peek(), ++letters) {
            const std::optional<EventKinds> kinds = kinds_of_letter(next);
            if (!kinds || letters == 2) break;
            // A dot for the type is any scattering; one after it says nothing.
            if (next != '.')
                pattern.kinds &= *kinds;
            else if (letters == 0)
                pattern.kinds = kAllScatterKinds;
            ++at_;
        }
        const char next = peek();
        if (letters == 0 || (next != '>' && next != '\'' && next != '"'))
            fail("not <TYPE SCATTERING 'NAME'> such as <RD'gold'>, <T.> or <L'key'>", begin);
        if (pattern.kinds == 0) fail("no event is all of this at once", begin);
        if (const char quote = peek(); quote != '>') {
            std::size_t end = at_ + 1;
            while (end < text_.size() && text_[end] != quote) end += is_label_escape(text_, end) ? 2 : 1;
            if (end >= text_.size()) fail("a name without its closing quote", at_);
            pattern.label = std::string(text_.substr(at_ + 1, end - at_ - 1));
            if (pattern.label.empty()) fail("an empty name", at_);
            at_ = end + 1;
        }
        if (!take('>')) fail("'<' without its '>'", begin);
        return pattern;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    PathExpression result_;
};

}  // namespace

PathExpression parse_expression(std::string_view text) {
    return Parser(text).parse();
}

}  // namespace etendue
