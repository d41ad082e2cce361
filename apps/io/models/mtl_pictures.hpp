// The pictures that MTL files name.
#pragma once

#include "apps/io/models/model_builder.hpp"
#include "halflit/target.hpp"

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace halflit::io::detail {

/// Makes scene textures of them. Besides PNG, JPEG and WebP they may be BMP and TGA, and pictures of one quantity each become one texture
/// of several. A picture that several materials use is one texture. A picture that cannot be read is -1, with a warning, or if
/// strict a LoadFailure; `where` is for messages.
class MtlPictures {
public:
    explicit MtlPictures(ModelBuilder& builder) : builder_(builder) {}

    int texture(const std::string& file, const std::string& where, ColorSpace space, MipRule rule);
    /// sRGB colours of one picture (empty: white), and alpha of another: its alpha if it has some, else its brightness.
    int with_alpha(const std::string& color, const std::string& mask, const std::string& where);
    /// Linear: green is the brightness of the first picture, blue that of the second; empty: white.
    int roughness_metal(const std::string& roughness, const std::string& metal, const std::string& where);
    /// True if a picture can be read and has no colours: it holds heights, where a normal map is expected.
    bool is_grey(const std::string& file);

private:
    using Key = std::tuple<std::string, std::string, ColorSpace, MipRule>;

    Result<Image> decode(const std::string& file);
    Image decoded(const std::string& file, const std::string& where);
    bool holds_no_colours(const std::string& file);
    int add(const Image& image, const std::string& where, ColorSpace space, MipRule rule);
    template <class Make>
    int once(const Key& key, const Make& make);

    ModelBuilder& builder_;
    std::map<Key, int> texture_of_;
    std::map<std::string, bool> is_grey_;
};

}  // namespace halflit::io::detail
