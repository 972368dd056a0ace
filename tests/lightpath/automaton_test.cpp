#include "lightpath/automaton.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// Events as letters, for an independent matcher: scatterings as in ScatterEvent, materials gold in capitals.
constexpr std::string_view kScatterLetters = "dgstuvm";
constexpr std::string_view kSourceLetters = "ole";

const PathNames kNames{.materials = {"plain", "gold"}, .lights = {"key", "fill"}};

/// A path: its scatterings with their materials, and its light with its name.
struct Path {
    std::vector<std::pair<ScatterEvent, std::size_t>> scatterings;
    SourceEvent source = SourceEvent::Surface;
    std::size_t light = 0;

    [[nodiscard]] std::string word() const {
        std::string word = "C";
        for (const auto& [event, material] : scatterings) {
            const char letter = kScatterLetters[static_cast<std::size_t>(event)];
            word += material == 1 ? static_cast<char>(letter - 'a' + 'A') : letter;
        }
        const char letter = kSourceLetters[static_cast<std::size_t>(source)];
        return word + (light == 0 ? static_cast<char>(letter - 'a' + 'A') : letter);
    }
};

void for_all_paths(std::size_t longest, const std::function<void(const Path&)>& visit) {
    Path path;
    const std::function<void(std::size_t)> extend = [&](std::size_t left) {
        for (std::size_t source = 0; source < kSourceEvents; ++source)
            for (std::size_t light = 0; light < 2; ++light) {
                path.source = static_cast<SourceEvent>(source);
                path.light = light;
                visit(path);
            }
        if (left == 0) return;
        for (std::size_t event = 0; event < kScatterEvents; ++event)
            for (std::size_t material = 0; material < 2; ++material) {
                path.scatterings.emplace_back(static_cast<ScatterEvent>(event), material);
                extend(left - 1);
                path.scatterings.pop_back();
            }
    };
    extend(longest);
}

/// The expressions of a path whose first `from_eye` scatterings belong to the eye subpath.
ExpressionMask classify(const PathAutomaton& automaton, const Path& path, std::size_t from_eye) {
    PathAutomaton::State eye = automaton.eye_start();
    for (std::size_t i = 0; i < from_eye; ++i)
        eye =
            automaton.eye_scatter(eye, path.scatterings[i].first, automaton.material_label(path.scatterings[i].second));
    PathAutomaton::State light = automaton.light_start(path.source, automaton.light_label(path.light));
    for (std::size_t i = path.scatterings.size(); i > from_eye; --i)
        light = automaton.light_scatter(light, path.scatterings[i - 1].first,
                                        automaton.material_label(path.scatterings[i - 1].second));
    return automaton.join(eye, light);
}

/// The same, read from the eye alone.
ExpressionMask classify(const PathAutomaton& automaton, const Path& path) {
    PathAutomaton::State eye = automaton.eye_start();
    for (const auto& [event, material] : path.scatterings)
        eye = automaton.eye_scatter(eye, event, automaton.material_label(material));
    return automaton.eye_ends(eye, path.source, automaton.light_label(path.light));
}

/// Expressions, and the same as regular expressions over the letters above. Lower case: material plain, light fill.
struct Case {
    const char* expression;
    const char* reference;
};
constexpr std::array kCases{
    Case{"C L", "C[OLEole]"},
    Case{"C .* L", "C[dgstuvmDGSTUVM]*[OLEole]"},
    Case{"C D S+ L", "C[dtDT][svSV]+[OLEole]"},
    Case{"L S+ D E", "C[dtDT][svSV]+[OLEole]"},
    Case{"C <RD> L", "C[dD][OLEole]"},
    Case{"C <T.> .* [OB]", "C[tuvTUV][dgstuvmDGSTUVM]*[OEoe]"},
    Case{"C <.'gold'> (D|G)* <L'key'>", "C[DGSTUVM][dtDTguGU]*[OLE]"},
    Case{"C [^S]* L", "C[dgtumDGTUM]*[OLEole]"},
    Case{"C V{2} L", "C[mM][mM][OLEole]"},
    Case{"C D{1,2} G? O", "C[dtDT]{1,2}[guGU]?[Oo]"},
    Case{"C (D G){1,} B", "C([dtDT][guGU])+[Ee]"},
    Case{"!C D* L", "(?!C[dtDT]*[OLEole]$).*"},
    Case{"<L'fi*'> (S D)* C", "C([dtDT][svSV])*[ole]"},
    Case{"C (D|D S|S D)* L", "C([dtDT]|[dtDT][svSV]|[svSV][dtDT])*[OLEole]"},
    Case{"C (D?){3} L", "C[dtDT]{0,3}[OLEole]"},
    Case{"C [<RD'gold'>S]+ L", "C[DsvSV]+[OLEole]"},
};

