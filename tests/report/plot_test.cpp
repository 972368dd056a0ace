#include "report/plot.h"

#include "report/comparison_files.h"
#include "report/csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace etendue {

namespace {

Plot small_plot() {
    Plot plot{.width = 100.0, .height = 50.0, .title = "a (b)", .parts = {}};
    plot.parts.emplace_back(PlotShape{.points = {{0.0, 0.0}, {10.0, 20.0}, {10.0, 0.0}},
                                      .is_closed = true,
                                      .fill = PlotColor{1.0, 0.0, 0.0},
                                      .fill_opacity = 0.5});
    plot.parts.emplace_back(
        PlotText{.at = {50.0, 40.0}, .text = "<é\u2212☃", .raised = "2", .anchor = PlotAnchor::End});
    return plot;
}

TEST(Plot, TextIsAsWideAsHelveticas) {
    EXPECT_DOUBLE_EQ(text_width("Wi", 10.0), 9.44 + 2.22);
    EXPECT_DOUBLE_EQ(text_width("1☃", 10.0), 2.0 * text_width("0", 10.0));
    EXPECT_EQ(text_width("", 10.0), 0.0);
}

TEST(Plot, PdfSaysWhereItsObjectsAre) {
    const std::string pdf = to_pdf(small_plot());
    const std::size_t table = pdf.find("\nxref\n") + 1;
    EXPECT_EQ(std::stoul(pdf.substr(pdf.find("startxref\n") + 10)), table);
    std::size_t entry = pdf.find(" f \n", table) + 4;
    for (int object = 1; object <= 6; ++object, entry += 20)
        EXPECT_EQ(pdf.substr(std::stoul(pdf.substr(entry, 10)), 7), std::to_string(object) + " 0 obj");
    const std::size_t stream = pdf.find("stream\n") + 7;
    EXPECT_EQ(pdf.find("endstream") - stream, std::stoul(pdf.substr(pdf.find("/Length ") + 8)));
    // From the bottom up, and in the fonts' encoding.
    EXPECT_NE(pdf.find("10.00 30.00 l"), std::string::npos) << pdf;
    EXPECT_NE(pdf.find("(<\\351\\226?) Tj"), std::string::npos) << pdf;
    EXPECT_NE(pdf.find("/Title (a \\(b\\))"), std::string::npos) << pdf;
    EXPECT_NE(pdf.find("/ca 0.5"), std::string::npos) << pdf;
}

TEST(Plot, PdfHasTheCharactersOfItsEncoding) {
    Plot plot{.width = 100.0, .height = 50.0, .title = "€ Œ “a” … Ÿ", .parts = {}};
    const std::string pdf = to_pdf(plot);
    EXPECT_NE(pdf.find("/Title (\\200 \\214 \\223a\\224 \\205 \\237)"), std::string::npos) << pdf;
    EXPECT_TRUE(has_pdf_text(plot.title));
    EXPECT_TRUE(has_pdf_text("what is asked?"));
    EXPECT_FALSE(has_pdf_text("☃"));
}

TEST(Plot, SvgIsTheSameModel) {
    const std::string svg = to_svg(small_plot());
    EXPECT_NE(svg.find("M0.00 0.00L10.00 20.00L10.00 0.00Z"), std::string::npos) << svg;
    EXPECT_NE(svg.find("&lt;é"), std::string::npos) << svg;
    EXPECT_NE(svg.find("fill-opacity=\"0.5\""), std::string::npos) << svg;
}

ComparisonReport two_variants() {
    ComparisonReport report;
    report.scene = "a,\"b\"";
    report.seeds = 2;
    report.metrics = {{"relmse", "relMSE", ""}};
    for (const char* name : {"path_1", "50%"}) {
        VariantReport variant{.name = name, .seeds = {1, 2}, .spp = 4};
        variant.seconds.values = variant.cpu_seconds.values = {1.0, 2.0};
        for (const std::uint32_t spp : {1u, 2u, 4u})
            variant.convergence.push_back({.spp = spp,
                                           .seconds = {{0.25 * spp, 0.5 * spp}},
                                           .cpu_seconds = {{0.25 * spp, 0.5 * spp}},
                                           .errors = {{"relmse", {{1.0 / spp, 2.0 / spp}}}}});
        variant.errors = variant.convergence.back().errors;
        report.variants.push_back(variant);
    }
    return report;
}

TEST(ComparisonFiles, CsvHasARowForEveryImage) {
    const std::string csv = to_csv(two_variants());
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 2 * 3);
    EXPECT_NE(csv.find("\"a,\"\"b\"\"\",path_1,,,2,2,2,0,1,1,,1\n"), std::string::npos) << csv;
    EXPECT_NE(csv.find("\"a,\"\"b\"\"\",50%,,,1,1,4,1,1,1,,0.25\n"), std::string::npos) << csv;
    EXPECT_EQ(csv_number(1.0 / 0.0), "");
}

