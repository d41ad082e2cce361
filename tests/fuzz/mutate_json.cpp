// Mutations of JSON nodes. The order of an object's members is kept.
#include "shading/material_properties.hpp"
#include "tests/fuzz/gltf_words.hpp"
#include "tests/fuzz/mutate.hpp"
#include "tests/support/base64.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace halflit::fuzz {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMaxDepth = 100;  ///< of JSON that is parsed here: the library that does it calls itself for each level
constexpr std::size_t kMaxNodes = 20000;
/// A string that stands for text that is no JSON value: kRaw TEXT kRaw.
constexpr std::string_view kRaw = "@raw@";

constexpr double kNumbers[] = {-1,
                               0,
                               1,
                               2,
                               3,
                               4,
                               5,
                               255,
                               256,
                               65535,
                               65536,
                               2147483647,
                               2147483648,
                               4294967295,
                               4294967296,
                               0.5,
                               3.5,
                               -0.5,
                               1e-3,
                               1e6,
                               1e30,
                               1e38,
                               1e39,
                               1e308,
                               1e-38,
                               1e-45,
                               1e-320,
                               -1e308,
                               0.1,
                               5120,
                               5121,
                               5122,
                               5123,
                               5125,
                               5126,
                               9728,
                               9987,
                               33071,
                               33648,
                               10497,
                               9007199254740993.0,
                               0x1p62,
                               0x1p63};
constexpr const char* kRawTexts[] = {
    "NaN", "1e999",       "-0",          "10.0",     "01", "1e", "9007199254740993", "18446744073709551615", "1.5e0", "2E+0", "-1e-999",
    "nul", "\"\\u0000\"", "\"\\ud800\"", "\"\xff\"", "",   ",",  "[[[[[[[["};

struct Place {
    Json* node;
    Json* parent;  ///< null for the root
};

void collect(Json& node, Json* parent, std::vector<Place>& places) {
    if (places.size() >= kMaxNodes) return;
    places.push_back({&node, parent});
    if (node.is_structured())
        for (Json& child : node) collect(child, &node, places);
}

std::vector<Place> places_of(Json& root) {
    std::vector<Place> places;
    collect(root, nullptr, places);
    return places;
}

/// Iterator of a parent's child. Those of objects know no arithmetic.
Json::iterator child(Json& parent, std::size_t at) {
    auto it = parent.begin();
    for (std::size_t i = 0; i < at; ++i) ++it;
    return it;
}

Json::iterator iterator_of(const Place& place) {
    auto it = place.parent->begin();
    while (&*it != place.node) ++it;
    return it;
}

Json raw(std::string_view text) { return std::string(kRaw) + std::string(text) + std::string(kRaw); }

Json new_value(Json& root, Random& random) {
    switch (random.below(7)) {
        case 0:
            return random.below(8);
        case 1:
            return random.pick(kNumbers);
        case 2:
            return random.pick(kWords);
        case 3:
            return Json::object();
        case 4:
            return Json::array();
        case 5:
            return raw(random.pick(kRawTexts));
        default: {
            auto places = places_of(root);
            return *random.pick(places).node;
        }
    }
}

void mutate_number(Json& number, std::size_t count, Random& random) {
    const double value = number.get<double>();
    switch (random.below(6)) {
        case 0:
            number = random.pick(kNumbers);
            break;
        case 1:
            number = raw(random.pick(kRawTexts));
            break;
        case 2:  // as an index or a length
            number = random.below(count + 2);
            break;
        case 3:
            number = value * (random.one_in(2) ? 0.5 : -2.0);
            break;
        default:
            if (value >= -1e9 && value <= 1e9) number = static_cast<std::int64_t>(value) + (random.one_in(2) ? 1 : -1);
    }
}

/// Mutates the contents of a data URI; replaces other strings.
void mutate_string(Json& text, std::size_t max_bytes, Random& random) {
    auto& value = text.get_ref<std::string&>();
    const std::size_t comma = value.find(";base64,");
    if (value.starts_with("data:") && comma != std::string::npos && !random.one_in(16)) {
        auto bytes = test::decode_base64(std::string_view(value).substr(comma + 8));
        if (bytes) {
            mutate_payload(*bytes, std::max(bytes->size(), max_bytes / 2), random);
            value = value.substr(0, comma + 8) + test::encode_base64(*bytes);
            return;
        }
    }
    if (!random.one_in(8)) {
        value = random.one_in(2) ? random.pick(kWords) : random.pick(kKeys);
        return;
    }
    Bytes bytes(value.begin(), value.end());
    mutate_bytes(bytes, bytes.size() + 8);
    value.assign(bytes.begin(), bytes.end());
}

void grow(Json& list, Random& random) {
    if (list.empty()) return;
    const Json last = random.pick(list);
    const std::size_t times = random.one_in(8) ? 64 : 1 + random.below(4);
    for (std::size_t i = 0; i < times; ++i) list.push_back(last);
}

/// Changes where a node hangs: deleted, repeated, swapped with a sibling, or under another key.
void mutate_place(Json& root, const Place& place, Random& random) {
    Json& parent = *place.parent;
    const auto it = iterator_of(place);
    switch (random.below(4)) {
        case 0:
            parent.erase(it);
            break;
        case 1:
            if (parent.is_array())
                parent.insert(it, Json(*place.node));
            else
                parent[random.pick(kKeys)] = Json(*place.node);
            break;
        case 2:
            std::swap(*it, *child(parent, random.below(parent.size())));
            break;
        default:
            if (parent.is_object()) {
                Json value = std::move(*it);
                parent.erase(it);
                parent[random.pick(kKeys)] = std::move(value);
            } else {
                Json value = new_value(root, random);
                parent.insert(it, std::move(value));
            }
    }
}

