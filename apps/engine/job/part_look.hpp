// Looks of parts: hidden, ghosts, highlighted, and dimmed beside highlighted ones.
#pragma once

#include "halflit/scene.hpp"

#include <cstdint>
#include <map>
#include <tuple>

namespace halflit::engine {

enum class PartLook : std::uint8_t {
    usual,      ///< as the file has it
    hidden,     ///< not drawn
    ghost,      ///< translucent and pale, so that what lies inside is seen
    highlight,  ///< one colour, with the form that light and the normal map show
    dimmed      ///< grey, light where the part is light and dark where it is dark, with its form
};

/// Paints instances with materials of their own: copies, so that instances that share a material keep it. What a mask or a transparent
/// texture cuts out stays cut out. Painted materials do not follow an animation of the file's material.
class PartPainter {
public:
    PartPainter(Scene& scene, Vec3f highlight_linear) : scene_(scene), highlight_(highlight_linear) {}
    /// look: not hidden. is_cap: of a section, whose hatch stays.
    void paint(Instance& instance, PartLook look, bool is_cap);

private:
    [[nodiscard]] Material painted(const Material& source, PartLook look, bool is_cap, bool is_lit);
    [[nodiscard]] TextureUse shape_of(const Material& source);

    Scene& scene_;
    Vec3f highlight_;
    std::map<std::tuple<int, PartLook, bool, bool>, int> materials_;  ///< made already, by source, look, is_cap and is_lit
    std::map<int, int> shapes_;                                       ///< white textures with the alpha of these
};

}  // namespace halflit::engine