PathAutomaton automaton_of(const std::vector<std::string>& texts) {
    std::vector<PathExpression> expressions(texts.size());
    std::ranges::transform(texts, expressions.begin(), parse_expression);
    return {expressions, kNames};
}

PathAutomaton automaton_of_cases() {
    std::vector<std::string> texts(kCases.size());
    std::ranges::transform(kCases, texts.begin(), &Case::expression);
    return automaton_of(texts);
}

TEST(PathAutomaton, ReadsEveryShortPathAsAnIndependentMatcherDoes) {
    const PathAutomaton automaton = automaton_of_cases();
    std::vector<std::regex> references(kCases.size());
    std::ranges::transform(kCases, references.begin(), &Case::reference);
    for_all_paths(3, [&](const Path& path) {
        const ExpressionMask expressions = classify(automaton, path);
        const std::string word = path.word();
        for (std::size_t e = 0; e < kCases.size(); ++e)
            ASSERT_EQ((expressions >> e & 1) != 0, std::regex_match(word, references[e]))
                << kCases[e].expression << " of " << word;
    });
}

TEST(PathAutomaton, ReadsThePathTheSameWhereverItIsConnected) {
    const PathAutomaton automaton = automaton_of_cases();
    for_all_paths(4, [&](const Path& path) {
        const ExpressionMask whole = classify(automaton, path);
        for (std::size_t from_eye = 0; from_eye <= path.scatterings.size(); ++from_eye)
            ASSERT_EQ(classify(automaton, path, from_eye), whole) << path.word() << " cut after " << from_eye;
    });
}

TEST(PathAutomaton, RefusesWhatBeginsOrEndsNowhere) {
    for (const char* text : {"D L", "C D", "L D", "C", "L", ". D L", "D* L", "C L | L C", "(C|D) L"})
        EXPECT_THROW((void)automaton_of({text}), ExpressionError) << text;
}

TEST(PathAutomaton, HasBounds) {
    EXPECT_THROW((void)automaton_of(std::vector<std::string>(kMostExpressions + 1, "C L")), ExpressionError);
    EXPECT_THROW((void)automaton_of({"C (D{64}){64} L"}), ExpressionError);
    // A set of its own for every one of the last 20 events.
    EXPECT_THROW((void)automaton_of({"C .* D .{20} L"}), ExpressionError);
}

TEST(PathAutomaton, LayersOfManyMaterialsStayFew) {
    // Which of them a path has met so far is all that there is to know.
    std::vector<std::string> layers(8);
    for (std::size_t i = 0; i < layers.size(); ++i) layers[i] = "C .* <.'m" + std::to_string(i) + "'> .* L";
    const PathAutomaton automaton = automaton_of(layers);
    EXPECT_LE(automaton.eye_states(), 2 * 256 + 4);
    EXPECT_LE(automaton.light_states(), 2 * 256 + 4);
}

TEST(PathAutomaton, TellsNamesThatNothingHas) {
    EXPECT_EQ(automaton_of({"C <RD'silver'> <L'key'>", "C <L'rim*'>"}).unmatched_names(),
              (std::vector<std::string>{"silver", "rim*"}));
}

}  // namespace
}  // namespace etendue