/// Gives a material a property of the table: a number, as many as it has or one more, or a texture.
void set_material_property(Json& root, Random& random) {
    const auto materials = root.find("materials");
    if (materials == root.end() || !materials->is_array() || materials->empty()) return;
    const bool texture = random.one_in(2);
    const shading::MaterialNumber& number = random.pick(shading::kMaterialNumbers);
    const std::string_view place = texture ? random.pick(shading::kTextureSlotInfos).gltf : number.gltf;
    Json* node = &random.pick(*materials);
    for (std::size_t at = 0; at < place.size();) {
        const std::size_t end = std::min(place.find('/', at), place.size());
        if (!node->is_object()) *node = Json::object();
        node = &(*node)[std::string(place.substr(at, end - at))];
        at = end + 1;
    }
    const auto value = [&] { return random.one_in(8) ? -1.0 : static_cast<double>(random.below(9)) / 4; };
    if (texture) {
        *node = Json{{"index", random.below(4)}, {"texCoord", random.below(3)}};
    } else if (number.count == 1) {
        *node = value();
    } else {
        *node = Json::array();
        const std::size_t count = static_cast<std::size_t>(number.count) + (random.one_in(8) ? 1 : 0);
        for (std::size_t c = 0; c < count; ++c) node->push_back(value());
    }
}

void mutate_node(Json& root, std::size_t max_bytes, Random& random) {
    if (root.is_object() && random.one_in(12)) return set_material_property(root, random);
    const auto places = places_of(root);
    const Place place = places[random.below(places.size())];
    Json& node = *place.node;
    if (place.parent != nullptr && random.one_in(4)) return mutate_place(root, place, random);
    if (random.one_in(12)) {  // a subtree from elsewhere
        const Json copy = *places[random.below(places.size())].node;
        node = copy;
        return;
    }
    if (node.is_number()) return mutate_number(node, places.size() < 8 ? places.size() : 8, random);
    if (node.is_string()) return mutate_string(node, max_bytes, random);
    if (node.is_boolean()) {
        node = !node.get<bool>();
    } else if (node.is_array()) {
        if (random.one_in(2))
            grow(node, random);
        else
            node.push_back(new_value(root, random));
    } else if (node.is_object()) {
        Json value = new_value(root, random);
        node[random.pick(kKeys)] = std::move(value);
    } else {
        node = new_value(root, random);
    }
}

/// Depth of brackets, without regard to strings.
int depth_of(View text) {
    int depth = 0, deepest = 0;
    for (const std::uint8_t c : text) {
        depth += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
        deepest = std::max(deepest, depth);
    }
    return deepest;
}

void replace_raw(std::string& text) {
    const std::string open = "\"" + std::string(kRaw), close = std::string(kRaw) + "\"";
    for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at)) {
        const std::size_t end = text.find(close, at + open.size());
        if (end == std::string::npos) return;
        std::string inside = text.substr(at + open.size(), end - at - open.size());
        for (std::size_t q = inside.find("\\\""); q != std::string::npos; q = inside.find("\\\"")) inside.erase(q, 1);
        for (std::size_t q = inside.find("\\\\"); q != std::string::npos; q = inside.find("\\\\", q + 1)) inside.erase(q, 1);
        text.replace(at, end + close.size() - at, inside);
        at += inside.size();
    }
}

}  // namespace

void mutate_gltf_json(Bytes& text, std::size_t max_bytes, Random& random) {
    if (random.one_in(16) || depth_of(text) > kMaxDepth) return mutate_bytes(text, max_bytes);
    Json root = Json::parse(text.begin(), text.end(), nullptr, false);
    if (root.is_discarded()) return mutate_bytes(text, max_bytes);
    const std::size_t times = 1 + random.below(random.one_in(4) ? 8 : 2);
    for (std::size_t i = 0; i < times; ++i) mutate_node(root, max_bytes, random);
    std::string out = root.dump(-1, ' ', false, Json::error_handler_t::ignore);
    replace_raw(out);
    if (out.size() > max_bytes) return mutate_bytes(text, max_bytes);
    text.assign(out.begin(), out.end());
}

void mutate_values(Bytes& values, Random& random) {
    static constexpr std::uint32_t kBits[] = {
        0,          0x80000000, 0x3f800000, 0xbf800000, 0x7fc00000, 0x7f800000, 0xff800000, 1,          2,          3,          0x00800000,
        0x7f7fffff, 0xff7fffff, 0xffffffff, 0x0000ffff, 0x000000ff, 0x501502f9, 0x01010101, 0x4b189680, 0xcb189680, 0x33d6bf95, 0x3f000000};
    if (values.empty()) return;
    if (random.one_in(4)) {
        const std::size_t size = values.size();
        mutate_bytes(values, size);
        values.resize(size);
        return;
    }
    const std::size_t times = 1 + random.below(4);
    for (std::size_t i = 0; i < times; ++i) {
        const std::size_t width = std::size_t{1} << random.below(3);
        if (values.size() < width) continue;
        const std::size_t at = random.below(values.size() / width) * width;
        const std::uint32_t bits = random.one_in(4) ? random.next() : random.pick(kBits);
        for (std::size_t k = 0; k < width; ++k) values[at + k] = static_cast<std::uint8_t>(bits >> (8 * k));
    }
}

}  // namespace halflit::fuzz
