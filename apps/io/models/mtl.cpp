#include "apps/io/models/mtl.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/models/model_text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace halflit::io::detail {

namespace {

std::optional<double> next_number(Words& words) {
    Words ahead = words;
    const auto value = parse_real<double>(ahead.next());
    if (value) words = ahead;
    return value && std::isfinite(*value) ? value : std::nullopt;
}

/// "r g b", or "r" for three equal ones. "spectral" and "xyz" are not read.
std::optional<std::array<double, 3>> read_color(Words words) {
    const auto r = next_number(words);
    if (!r) return std::nullopt;
    const auto g = next_number(words), b = next_number(words);
    return std::array{*r, g.value_or(*r), b.value_or(g.value_or(*r))};
}

/// The values of -o, -s or -t: one to three numbers, of which a picture uses two.
void read_pair(Words& words, std::array<double, 2>& pair) {
    for (std::size_t i = 0; i < 3; ++i) {
        const auto value = next_number(words);
        if (!value) return;
        if (i < 2) pair[i] = std::clamp(*value, -1e6, 1e6);
    }
}

MtlTexture read_texture(Words words) {
    MtlTexture texture;
    for (;;) {
        Words option = words;
        const std::string_view name = option.next();
        std::array<double, 2> ignored{};
        if (name == "-o") {
            read_pair(option, texture.offset);
        } else if (name == "-s") {
            read_pair(option, texture.scale);
        } else if (name == "-t") {
            read_pair(option, ignored);
        } else if (name == "-mm") {
            option.next();
            option.next();
        } else if (name == "-bm") {
            texture.bump = std::clamp(next_number(option).value_or(1.0), -1e6, 1e6);
        } else if (name == "-clamp") {
            texture.clamp = same_word(option.next(), "on");
        } else if (name == "-blendu" || name == "-blendv" || name == "-cc" || name == "-texres" || name == "-boost" || name == "-imfchan" ||
                   name == "-type") {
            option.next();
        } else {
            texture.file = words.rest();
            return texture;
        }
        words = option;
    }
}

/// A statement of a material.
void read_statement(std::string_view word, Words words, MtlMaterial& m) {
    const auto not_drawn = [&] {
        if (m.not_drawn.size() < 8) m.not_drawn.push_back(printable(word, 20));
    };
    const auto set = [&](auto& value, const auto& read) {
        if (!read) return not_drawn();  // "Kd spectral file.rfl", or no value
        value = read;
    };
    const auto number = [&](std::optional<double>& value) { set(value, next_number(words)); };
    const auto color = [&](std::optional<std::array<double, 3>>& value) { set(value, read_color(words)); };
    const auto map = [&](MtlTexture& texture) {
        texture = read_texture(words);
        if (texture.file.empty()) not_drawn();
    };
    if (same_word(word, "kd")) return color(m.kd);
    if (same_word(word, "ks")) return color(m.ks);
    if (same_word(word, "ke")) return color(m.ke);
    if (same_word(word, "ns")) return number(m.ns);
    if (same_word(word, "d")) {
        if (words.rest().starts_with("-halo")) words.next();
        return number(m.d);
    }
    if (same_word(word, "tr")) return number(m.tr);
    if (same_word(word, "pr")) return number(m.pr);
    if (same_word(word, "pm")) return number(m.pm);
    if (same_word(word, "map_kd")) return map(m.map_kd);
    if (same_word(word, "map_ks")) return map(m.map_ks);
    if (same_word(word, "map_pr")) return map(m.map_pr);
    if (same_word(word, "map_pm")) return map(m.map_pm);
    if (same_word(word, "map_ke")) return map(m.map_ke);
    if (same_word(word, "map_d")) return map(m.map_d);
    if (same_word(word, "map_bump") || same_word(word, "bump")) return map(m.bump);
    if (same_word(word, "norm") || same_word(word, "map_kn")) return map(m.norm);
    // Ka and map_Ka say how much of the light from around is returned, which the base colour does; illum is the model of a renderer.
    if (same_word(word, "ka") || same_word(word, "map_ka") || same_word(word, "illum") || same_word(word, "ni") || same_word(word, "tf") ||
        same_word(word, "sharpness"))
        return;
    not_drawn();
}

float factor(double value, double most = 1.0) { return static_cast<float>(std::clamp(value, 0.0, most)); }

class MaterialOfMtl {
public:
    MaterialOfMtl(const MtlMaterial& from, ModelBuilder& builder, MtlPictures& pictures)
        : from_(from), builder_(builder), pictures_(pictures) {}

