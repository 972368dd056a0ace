#include "metrics/error_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {
namespace {

ImageF row(const std::vector<float>& values) {
    ImageF image(static_cast<int>(values.size()), 1, 1);
    image.pixels = values;
    return image;
}

TEST(ErrorMetrics, AreZeroForEqualImages) {
    const ErrorMetrics m = compute_error_metrics(row({0.0f, 0.5f, 7.0f}), row({0.0f, 0.5f, 7.0f}));
    EXPECT_EQ(m.rel_mse, 0.0);
    EXPECT_EQ(m.rel_mse_trimmed, 0.0);
    EXPECT_EQ(m.mse, 0.0);
    EXPECT_EQ(m.mae, 0.0);
    EXPECT_EQ(m.smape, 0.0);
}

TEST(ErrorMetrics, AreThoseComputedByHand) {
    // Differences 1, -0.5 and 0.25.
    const ErrorMetrics m = compute_error_metrics(row({2.0f, 0.0f, 0.25f}), row({1.0f, 0.5f, 0.0f}));
    EXPECT_DOUBLE_EQ(m.mse, (1.0 + 0.25 + 0.0625) / 3.0);
    EXPECT_DOUBLE_EQ(m.mae, 1.75 / 3.0);
    EXPECT_DOUBLE_EQ(m.rel_mse, (1.0 / 1.01 + 0.25 / 0.26 + 0.0625 / 0.01) / 3.0);
    EXPECT_DOUBLE_EQ(m.smape, (1.0 / 3.01 + 0.5 / 0.51 + 0.25 / 0.26) / 3.0);
    EXPECT_DOUBLE_EQ(m.rel_mse_trimmed, m.rel_mse) << "three terms are too few to drop one";
}

TEST(ErrorMetrics, TrimsOneInAThousand) {
    std::vector<float> image(2000, 1.1f);
    const std::vector<float> reference(2000, 1.0f);
    image[17] = 1000.0f;
    image[1200] = 500.0f;
    image[1999] = 3.0f;  // the third largest is kept
    const ErrorMetrics m = compute_error_metrics(row(image), row(reference));
    const double small = std::pow(static_cast<double>(1.1f) - 1.0, 2.0);
    EXPECT_NEAR(m.rel_mse_trimmed, (1997.0 * small + 4.0) / 1.01 / 1998.0, 1e-12);
    EXPECT_NEAR(m.rel_mse, (1997.0 * small + 4.0 + 999.0 * 999.0 + 499.0 * 499.0) / 1.01 / 2000.0, 1e-6);
}

TEST(ErrorMetrics, TheOneTermThatIsTrimmedIsTheLargest) {
    std::vector<float> image(1500, 1.0f);
    const std::vector<float> reference(1500, 1.0f);
    image[0] = 2.0f;
    image[700] = 1000.0f;
    const ErrorMetrics m = compute_error_metrics(row(image), row(reference));
    EXPECT_NEAR(m.rel_mse_trimmed, 1.0 / 1.01 / 1499.0, 1e-12);
}

TEST(ErrorMetrics, AreMeansOverChannelsToo) {
    ImageF image(1, 1, 3);
    image.pixels = {1.0f, 0.0f, 0.0f};
    const ErrorMetrics m = compute_error_metrics(image, ImageF(1, 1, 3));
    EXPECT_DOUBLE_EQ(m.mse, 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(m.rel_mse, 100.0 / 3.0);
}

TEST(ErrorMetrics, DoNotHideWhatIsNoNumber) {
    std::vector<float> image(2000, 1.0f);
    image[5] = std::numeric_limits<float>::quiet_NaN();
    const ErrorMetrics m = compute_error_metrics(row(image), row(std::vector<float>(2000, 1.0f)));
    EXPECT_TRUE(std::isnan(m.mse));
    EXPECT_TRUE(std::isnan(m.rel_mse_trimmed));
}

TEST(ErrorMetrics, RefuseImagesOfDifferentShape) {
    EXPECT_THROW((void)compute_error_metrics(ImageF(2, 1, 3), ImageF(1, 2, 3)), std::invalid_argument);
    EXPECT_THROW((void)compute_error_metrics(row({1.0f}), row({1.0f}), {}, std::array{1.0f, 2.0f}),
                 std::invalid_argument);
    EXPECT_THROW((void)compute_error_metrics(ImageF(2, 1, 3), ImageF(2, 1, 4)), std::invalid_argument);
    EXPECT_THROW((void)compute_error_metrics(ImageF(), ImageF()), std::invalid_argument);
}

TEST(ErrorMetrics, PrintTheirFormulasAndEpsilon) {
    const std::string text = compute_error_metrics(row({2.0f}), row({1.0f})).str();
    EXPECT_NE(text.find("0.990099   mean (v - r)^2 / (r^2 + 0.01)"), std::string::npos) << text;
    EXPECT_NE(text.find("0.1% of the terms"), std::string::npos) << text;
}

TEST(ErrorMetrics, AreOfTheRegionThatIsSelected) {
    ImageF image(4, 2, 3);
    image.pixel(2, 1)[1] = 3.0f;
    const ImageF reference(4, 2, 3);
    EXPECT_DOUBLE_EQ(compute_error_metrics(image, reference, {.region = PixelRect{2, 1, 4, 2}}).mse, 9.0 / 6.0);
    EXPECT_EQ(compute_error_metrics(image, reference, {.region = PixelRect{0, 0, 4, 1}}).mse, 0.0);
    EXPECT_TRUE(std::isnan(compute_error_metrics(image, reference, {.region = PixelRect{0, 0, 0, 0}}).mse));
}

TEST(ErrorMetrics, AreTheMeansOfTheirMaps) {
    ImageF image(5, 3, 3);
    ImageF reference(5, 3, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        image.pixels[i] = static_cast<float>(i % 7);
        reference.pixels[i] = static_cast<float>(i % 5);
    }
    const ErrorMetrics metrics = compute_error_metrics(image, reference);
    for (const ErrorMetric metric : kErrorMetrics)
        EXPECT_NEAR(mean_of(error_map(metric, image, reference)), metrics.value(metric), 1e-6 * metrics.value(metric))
            << name_of(metric) << ", of which 45 terms are too few to trim one";
    EXPECT_EQ(error_map(ErrorMetric::Mae, image, reference).channels, 1);
}

}  // namespace
}  // namespace etendue
