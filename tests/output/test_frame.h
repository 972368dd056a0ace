// A frame with a value in every field, and a folder to write it to.
#pragma once

#include "output/output_frame.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace etendue {

inline OutputFrame make_test_frame() {
    OutputFrame frame;
    frame.pixels = ImageF(3, 2, 4);
    for (std::size_t i = 0; i < frame.pixels.pixels.size(); ++i) {
        frame.pixels.pixels[i] = i % 4 == 3 ? 0.75f : 0.013f * static_cast<float>(i + 1) * static_cast<float>(i + 2);
    }
    frame.crop_x = 5;
    frame.crop_y = 7;
    frame.full_width = 40;
    frame.full_height = 30;
    frame.pixel_aspect = 1.25f;
    frame.working_space = "ACEScg";
    frame.world_to_camera.setTranslation(Vec3f(0.0f, 0.0f, -4.0f));  // a camera at z = 4
    frame.world_to_screen =
        frame.world_to_camera * Mat4f(2.0f, 0, 0, 0, 0, 3.0f, 0, 0, 0, 0, -1, -1, 0, 0, 0, 0);  // 1/2 and 1/3 wide
    frame.camera = "Hero";
    frame.focal_length = 50.0f;
    frame.f_number = 2.0f;
    frame.focus_distance = 3.5f;
    frame.fps = 24.0;
    frame.frame = 1450;
    frame.owner = "Jo";
    frame.comments = "For Sam.";
    frame.scene = "cornell-box";
    frame.integrator = "path";
    frame.sampler = "sobol";
    frame.spp = 64;
    frame.seed = 4000000000u;
    frame.render_seconds = 12.5;
    frame.complete = false;
    frame.halt_reason = "interrupted";
    return frame;
}

/// A folder of the running test's own, removed at its end.
class TestFolder {
  public:
    TestFolder() {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::temp_directory_path() / ("etendue-" + std::string(test->test_suite_name()) + "-" +
                                                          test->name() + "-" + std::to_string(::getpid()));
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TestFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

}  // namespace etendue
