// auto_setup() for tests.
#pragma once

#include "halflit/auto_setup.hpp"

namespace halflit::test {

/// auto_setup(), whose light becomes the scene's.
inline AutoSetup set_up(Scene& scene, int width, int height, const AutoOptions& options = {}) {
    AutoSetup setup = auto_setup(scene, width, height, options);
    static_cast<Lighting&>(scene) = setup.light;
    return setup;
}

}  // namespace halflit::test
