// The pictures that materials use: fetched, decoded under limits, made into textures. One texture for each picture and colour space.
#pragma once

#include "apps/io/detail/gltf_document.hpp"
#include "halflit/texture.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace halflit::io::detail {

class ImageStore {
public:
    ImageStore(Document& document, std::vector<Texture>& textures);

    /// Index into the scene's textures for an entry of "images". Throws LoadFailure, or, when lenient, warns and gives a magenta
    /// checkerboard.
    int texture_for(int image, ColorSpace space);

private:
    [[nodiscard]] Texture make(int image, ColorSpace space);

    Document& document_;
    std::vector<Texture>& textures_;
    Budget texture_memory_;
    std::map<std::pair<std::string, ColorSpace>, int> made_;  // indexed by the picture's source
};

}  // namespace halflit::io::detail