TEST(ComparisonFiles, TexMasksWhatIsItsOwn) {
    const std::string tex = to_tex(two_variants());
    EXPECT_NE(tex.find("path\\_1 & 4 & $1.50$ & $1.50$ & $0.375$ $\\pm$ $0.177$"), std::string::npos) << tex;
    EXPECT_NE(tex.find("50\\% & "), std::string::npos) << tex;
    ComparisonReport odd = two_variants();
    odd.variants[0].name = R"([a] *b* #1 $2 &3 {4} ~5 ^6 \7 <8> |9| "0" x_y)";
    const std::string row = R"({[}a{]} {*}b{*} \#1 \$2 \&3 \{4\} \textasciitilde{}5 \textasciicircum{}6 )"
                            R"(\textbackslash{}7 \textless{}8\textgreater{} \textbar{}9\textbar{} \char34{}0\char34{} )"
                            R"(x\_y & 4 & )";
    EXPECT_NE(to_tex(odd).find("\\midrule\n" + row), std::string::npos) << to_tex(odd);
}

/// That pdfLaTeX takes the file, with booktabs or without, was tried by hand.
TEST(ComparisonFiles, TexNeedsNoPackage) {
    const std::string tex = to_tex(two_variants());
    std::size_t defined = 0;
    for (const char* line : {"\\toprule", "\\midrule", "\\bottomrule"})
        if (tex.find(fmt::format("\\providecommand{{{}}}{{\\hline}}", line)) < tex.find("\\begin{tabular}")) ++defined;
    EXPECT_EQ(defined, 3u) << tex;
    EXPECT_EQ(std::count(tex.begin(), tex.end(), '{'), std::count(tex.begin(), tex.end(), '}'));
}

TEST(ComparisonFiles, PlotsAreOfEachMetricOverTimeAndSamples) {
    const std::vector<NamedPlot> plots = convergence_plots(two_variants());
    ASSERT_EQ(plots.size(), 2u);
    EXPECT_EQ(plots[0].name, "relmse-time");
    EXPECT_EQ(plots[1].name, "relmse-spp");
    const std::string svg = to_svg(plots[1].plot);
    for (const char* text : {">samples per pixel<", ">path_1<", ">50%<", ">relMSE<", ">band: range, dots: slope −1<"})
        EXPECT_NE(svg.find(text), std::string::npos) << text << " in " << svg;
    ComparisonReport nothing = two_variants();
    for (VariantReport& variant : nothing.variants) variant.convergence.clear();
    EXPECT_TRUE(convergence_plots(nothing).empty());
}

TEST(RatioInterval, IsWelchs) {
    // Two estimates of four measurements each with the same variance: six degrees of freedom, t = 2.4469.
    const RatioInterval interval = ratio_interval({1.0, 0.02, 3.0}, {0.0, 0.02, 3.0});
    EXPECT_NEAR(interval.ratio, std::exp(1.0), 1e-12);
    EXPECT_NEAR(interval.high, std::exp(1.0 + 2.446912 * 0.2), 1e-5);
    EXPECT_NEAR(interval.low * interval.high, std::exp(2.0), 1e-9);
    EXPECT_TRUE(std::isnan(ratio_interval({1.0}, {0.0, 0.02, 3.0}).low)) << "one measurement tells no variance";
    const LogEstimate area = product({1.0, 0.02, 3.0}, {2.0, 0.02, 3.0});
    EXPECT_EQ(area.value, 3.0);
    EXPECT_DOUBLE_EQ(area.variance, 0.04);
    EXPECT_DOUBLE_EQ(area.degrees, 6.0);
    EXPECT_EQ(ratio_interval({1.0, 0.0, 3.0}, {1.0, 0.0, 3.0}).high, 1.0) << "nothing varies";
}

TEST(SeedValues, HaveALogarithmOfTheirMean) {
    const LogEstimate estimate = SeedValues{{1.0, 3.0}}.log_mean();
    EXPECT_DOUBLE_EQ(estimate.value, std::log(2.0));
    EXPECT_DOUBLE_EQ(estimate.variance, 2.0 / 2.0 / 4.0) << "of the mean, over its square";
    EXPECT_EQ(SeedValues({{5.0, 1.0, 2.0}}).median(), 2.0);
}

TEST(UntestedVariants, AreThoseOfWhichNoTestSaysAnything) {
    ComparisonReport report = two_variants();
    report.variants.push_back({.name = "direct"});
    for (const auto& [a, b, why] :
         {std::array{"path_1", "50%", ""}, {"path_1", "direct", "other light"}, {"50%", "direct", "other light"}})
        report.pairs.push_back({.a = a, .b = b, .not_tested = why});
    ASSERT_EQ(report.untested().size(), 1u);
    EXPECT_EQ(report.untested()[0].name, "direct");
    EXPECT_EQ(report.untested()[0].why, "other light");
}

}  // namespace

}  // namespace etendue
