// A host that needs files too: the component io.
#include <halflit/gltf.hpp>
#include <halflit/image.hpp>

#include <cstdio>

int main() {
    const auto loaded = halflit::load_gltf("no such file.glb");
    std::printf("%s\n", loaded ? "loaded" : loaded.error().message.c_str());
    return loaded || halflit::built_in_sky().rgb.empty() ? 1 : 0;
}