    int make() {
        Material m;
        m.name = from_.name;
        m.double_sided = true;
        set_base_color(m);
        set_roughness(m);
        if (from_.ke) m.emissive = {factor((*from_.ke)[0], 1e6), factor((*from_.ke)[1], 1e6), factor((*from_.ke)[2], 1e6)};
        if (!from_.map_ke.file.empty()) {
            m.textures[TextureSlot::emissive] = use(from_.map_ke, "map_Ke", ColorSpace::srgb, MipRule::equal);
            if (m.emissive == Vec3f{}) m.emissive = {1, 1, 1};
        }
        set_normal_map(m);
        if (!from_.not_drawn.empty())
            builder_.document().warn(
                fmt::format("material \"{}\": not drawn: {}", printable(m.name, 80), fmt::join(from_.not_drawn, ", ")));
        return builder_.add_material(m);
    }

private:
    std::string where(const char* key, const std::string& file) const {
        return fmt::format("material \"{}\": {} {}", printable(from_.name, 80), key, printable(file, 120));
    }
    /// A texture that lies as the material's map says.
    static TextureUse placed(const MtlTexture& map, int texture) {
        TextureUse use;
        use.texture = texture;
        // The file's v points up: v' = 1 - v. Its transform is scale * v + offset.
        use.row_u = {static_cast<float>(map.scale[0]), 0, static_cast<float>(map.offset[0])};
        use.row_v = {0, static_cast<float>(map.scale[1]), static_cast<float>(1.0 - map.scale[1] - map.offset[1])};
        if (map.clamp) use.sampler.wrap_u = use.sampler.wrap_v = TextureWrap::clamp;
        return use;
    }
    TextureUse use(const MtlTexture& map, const char* key, ColorSpace space, MipRule rule) {
        return placed(map, pictures_.texture(map.file, where(key, map.file), space, rule));
    }
    /// Two maps become one texture, which lies as the first one.
    void check_same_place(const MtlTexture& map, const MtlTexture& other, const char* keys) {
        if (other.file.empty() || (map.scale == other.scale && map.offset == other.offset)) return;
        builder_.document().warn(fmt::format("material \"{}\": {} lie differently; drawn as the first", printable(from_.name, 80), keys));
    }

    void set_base_color(Material& m) {
        const MtlTexture &color = from_.map_kd, &mask = from_.map_d;
        const bool has_color = !color.file.empty(), has_mask = !mask.file.empty();
        std::array<double, 3> kd = from_.kd.value_or(has_color ? std::array<double, 3>{1, 1, 1} : std::array<double, 3>{0.5, 0.5, 0.5});
        if (has_color && kd == std::array<double, 3>{}) kd = {1, 1, 1};  // as writers mean it: the picture alone
        const double alpha = from_.d ? *from_.d : 1.0 - from_.tr.value_or(0.0);
        m.base_color = {factor(kd[0]), factor(kd[1]), factor(kd[2]), factor(alpha)};
        if (m.base_color.w < 1.0f || has_mask) m.alpha_mode = AlphaMode::blend;
        if (has_mask && mask.file != color.file) {
            const MtlTexture& first = has_color ? color : mask;
            check_same_place(first, mask, "map_Kd and map_d");
            m.textures[TextureSlot::base_color] = placed(first, pictures_.with_alpha(color.file, mask.file, where("map_d", mask.file)));
            if (!m.textures[TextureSlot::base_color].used() && m.base_color.w == 1.0f) m.alpha_mode = AlphaMode::opaque;
        } else if (has_color) {
            m.textures[TextureSlot::base_color] =
                use(color, "map_Kd", ColorSpace::srgb, m.alpha_mode == AlphaMode::blend ? MipRule::alpha : MipRule::equal);
        }
    }

