// halflit-import-cad: a STEP, IGES or BREP file on standard input becomes glTF (GLB) on standard output. docs/formats.md#importers says how
// importers are called.
#include "apps/import_cad/cad_document.hpp"

#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <iterator>
#include <limits>
#include <new>

namespace halflit::cad {
namespace {

using nlohmann::json;

enum Exit { kDrawn = 0, kUsage = 2, kBadInput = 3, kIo = 4, kLimit = 5 };

void put_u32(std::string& out, std::uint32_t x) {
    for (int i = 0; i < 4; ++i) out += static_cast<char>(x >> (8 * i) & 0xFF);
}

class GlbWriter {
public:
    /// The file's bytes.
    static std::string write(const Document& document) {
        GlbWriter writer;
        writer.json_["asset"] = {{"version", "2.0"}, {"generator", "halflit-import-cad"}};
        json& told = writer.json_["asset"]["extras"]["halflit"];
        for (const Measures& m : document.measures)
            for (const double x :
                 {double(m.node), m.box[0], m.box[1], m.box[2], m.box[3], m.box[4], m.box[5], m.area, m.volume, double(m.solids)})
                told["measures"].push_back(x);
        told["warnings"] = document.warnings;
        for (const Shape& shape : document.shapes) writer.add(shape);
        writer.add_nodes(document);
        return writer.file();
    }

private:
    void add(const Shape& shape) {
        json primitives = json::array();
        for (const Patch& patch : shape.patches) {
            if (patch.indices.empty()) continue;
            json primitive;
            primitive["attributes"]["POSITION"] = floats(patch.positions, "VEC3", true);
            if (patch.is_lines) {
                primitive["mode"] = 1;
            } else {
                primitive["attributes"]["NORMAL"] = floats(patch.normals, "VEC3", false);
                primitive["attributes"]["_FACE"] = floats(patch.faces, "SCALAR", false);
            }
            primitive["indices"] = accessor(view(patch.indices, 34963), 5125, patch.indices.size(), "SCALAR");
            primitive["material"] = material(patch.color);
            primitives.push_back(std::move(primitive));
        }
        mesh_of_shape_.push_back(primitives.empty() ? -1 : static_cast<int>(json_["meshes"].size()));
        if (primitives.empty()) return;
        json mesh = {{"primitives", std::move(primitives)}};
        if (!shape.name.empty()) mesh["name"] = shape.name;
        json_["meshes"].push_back(std::move(mesh));
    }

    void add_nodes(const Document& document) {
        json nodes = json::array(), roots = json::array();
        for (const Node& node : document.nodes) {
            json made = json::object();
            if (!node.name.empty()) made["name"] = node.name;
            if (node.shape >= 0 && mesh_of_shape_[static_cast<std::size_t>(node.shape)] >= 0)
                made["mesh"] = mesh_of_shape_[static_cast<std::size_t>(node.shape)];
            if (!node.parent_from_node.IsIdentity()) {
                const gp_Trsf t = node.parent_from_node.Transformation();
                json matrix = json::array();
                bool is_finite = true;
                for (int column = 1; column <= 4; ++column)
                    for (int row = 1; row <= 4; ++row) {
                        matrix.push_back(row == 4 ? (column == 4 ? 1.0 : 0.0) : t.Value(row, column));
                        is_finite = is_finite && std::isfinite(matrix.back().get<double>());
                    }
                if (is_finite) {
                    made["matrix"] = std::move(matrix);
                } else {
                    json_["asset"]["extras"]["halflit"]["warnings"].push_back("a part's place is not finite, it is drawn at the origin");
                }
            }
            if (node.parent < 0) {
                roots.push_back(nodes.size());
            } else {
                nodes[static_cast<std::size_t>(node.parent)]["children"].push_back(nodes.size());
            }
            nodes.push_back(std::move(made));
        }
        if (nodes.empty()) return;
        json_["nodes"] = std::move(nodes);
        json_["scenes"] = {{{"nodes", std::move(roots)}}};
        json_["scene"] = 0;
    }

    /// As halflit has it for formats without materials. Shells of surfaces are seen from both sides.
    int material(const std::optional<std::array<float, 4>>& color) {
        constexpr std::array<float, 4> kGrey = {0.5f, 0.5f, 0.5f, 1.0f};
        json& all = json_["materials"];
        json made = {{"doubleSided", true},
                     {"pbrMetallicRoughness",
                      {{"baseColorFactor", color.value_or(kGrey)}, {"metallicFactor", 0}, {"roughnessFactor", color ? 0.6 : 0.4}}}};
        if (color && (*color)[3] < 1.0f) made["alphaMode"] = "BLEND";
        for (std::size_t i = 0; i < all.size(); ++i)
            if (all[i] == made) return static_cast<int>(i);
        all.push_back(std::move(made));
        return static_cast<int>(all.size()) - 1;
    }

