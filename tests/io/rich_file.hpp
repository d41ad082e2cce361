// A file with many features, for tests that damage it or read it twice.
#pragma once

#include "tests/io/png_maker.hpp"

#include <string>

namespace halflit::test {

/// Indices, normals, texture coordinates, colours, sparse, morph targets, a skin, a camera, a light,
/// materials, a picture in a bufferView.
inline Bytes rich_file(bool embedded = false) {
    TriangleFile file;
    Bytes floats, bytes, indices, matrices, joint_numbers;
    append<std::uint8_t>(joint_numbers, {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1});
    append<float>(floats, {0, 0, 1, 0, 1, 0, 1, 0, 0});
    append<std::uint8_t>(bytes, {0, 1, 0, 0, 255, 0, 0, 1, 128, 0, 0, 1});
    append<std::uint16_t>(indices, {0, 1, 2, 2, 1, 0});
    for (int j = 0; j < 2; ++j) append<float>(matrices, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    const auto text = [](int i) { return std::to_string(i); };
    const int normal = file.add(floats, R"("componentType":5126,"count":3,"type":"VEC3")");
    const int uv = file.add(floats, R"("componentType":5126,"count":3,"type":"VEC2")");
    const int color = file.add(bytes, R"("componentType":5121,"normalized":true,"count":3,"type":"VEC4")");
    const int index = file.add(indices, R"("componentType":5123,"count":6,"type":"SCALAR")");
    const int joints = file.add(joint_numbers, R"("componentType":5121,"count":3,"type":"VEC4")");
    const int bind = file.add(matrices, R"("componentType":5126,"count":2,"type":"MAT4")");
    const int sparse = file.add(
        floats, R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":4,"componentType":5123},)"
                R"("values":{"bufferView":0}})");
    const int picture = file.add(plain_png(3, 2, 200, 100, 50), R"("componentType":5121,"count":1,"type":"SCALAR")");
    file.attributes += ",\"NORMAL\":" + text(normal) + ",\"TEXCOORD_0\":" + text(uv) + ",\"COLOR_0\":" + text(color) +
                       ",\"JOINTS_0\":" + text(joints) + ",\"WEIGHTS_0\":" + text(color);
    file.primitive = ",\"indices\":" + text(index) + ",\"material\":0,\"targets\":[{\"POSITION\":" + text(sparse) +
                     "}]},{\"attributes\":{\"POSITION\":" + text(sparse) + "},\"mode\":5";
    file.rest =
        ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{"
        "\"rotation\":1,\"scale\":[2,2]}}}},\"normalTexture\":{\"index\":0},"
        "\"alphaMode\":\"MASK\",\"extras\":{\"halflit\":{\"lobe\":\"sloan\",\"wrap\":0.5}}}],\"textures\":[{\"source\":0,\"sampler\":0}],"
        "\"samplers\":[{\"wrapS\":33071}],\"images\":[{\"bufferView\":" +
        text(picture) + ",\"mimeType\":\"image/png\"}],\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":" + text(bind) +
        "}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":0.1}}],\"extensionsUsed\":[\"KHR_lights_"
        "punctual\"],"
        "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\",\"spot\":{}}]}}";
    std::string json = file.json();
    json = replaced(json, "\"nodes\":[{\"mesh\":0}]",
                    "\"nodes\":[{\"mesh\":0,\"skin\":0,\"weights\":[0.5],\"children\":[1]},{\"camera\":0,\"rotation\":[0,0,1,0],"
                    "\"children\":[2]},{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}},\"scale\":[1,2,3]}]");
    if (!embedded) return glb(json, file.bin);
    return to_bytes(replaced(json, "\"buffers\":[{", "\"buffers\":[{\"uri\":\"data:;base64," + base64(file.bin) + "\","));
}

}  // namespace halflit::test