    /// By Pr and Pm, which say more, or else by Ns and Ks.
    void set_roughness(Material& m) {
        const MtlTexture &roughness = from_.map_pr, &metal = from_.map_pm;
        const bool has_roughness = !roughness.file.empty(), has_metal = !metal.file.empty();
        m.metallic = factor(from_.pm.value_or(has_metal ? 1.0 : 0.0));
        if (has_metal && m.metallic == 0.0f) m.metallic = 1.0f;  // as writers mean it: the picture alone
        m.roughness = has_roughness ? 1.0f : 0.6f;
        if (from_.ns && !has_roughness)
            m.roughness = static_cast<float>(std::sqrt(std::sqrt(2.0 / (std::clamp(*from_.ns, 0.0, 1e6) + 2.0))));
        if (from_.pr) m.roughness = factor(*from_.pr);
        if (has_roughness && m.roughness == 0.0f) m.roughness = 1.0f;
        if (has_roughness || has_metal) {
            const MtlTexture& first = has_roughness ? roughness : metal;
            check_same_place(first, metal, "map_Pr and map_Pm");
            m.textures[TextureSlot::metallic_roughness] = placed(
                first, pictures_.roughness_metal(roughness.file, metal.file, where(has_roughness ? "map_Pr" : "map_Pm", first.file)));
        }
        if ((has_roughness || has_metal) && !m.textures[TextureSlot::metallic_roughness].used()) {
            m.metallic = factor(from_.pm.value_or(0.0));
            m.roughness = factor(from_.pr.value_or(0.6));
        }
        if (from_.pr || from_.pm || has_roughness || has_metal) return;
        if (from_.ks) set_specular(m, *from_.ks);
        if (!from_.map_ks.file.empty() && m.specular > 0.0f)
            m.textures[TextureSlot::specular_color] = use(from_.map_ks, "map_Ks", ColorSpace::srgb, MipRule::equal);
    }

    static void set_specular(Material& m, const std::array<double, 3>& ks) {
        if (ks[0] <= 0 && ks[1] <= 0 && ks[2] <= 0)
            m.specular = 0;
        else
            m.specular_color = {factor(2 * ks[0], 25), factor(2 * ks[1], 25), factor(2 * ks[2], 25)};
    }

    void set_normal_map(Material& m) {
        const bool is_norm = !from_.norm.file.empty();
        const MtlTexture& map = is_norm ? from_.norm : from_.bump;
        if (map.file.empty()) return;
        if (!is_norm && pictures_.is_grey(map.file))
            return builder_.document().warn(fmt::format("material \"{}\": {} holds heights, expected a normal map; drawn without it",
                                                        printable(m.name, 80), printable(map.file, 120)));
        m.textures[TextureSlot::normal] = use(map, is_norm ? "norm" : "map_Bump", ColorSpace::linear, MipRule::normal);
        m.normal_scale = static_cast<float>(map.bump);
    }

    const MtlMaterial& from_;
    ModelBuilder& builder_;
    MtlPictures& pictures_;
};

}  // namespace

void read_mtl(std::string_view text, const std::string& name, ModelBuilder& builder, std::vector<MtlMaterial>& materials) {
    Lines lines(text);
    std::string_view line;
    const std::size_t first = materials.size();
    while (lines.next(line)) {
        if (lines.number() % 4096 == 0) check_time();
        Words words(line);
        const std::string_view word = words.next();
        if (word.empty() || word[0] == '#') continue;
        builder.document().geometry.take(line.size());
        if (same_word(word, "newmtl")) {
            builder.document().geometry.take(sizeof(MtlMaterial));
            materials.emplace_back().name = words.rest();
        } else if (materials.size() > first) {
            read_statement(word, words, materials.back());
        } else {
            builder.document().warn(fmt::format("{}: line {}: expected newmtl, found \"{}\"", name, lines.number(), printable(word, 40)));
        }
    }
}

int make_material(const MtlMaterial& from, ModelBuilder& builder, MtlPictures& pictures) {
    return MaterialOfMtl(from, builder, pictures).make();
}

}  // namespace halflit::io::detail
