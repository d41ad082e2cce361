// MTL: the materials of OBJ files, and how they become halflit's.
#pragma once

#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/mtl_pictures.hpp"
#include "apps/io/models/text_scanner.hpp"
#include "halflit/material.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// A texture of a material: `map_Kd -s 2 2 wood.png`.
struct MtlTexture {
    std::string file;                             ///< as it is written; empty: none
    std::array<double, 2> scale{1, 1}, offset{};  ///< of u and v
    double bump = 1;                              ///< -bm
    bool clamp = false;
    bool is_tile = false;  ///< the first of several, "wood.<UDIM>.png"
};

struct MtlMaterial {
    std::string name;
    std::optional<std::array<double, 3>> kd, ks, ke;  ///< diffuse, mirrored, emitted
    std::optional<double> ns, d, tr, pr, pm;          ///< exponent, opacity, transparency, roughness, metalness
    MtlTexture map_ka, map_kd, map_ks, map_ke, map_d, map_pr, map_pm, bump, norm;
    std::vector<std::string> not_drawn;       ///< statements that the picture lacks
    std::vector<std::string> other_pictures;  ///< that these name
};

/// A name without quotes around it.
[[nodiscard]] std::string_view unquoted(std::string_view name);

/// Appends the materials of statements of MTL, of an MTL file or among those of an OBJ file.
class MtlText {
public:
    MtlText(ModelBuilder& builder, std::vector<MtlMaterial>& materials) : builder_(builder), materials_(materials) {}
    /// A statement, whose values `scanner` has next. False: it is none of MTL, or stands before a material.
    bool take(std::string_view word, TextScanner& scanner);
    /// The material that statements belong to; null: there was none yet.
    [[nodiscard]] MtlMaterial* material() { return at_ ? &materials_[*at_] : nullptr; }

private:
    ModelBuilder& builder_;
    std::vector<MtlMaterial>& materials_;
    std::optional<std::size_t> at_;  ///< of the last material that it began
};

/// Notes the pictures that a material names.
void add_pictures(const MtlMaterial& material, ModelBuilder& builder);

/// Appends the materials of an MTL file. `name` is for warnings. Wrong values are warned of, and left out.
void read_mtl(std::string_view text, const std::string& name, ModelBuilder& builder, std::vector<MtlMaterial>& materials);

/// Adds a material to the scene, and its textures. Kd and map_Kd are the base colour; Ns is an exponent of Blinn and Phong, whose lobe is
/// as wide as that of the roughness (2 / (Ns + 2))^(1/4); Ks 0.5 is the reflectance 0.04; Pr, Pm and their maps, if there, replace Ns and
/// Ks.
[[nodiscard]] int make_material(const MtlMaterial& from, ModelBuilder& builder, MtlPictures& pictures);

}  // namespace halflit::io::detail
