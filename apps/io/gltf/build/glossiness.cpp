#include "apps/io/gltf/build/glossiness.hpp"

#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace halflit::io::detail {

namespace {

constexpr double kDielectric = 0.04;

double brightness(const double (&c)[3]) { return std::sqrt(0.299 * c[0] * c[0] + 0.587 * c[1] * c[1] + 0.114 * c[2] * c[2]); }

/// The metallic value of which F0 and diffuse brightness are those given: the root of 0.04 m^2 + b m + 0.04 - specular.
double solve_metallic(double diffuse, double specular, double one_minus_specular) {
    if (specular < kDielectric) return 0;
    const double b = diffuse * one_minus_specular / (1 - kDielectric) + specular - 2 * kDielectric;
    const double discriminant = std::max(0.0, b * b - 4 * kDielectric * (kDielectric - specular));
    return std::clamp((-b + std::sqrt(discriminant)) / (2 * kDielectric), 0.0, 1.0);
}

std::uint16_t to_16_bits(double x) { return static_cast<std::uint16_t>(std::clamp(x, 0.0, 1.0) * 65535 + 0.5); }

/// A texture's texels at the size of another one: the nearest texel.
class Texels {
public:
    Texels(const Texture* texture, int width, int height) : texture_(texture), width_(width), height_(height) {}
    /// Four channels, white without a texture.
    [[nodiscard]] const std::uint16_t* at(int x, int y) const {
        static constexpr std::uint16_t kWhite[] = {65535, 65535, 65535, 65535};
        if (texture_ == nullptr) return kWhite;
        const std::int64_t column = (2 * std::int64_t{x} + 1) * texture_->width() / (2 * std::int64_t{width_});
        const std::int64_t row = (2 * std::int64_t{y} + 1) * texture_->height() / (2 * std::int64_t{height_});
        return texture_->data().data() + 4 * (row * texture_->width() + column);
    }

private:
    const Texture* texture_;
    int width_, height_;
};

struct Factors {
    double diffuse[4], specular[3], glossiness;
};

double factor_at(const std::vector<double>& values, std::size_t index) {
    return index < values.size() ? std::clamp(values[index], 0.0, 1.0) : 1.0;
}

Factors factors_of(const file::SpecularGlossiness& m) {
    Factors f{};
    for (std::size_t c = 0; c < 4; ++c) f.diffuse[c] = factor_at(m.diffuse_factor, c);
    for (std::size_t c = 0; c < 3; ++c) f.specular[c] = factor_at(m.specular_factor, c);
    f.glossiness = std::clamp(m.glossiness_factor, 0.0, 1.0);
    return f;
}

GlossySurface surface_at(const Factors& factors, const std::uint16_t* diffuse, const std::uint16_t* specular) {
    GlossySurface surface;
    for (std::size_t c = 0; c < 3; ++c) {
        surface.diffuse[c] = factors.diffuse[c] * diffuse[c] / 65535;
        surface.specular[c] = factors.specular[c] * specular[c] / 65535;
    }
    surface.glossiness = factors.glossiness * specular[3] / 65535;
    return surface;
}

struct Converted {
    Texture base_color, metallic_roughness;
};

/// The two textures of the surface, both of the larger size.
Converted convert(const Factors& factors, const Texture* diffuse, const Texture* specular) {
    const auto larger = [&](int (Texture::*side)() const) {
        return std::max(diffuse != nullptr ? (diffuse->*side)() : 1, specular != nullptr ? (specular->*side)() : 1);
    };
    const int width = larger(&Texture::width), height = larger(&Texture::height);
    auto base = take(TextureBuilder::make(width, height), "KHR_materials_pbrSpecularGlossiness");
    auto rough = take(TextureBuilder::make(width, height), "KHR_materials_pbrSpecularGlossiness");
    const Texels of_diffuse(diffuse, width, height), of_specular(specular, width, height);
    std::vector<std::uint16_t> base_row(static_cast<std::size_t>(width) * 4), rough_row(base_row.size());
    for (int y = 0; y < height; ++y) {
        check_time();
        for (int x = 0; x < width; ++x) {
            const std::uint16_t* const diffuse_map = of_diffuse.at(x, y);
            const MetalSurface metal = to_metal(surface_at(factors, diffuse_map, of_specular.at(x, y)));
            const auto at = static_cast<std::size_t>(x) * 4;
            for (std::size_t c = 0; c < 3; ++c) base_row[at + c] = to_16_bits(metal.base_color[c]);
            base_row[at + 3] = to_16_bits(factors.diffuse[3] * diffuse_map[3] / 65535);
            rough_row[at] = 65535;
            rough_row[at + 1] = to_16_bits(metal.roughness);
            rough_row[at + 2] = to_16_bits(metal.metallic);
            rough_row[at + 3] = 65535;
        }
        base.add_row(base_row.data());
        rough.add_row(rough_row.data());
    }
    return {base.finish(), rough.finish()};
}

bool same_place(const TextureUse& a, const TextureUse& b) { return a.uv_set == b.uv_set && a.row_u == b.row_u && a.row_v == b.row_v; }

/// A texture's mean, one texel.
Texture mean_of(const Texture& texture) {
    const TextureLevel last = texture.levels().back();
    const std::uint16_t* const texel = texture.data().data() + 4 * last.offset;
    return take(Texture::from_rgba16({texel, 4}, 1, 1), "KHR_materials_pbrSpecularGlossiness");
}

class Converter {
public:
    Converter(Document& document, Scene& scene) : document_(document), scene_(scene) {}

    void run() {
        for (std::size_t i = 0; i < scene_.materials.size(); ++i)
            if (document_.file.materials[i].glossy >= 0) convert_material(i);
        drop_unused();
    }

private:
    [[nodiscard]] const Texture* texture(const TextureUse& use) const {
        if (!use.used()) return nullptr;
        const Texture& found = scene_.textures[static_cast<std::size_t>(use.texture)];
        return found.levels().empty() ? nullptr : &found;
    }

