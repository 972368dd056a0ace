#include "image/displayed.h"
#include "image/finite.h"
#include "image/read.h"
#include "scene/studio.h"
#include "texture/cube_map.h"
#include "world/compile_parts.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>

namespace etendue {

namespace {

/// Rows of the image that a cube map is turned into, at most: 8192 x 4096 pixels take 400 MB.
constexpr int kMaxRows = 4096;

/// Samples across a pixel, so that what lies in a pixel is averaged and not picked.
constexpr int kSamplesAcross = 4;

void store(const Rgb& value, std::span<float> pixel) {
    pixel[0] = value.r;
    pixel[1] = value.g;
    pixel[2] = value.b;
}

Light compile_image(const EnvironmentDesc& desc, const ColorMatrix& from_rec709, ProblemList& problems) {
    const Rgb tint = desc.color * desc.scale;
    ImageF file;
    try {
        file = read_displayed_float(desc.image);
    } catch (const IoError& error) {
        throw SceneError(desc.location,
                         "the environment image '" + desc.image.string() + "' cannot be read: " + error.what());
    }
    warn_of_repairs(make_finite(std::span(file.pixels)), "the environment image '" + desc.image.string() + "'",
                    desc.location, problems);
    ImageF image(file.width, file.height, 3);
    for (int y = 0; y < file.height; ++y) {
        for (int x = 0; x < file.width; ++x) {
            const auto from = file.pixel(x, y);
            const Rgb rec709 = file.channels >= 3 ? Rgb(from[0], from[1], from[2]) : Rgb(from[0]);
            store(clamp_negative(from_rec709(rec709 * tint)), image.pixel(x, y));
        }
    }
    return ImageEnvironment(std::move(image), desc.rotation);
}

/// Linear radiance of one face, in Rec.709.
ImageF decode_face(const ImageDesc& desc) {
    const ImageSource source = source_of(desc);
    try {
        const ImageInfo info = read_image_info(source);
        if (info.width != desc.width || info.height != desc.height)
            throw IoError("its pixels do not fill its display window");
        const bool is_rgbd = info.format == "png" && info.channels == 4;
        const Texture texels =
            Texture::without_levels(read_image_8bit(source), {.encoding = Encoding::Srgb, .nearest = true});
        ImageF face(texels.width(), texels.height(), 3);
        for (int y = 0; y < face.height; ++y)
            for (int x = 0; x < face.width; ++x) {
                const Texel texel = texels.lookup({(static_cast<float>(x) + 0.5f) / static_cast<float>(face.width),
                                                   (static_cast<float>(y) + 0.5f) / static_cast<float>(face.height)});
                // The encoder's divisor is 1/255 at least; without one the pixel says nothing.
                const float divisor = is_rgbd ? texel.alpha : 1.0f;
                store(divisor > 0.0f ? texel.rgb / divisor : Rgb(), face.pixel(x, y));
            }
        return face;
    } catch (const IoError& error) {
        throw SceneError(desc.location, std::string("the image cannot be decoded: ") + error.what());
    }
}

/// A cube map as an image of latitude and longitude: so there is one way to choose directions, and one to look up. The
/// equator of the image has as many pixels as four faces, and each is the mean of what lies in it.
Light compile_cube(const SceneDesc& scene, const CubeMapDesc& desc, const ColorMatrix& from_rec709,
                   const ThreadPool& threads) {
    std::array<ImageF, 6> faces;
    threads.parallel_for(faces.size(), [&](std::size_t i, int) {
        faces[i] = decode_face(scene.images[static_cast<std::size_t>(desc.faces[i].index)]);
    });
    const CubeMap cube(std::move(faces));
    const Mat4f to_cube = desc.to_world.inverse();
    const Rgb tint = scene.environment.color * scene.environment.scale * desc.intensity;

    const int height = std::min(2 * cube.side(), kMaxRows);
    ImageF image(2 * height, height, 3);
    threads.parallel_for(static_cast<std::size_t>(height), [&](std::size_t row, int) {
        const auto at = [](int pixel, int sample) {
            return static_cast<float>(pixel) + (static_cast<float>(sample) + 0.5f) / kSamplesAcross;
        };
        const int y = static_cast<int>(row);
        for (int x = 0; x < image.width; ++x) {
            Rgb sum;
            for (int j = 0; j < kSamplesAcross; ++j)
                for (int i = 0; i < kSamplesAcross; ++i) {
                    const Vec2f position(at(x, i) / static_cast<float>(image.width),
                                         at(y, j) / static_cast<float>(height));
                    sum += cube.lookup(transform_vector(to_cube, latitude_longitude_direction(position)));
                }
            const Rgb mean = sum * (1.0f / (kSamplesAcross * kSamplesAcross));
            store(clamp_negative(from_rec709(mean * tint)), image.pixel(x, y));
        }
    });
    return ImageEnvironment(std::move(image), scene.environment.rotation);
}

/// The studio as an image of latitude and longitude.
Light compile_studio(const EnvironmentDesc& desc, const ColorMatrix& from_rec709, const ThreadPool& threads) {
    constexpr int kRows = 256;
    const Rgb tint = clamp_negative(from_rec709(desc.color * desc.scale));
    ImageF image(2 * kRows, kRows, 3);
    threads.parallel_for(kRows, [&](std::size_t row, int) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < image.width; ++x) {
            const Vec2f position((static_cast<float>(x) + 0.5f) / static_cast<float>(image.width),
                                 (static_cast<float>(y) + 0.5f) / static_cast<float>(kRows));
            store(tint * studio_radiance(latitude_longitude_direction(position)), image.pixel(x, y));
        }
    });
    return ImageEnvironment(std::move(image), desc.rotation);
}

}  // namespace

Light compile_environment(const SceneDesc& scene, const ColorMatrix& from_rec709, const ThreadPool& threads,
                          ProblemList& problems) {
    const EnvironmentDesc& desc = scene.environment;
    if (desc.is_studio) return compile_studio(desc, from_rec709, threads);
    if (!desc.image.empty()) return compile_image(desc, from_rec709, problems);
    if (desc.cube) return compile_cube(scene, *desc.cube, from_rec709, threads);
    return ConstantEnvironment{clamp_negative(from_rec709(desc.color * desc.scale))};
}

}  // namespace etendue