    int floats(const std::vector<float>& values, const char* type, bool with_bounds) {
        const std::size_t width = std::strcmp(type, "VEC3") == 0 ? 3 : 1;
        const int index = accessor(view(values, 34962), 5126, values.size() / width, type);
        if (!with_bounds) return index;
        json& made = json_["accessors"].back();
        for (std::size_t k = 0; k < width; ++k) {
            float least = std::numeric_limits<float>::max(), most = -least;
            for (std::size_t i = k; i < values.size(); i += width) least = std::min(least, values[i]), most = std::max(most, values[i]);
            made["min"].push_back(least);
            made["max"].push_back(most);
        }
        return index;
    }

    int accessor(int view, int component, std::size_t count, const char* type) {
        json_["accessors"].push_back({{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
        return static_cast<int>(json_["accessors"].size()) - 1;
    }

    template <class T>
    int view(const std::vector<T>& values, int target) {
        json_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", 4 * values.size()}, {"target", target}});
        for (const T value : values) put_u32(bytes_, std::bit_cast<std::uint32_t>(value));
        return static_cast<int>(json_["bufferViews"].size()) - 1;
    }

    std::string file() {
        if (!bytes_.empty()) json_["buffers"] = {{{"byteLength", bytes_.size()}}};
        std::string text = json_.dump(-1, ' ', false, json::error_handler_t::replace);
        text.resize((text.size() + 3) & ~std::size_t{3}, ' ');
        const std::size_t size = 12 + 8 + text.size() + (bytes_.empty() ? 0 : 8 + bytes_.size());
        if (size > std::numeric_limits<std::uint32_t>::max()) throw std::bad_alloc();
        std::string out;
        out.reserve(size);
        out += "glTF";
        put_u32(out, 2);
        put_u32(out, static_cast<std::uint32_t>(size));
        put_u32(out, static_cast<std::uint32_t>(text.size()));
        out += "JSON" + text;
        if (!bytes_.empty()) {
            put_u32(out, static_cast<std::uint32_t>(bytes_.size()));
            out.append("BIN\0", 4);
            out += bytes_;
        }
        return out;
    }

    json json_;
    std::string bytes_;
    std::vector<int> mesh_of_shape_;
};

int fail(Exit code, const std::string& message) {
    std::cerr << message << '\n';
    return code;
}

int run(int argc, char** argv, std::FILE* out) {
    const bool measure = argc == 5 && std::string_view(argv[4]) == "--measure";
    if ((argc != 4 && !measure) || std::string_view(argv[1]) != "1" || std::string_view(argv[2]) != "--pixels")
        return fail(kUsage, "usage: halflit-import-cad 1 --pixels N [--measure] < model.step > model.glb");
    const double pixels = std::atof(argv[3]);
    if (!(pixels >= 1.0 && pixels <= 1e6)) return fail(kUsage, "--pixels: expected 1 to 1e6");
    std::string bytes;
    char part[65536];
    for (std::size_t n = 0; (n = std::fread(part, 1, sizeof part, stdin)) > 0;) bytes.append(part, n);
    if (std::ferror(stdin) != 0) return fail(kIo, "the model cannot be read");
    const auto format = find_format(bytes);
    if (!format) return fail(kBadInput, "is neither STEP, IGES nor BREP");
    const Document document = read_document(bytes, *format, pixels, measure);
    const std::string file = GlbWriter::write(document);
    const bool written = std::fwrite(file.data(), 1, file.size(), out) == file.size() && std::fflush(out) == 0;
    return written ? kDrawn : fail(kIo, "the result cannot be written");
}

/// The exit code for the exception that is handled, with its reason told.
int fail_as_caught() {
    try {
        throw;
    } catch (const Refused& refused) {
        return fail(kBadInput, refused.what());
    } catch (const Standard_OutOfMemory&) {
        return fail(kLimit, "out of memory");
    } catch (const std::bad_alloc&) {
        return fail(kLimit, "out of memory");
    } catch (const Standard_Failure& failure) {
        return fail(kBadInput, std::string("OpenCASCADE: ") + failure.DynamicType()->Name() + ' ' + failure.GetMessageString());
    } catch (const std::exception& error) {
        return fail(kBadInput, error.what());
    }
}

}  // namespace
}  // namespace halflit::cad

int main(int argc, char** argv) {
    using namespace halflit::cad;
    std::set_terminate([] { std::_Exit(fail_as_caught()); });  // the library throws where nothing may be thrown
    std::FILE* const out = ::fdopen(::dup(1), "wb");           // and writes messages to standard output
    if (out == nullptr || ::dup2(2, 1) < 0) return fail(kIo, "there is no standard output");
    try {
        return run(argc, argv, out);
    } catch (...) {
        return fail_as_caught();
    }
}