    void convert_material(std::size_t index) {
        Material& material = scene_.materials[index];
        const Factors factors = factors_of(document_.file.glossy[static_cast<std::size_t>(document_.file.materials[index].glossy)]);
        const TextureUse diffuse = material.textures[TextureSlot::base_color],
                         specular = material.textures[TextureSlot::metallic_roughness];
        const Texture *const diffuse_map = texture(diffuse), *const shiny = texture(specular);
        material.base_color = {1, 1, 1, 1};
        material.metallic = material.roughness = 1;
        material.dielectric_reflectance = static_cast<float>(kDielectric);
        if (diffuse_map == nullptr && shiny == nullptr) {
            constexpr std::uint16_t kWhite[] = {65535, 65535, 65535, 65535};
            const MetalSurface metal = to_metal(surface_at(factors, kWhite, kWhite));
            const auto color = [&](std::size_t c) { return static_cast<float>(metal.base_color[c]); };
            material.base_color = {color(0), color(1), color(2), static_cast<float>(factors.diffuse[3])};
            material.metallic = static_cast<float>(metal.metallic), material.roughness = static_cast<float>(metal.roughness);
            return;
        }
        originals_.push_back(diffuse.texture);
        originals_.push_back(specular.texture);
        if (diffuse_map == nullptr || shiny == nullptr || same_place(diffuse, specular)) {
            const auto [base, rough] = converted(factors, diffuse.texture, specular.texture, diffuse_map, shiny);
            material.textures[TextureSlot::base_color] = diffuse_map != nullptr ? diffuse : specular;
            material.textures[TextureSlot::metallic_roughness] = shiny != nullptr ? specular : diffuse;
            material.textures[TextureSlot::base_color].texture = base;
            material.textures[TextureSlot::metallic_roughness].texture = rough;
            return;
        }
        document_.warn(
            fmt::format("materials[{}].extensions.KHR_materials_pbrSpecularGlossiness: its two textures lie differently, each is "
                        "converted with the mean of the other",
                        index));
        const Texture mean_diffuse = mean_of(*diffuse_map), mean_shiny = mean_of(*shiny);
        Texture base = convert(factors, diffuse_map, &mean_shiny).base_color;
        Texture rough = convert(factors, &mean_diffuse, shiny).metallic_roughness;
        material.textures[TextureSlot::base_color].texture = add(std::move(base));
        material.textures[TextureSlot::metallic_roughness].texture = add(std::move(rough));
    }

    std::pair<int, int> converted(const Factors& f, int diffuse, int specular, const Texture* diffuse_map, const Texture* shiny) {
        const Key key{diffuse,      specular,      f.diffuse[0],  f.diffuse[1],  f.diffuse[2],
                      f.diffuse[3], f.specular[0], f.specular[1], f.specular[2], f.glossiness};
        if (const auto found = known_.find(key); found != known_.end()) return found->second;
        Converted made = convert(f, diffuse_map, shiny);
        const int base = add(std::move(made.base_color)), rough = add(std::move(made.metallic_roughness));
        return known_[key] = {base, rough};
    }

    int add(Texture texture) {
        scene_.textures.push_back(std::move(texture));
        return static_cast<int>(scene_.textures.size()) - 1;
    }

    /// Takes away what was converted and is used no more, and closes the gaps.
    void drop_unused() {
        if (originals_.empty()) return;
        std::vector<bool> used(scene_.textures.size(), false), original(scene_.textures.size(), false);
        for (const Material& material : scene_.materials)
            for (const TextureUse& use : material.textures)
                if (use.used()) used[static_cast<std::size_t>(use.texture)] = true;
        for (const int index : originals_)
            if (index >= 0) original[static_cast<std::size_t>(index)] = true;
        std::vector<int> number(scene_.textures.size(), -1);
        std::vector<Texture> kept;
        for (std::size_t i = 0; i < scene_.textures.size(); ++i) {
            if (original[i] && !used[i]) continue;
            number[i] = static_cast<int>(kept.size());
            kept.push_back(std::move(scene_.textures[i]));
        }
        scene_.textures = std::move(kept);
        for (Material& material : scene_.materials)
            for (TextureUse& use : material.textures)
                if (use.used()) use.texture = number[static_cast<std::size_t>(use.texture)];
    }

    using Key = std::tuple<int, int, double, double, double, double, double, double, double, double>;
    Document& document_;
    Scene& scene_;
    std::map<Key, std::pair<int, int>> known_;
    std::vector<int> originals_;
};

}  // namespace

MetalSurface to_metal(const GlossySurface& surface) {
    constexpr double kLeast = 1e-6;
    const double one_minus_specular = 1 - std::max({surface.specular[0], surface.specular[1], surface.specular[2]});
    const double metallic = solve_metallic(brightness(surface.diffuse), brightness(surface.specular), one_minus_specular);
    MetalSurface out{};
    out.metallic = metallic;
    out.roughness = 1 - surface.glossiness;
    for (std::size_t c = 0; c < 3; ++c) {
        const double from_diffuse = surface.diffuse[c] * one_minus_specular / (1 - kDielectric) / std::max(1 - metallic, kLeast);
        const double from_specular = (surface.specular[c] - kDielectric * (1 - metallic)) / std::max(metallic, kLeast);
        out.base_color[c] = std::clamp(from_diffuse + (from_specular - from_diffuse) * metallic * metallic, 0.0, 1.0);
    }
    return out;
}

void convert_specular_glossiness(Document& document, Scene& scene) { Converter(document, scene).run(); }

}  // namespace halflit::io::detail
