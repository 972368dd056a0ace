// glTF 2.0, as text or binary.
#pragma once

#include "loader/loader.h"

namespace etendue {

class GltfLoader : public SceneLoader {
  public:
    [[nodiscard]] bool can_load(const std::filesystem::path& file) const override;
    SweptSpace load(const std::filesystem::path& file, const LoadOptions& options, SceneDesc& scene,
                    ProblemList& problems) const override;
};

}  // namespace etendue
