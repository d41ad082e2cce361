#include "apps/io/models/mtl.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/models/text_scanner.hpp"
#include "apps/io/pictures/picture_reader.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

namespace halflit::io::detail {

namespace {

std::optional<double> next_number(TextScanner& words) {
    double value = 0;
    if (!words.take_number(value) || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// "r g b", or "r" for three equal ones. "spectral" and "xyz" are not read.
std::optional<std::array<double, 3>> read_color(TextScanner& words) {
    const auto r = next_number(words);
    if (!r) return std::nullopt;
    const auto g = next_number(words), b = next_number(words);
    return std::array{*r, g.value_or(*r), b.value_or(g.value_or(*r))};
}

/// The values of -o, -s or -t: one to three numbers, of which a picture uses two.
void read_pair(TextScanner& words, std::array<double, 2>& pair) {
    for (std::size_t i = 0; i < 3; ++i) {
        const auto value = next_number(words);
        if (!value) return;
        if (i < 2) pair[i] = std::clamp(*value, -1e6, 1e6);
    }
}

MtlTexture read_texture(TextScanner& words) {
    constexpr std::string_view kOneWord[] = {"-blendu", "-blendv", "-cc", "-texres", "-boost", "-imfchan", "-type"};
    MtlTexture texture;
    std::array<double, 2> ignored{};
    for (;;) {
        const std::string_view option = words.next_in_line();
        const bool has_one = std::find(std::begin(kOneWord), std::end(kOneWord), option) != std::end(kOneWord);
        if (!has_one && option != "-o" && option != "-s" && option != "-t" && option != "-mm" && option != "-bm" && option != "-clamp")
            break;
        words.word_in_line();
        if (option == "-o") {
            read_pair(words, texture.offset);
        } else if (option == "-s") {
            read_pair(words, texture.scale);
        } else if (option == "-t") {
            read_pair(words, ignored);
        } else if (option == "-bm") {
            texture.bump = std::clamp(next_number(words).value_or(1.0), -1e6, 1e6);
        } else {
            const std::string_view value = words.word_in_line();
            if (option == "-mm") words.word_in_line();
            if (option == "-clamp") texture.clamp = same_word(value, "on");
        }
    }
    std::string_view name = words.rest_of_line(true);
    const std::string_view before = name.substr(0, name.find(" #"));
    if (is_picture_name(Words(before).rest())) name = Words(before).rest();  // a comment behind it
    texture.file = unquoted(name);
    // Pictures of several tiles, as Mari and Mudbox number them: the first is the square from 0 to 1.
    for (const auto& [mark, first] : {std::pair("<UDIM>", "1001"), {"<udim>", "1001"}, {"<UVTILE>", "u1_v1"}, {"<uvtile>", "u1_v1"}})
        if (const std::size_t at = texture.file.find(mark); at != std::string::npos) {
            texture.file.replace(at, std::string_view(mark).size(), first);
            texture.is_tile = true;
        }
    return texture;
}

template <class Value>
struct Statement {
    std::string_view name;
    Value MtlMaterial::*value;
};
constexpr Statement<std::optional<std::array<double, 3>>> kColors[] = {
    {"kd", &MtlMaterial::kd}, {"ks", &MtlMaterial::ks}, {"ke", &MtlMaterial::ke}};
constexpr Statement<std::optional<double>> kNumbers[] = {
    {"ns", &MtlMaterial::ns}, {"d", &MtlMaterial::d}, {"tr", &MtlMaterial::tr}, {"pr", &MtlMaterial::pr}, {"pm", &MtlMaterial::pm}};
constexpr Statement<MtlTexture> kMaps[] = {
    {"map_ka", &MtlMaterial::map_ka}, {"map_kd", &MtlMaterial::map_kd}, {"map_ks", &MtlMaterial::map_ks}, {"map_pr", &MtlMaterial::map_pr},
    {"map_pm", &MtlMaterial::map_pm}, {"map_ke", &MtlMaterial::map_ke}, {"map_d", &MtlMaterial::map_d},   {"map_bump", &MtlMaterial::bump},
    {"bump", &MtlMaterial::bump},     {"norm", &MtlMaterial::norm},     {"map_kn", &MtlMaterial::norm}};
/// Ka says how much of the light from around is returned, which the base colour does; illum is the model of a renderer.
constexpr std::string_view kNotUsed[] = {"ka", "illum", "ni", "tf", "sharpness"};
template <class Table>
auto find_statement(const Table& table, std::string_view word) {
    const auto row = std::find_if(std::begin(table), std::end(table), [&](const auto& one) { return same_word(word, one.name); });
    return row == std::end(table) ? nullptr : &*row;
}
void note_not_drawn(std::string_view word, TextScanner& words, MtlMaterial& m) {
    if (m.not_drawn.size() < 8) m.not_drawn.push_back(printable(word, 20));
    if (std::string file = read_texture(words).file; is_picture_name(file)) m.other_pictures.push_back(std::move(file));
}

/// A statement of a material. False: MTL has none of this name.
bool read_statement(std::string_view word, TextScanner& words, MtlMaterial& m) {
    bool is_read = true;  // "Kd spectral file.rfl", or no value: it is not
    if (const auto* color = find_statement(kColors, word)) {
        const auto value = read_color(words);
        is_read = value.has_value();
        if (is_read) m.*color->value = value;
    } else if (const auto* number = find_statement(kNumbers, word)) {
        if (words.next_in_line() == "-halo") words.word_in_line();
        const auto value = next_number(words);
        is_read = value.has_value();
        if (is_read) m.*number->value = value;
    } else if (const auto* map = find_statement(kMaps, word)) {
        m.*map->value = read_texture(words);
        is_read = !(m.*map->value).file.empty();
    } else if (std::none_of(std::begin(kNotUsed), std::end(kNotUsed), [&](std::string_view one) { return same_word(word, one); })) {
        return false;
    }
    if (!is_read) note_not_drawn(word, words, m);
    return true;
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
        for (const auto& row : kMaps)
            if ((from_.*row.value).is_tile)
                builder_.document().warn(fmt::format("material \"{}\": of its picture's tiles the first alone is drawn: {}",
                                                     printable(m.name, 80), printable((from_.*row.value).file, 120)));
        std::vector<std::string> not_drawn = from_.not_drawn;
        for (const auto& [key, map, drawn] : {std::tuple("map_Ka", &from_.map_ka, from_.map_ka.file == from_.map_kd.file),
                                              {"map_Ks", &from_.map_ks, m.textures[TextureSlot::specular_color].used()},
                                              {"map_Bump", &from_.bump, from_.norm.file.empty() || from_.norm.file == from_.bump.file}})
            if (!map->file.empty() && !drawn) not_drawn.emplace_back(key);
        if (!not_drawn.empty())
            builder_.document().warn(fmt::format("material \"{}\": not drawn: {}", printable(m.name, 80), fmt::join(not_drawn, ", ")));
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
        if (std::max({kd[0], kd[1], kd[2]}) > 2.0)  // codes
            for (double& channel : kd) channel /= 255.0;
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

std::string_view unquoted(std::string_view name) {
    if (name.size() >= 2 && name.front() == '"' && name.back() == '"') return name.substr(1, name.size() - 2);
    return name;
}

bool MtlText::take(std::string_view word, TextScanner& scanner) {
    if (same_word(word, "newmtl")) {
        const std::string_view name = unquoted(scanner.rest_of_line(true));
        builder_.document().geometry.take(sizeof(MtlMaterial) + name.size());
        materials_.emplace_back().name = name;
        at_ = materials_.size() - 1;
        return true;
    }
    if (!at_) return false;
    builder_.document().geometry.take(scanner.rest_size());
    return read_statement(word, scanner, materials_[*at_]);
}

void add_pictures(const MtlMaterial& material, ModelBuilder& builder) {
    for (const auto& row : kMaps)
        if (const std::string& file = (material.*row.value).file; !file.empty()) builder.add_file(file);
    for (const std::string& file : material.other_pictures) builder.add_file(file);
}

void read_mtl(std::string_view text, const std::string& name, ModelBuilder& builder, std::vector<MtlMaterial>& materials) {
    TextScanner scanner(text, builder.document(), name + ": ", true);
    MtlText reader(builder, materials);
    for (std::string_view word = scanner.word(); !word.empty(); word = scanner.word()) {
        if (!reader.take(word, scanner)) {
            if (MtlMaterial* const material = reader.material())
                note_not_drawn(word, scanner, *material);
            else
                scanner.unknown(word, "newmtl");
        }
        scanner.skip_line();
    }
    scanner.warn();
}

int make_material(const MtlMaterial& from, ModelBuilder& builder, MtlPictures& pictures) {
    return MaterialOfMtl(from, builder, pictures).make();
}

}  // namespace halflit::io::detail
