#include "apps/engine/mujoco/model_meshes.hpp"

#include "apps/engine/mujoco/mesh_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace halflit::engine::mujoco {
namespace {

constexpr int kPlaneGrid = 200;                                     // lines of a plane's grid at most
constexpr std::int64_t kMostCorners = std::int64_t{1} << 26;        // of all triangles, each vertex counted where it is used
constexpr std::int64_t kMostFlexTriangles = std::int64_t{1} << 22;  // which no array of the model stands behind
constexpr double kLeast = 1e-15;                                    // mjMINVAL
constexpr float kFlatNormal = 1e-10f;                               // a triangle of a smaller normal has +z

/// Takes corners from what a model may still have.
Result<void> take(std::int64_t& left, std::int64_t corners) {
    left = corners <= left ? left - corners : -1;
    if (left >= 0) return {};
    return fail(ErrorCode::limit, fmt::format("the model has more than {} corners of triangles", kMostCorners));
}

Vec3f vec3(const float* v) { return {v[0], v[1], v[2]}; }

Vec3f face_normal(Vec3f a, Vec3f b, Vec3f c) {
    const Vec3f n = cross(b - a, c - a);
    const float size = length(n);
    return size < kFlatNormal ? Vec3f{0, 0, 1} : n * (1.0f / size);
}

/// Lines of a plane's grid along an axis. A plane without a size along it is infinite: it reaches beyond the sky.
std::vector<float> grid_lines(const Model& model, int geom, int axis) {
    std::vector<float> lines;
    const double size = model.geom_size[3 * geom + axis];
    const auto add = [&](double x) { lines.push_back(static_cast<float>(x)); };
    if (size > 0) {
        const double cell = std::max(model.geom_size[3 * geom + 2], size / (kPlaneGrid - 2));
        const double cells = std::floor(size / std::max(kLeast, cell));
        const int whole = cells < kPlaneGrid ? static_cast<int>(cells) / 2 * 2 : 0;  // 0 for NaN too
        const double pad = size - whole * cell;
        add(-size);
        for (int x = 0; x <= whole; ++x) add(-size + pad + x * cell * 2);
        const double last = -size + pad + whole * cell * 2;
        add(std::max(last, last + pad));
        return lines;
    }
    const double far = static_cast<double>(model.zfar) * model.extent;
    const int material = model.geom_matid[geom];
    const float repeat = material < 0 ? 0.0f : model.mat_texrepeat[2 * material + axis];
    const double period = repeat > 0 ? static_cast<double>(2 / repeat) : 2.1 * far / (kPlaneGrid - 2);
    const double step = (2.1 * far + 2 * period) / kPlaneGrid;
    for (int x = 0; x <= kPlaneGrid; ++x) add(step * x - step * (kPlaneGrid / 2));
    return lines;
}

Mesh plane_mesh(const std::vector<float>& x, const std::vector<float>& y) {
    const auto corner = [&](std::size_t i, std::size_t j) { return Corner{{x[i], y[j], 0}, {0, 0, 1}}; };
    MeshBuilder builder;
    for (std::size_t i = 0; i + 1 < x.size(); ++i)
        for (std::size_t j = 0; j + 1 < y.size(); ++j) builder.quad(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
    return builder.take();
}

/// Arrays of one mesh, whose ranges are checked.
struct MeshArrays {
    const float *positions, *normals, *uv;  ///< uv: null without texture coordinates
    std::int64_t position_count, normal_count, uv_count;
};

/// Adds a face by the indices of its corners. `flat`: the face's normal. Otherwise the vertices' normals, but that of the face where a
/// mesh without texture coordinates bends by more than acos(0.8).
Result<void> add_face(MeshBuilder& builder, const MeshArrays& of, const std::int32_t* p, const std::int32_t* n, const std::int32_t* t,
                      bool flat, const std::string& what) {
    for (int k = 0; k < 3; ++k)
        if (p[k] < 0 || p[k] >= of.position_count || (!flat && (n[k] < 0 || n[k] >= of.normal_count)) ||
            (of.uv != nullptr && (t[k] < 0 || t[k] >= of.uv_count)))
            return fail(ErrorCode::bad_input, what + ": a face has an index out of range");
    Corner corners[3];
    for (int k = 0; k < 3; ++k) corners[k].position = vec3(of.positions + 3 * std::int64_t{p[k]});
    const Vec3f normal = face_normal(corners[0].position, corners[1].position, corners[2].position);
    for (int k = 0; k < 3; ++k) {
        const Vec3f own = flat ? normal : vec3(of.normals + 3 * std::int64_t{n[k]});
        const bool bends = of.uv == nullptr && static_cast<double>(dot(own, normal)) < 0.8;
        corners[k].normal = bends ? normal : own;
        if (of.uv != nullptr) corners[k].uv = {of.uv[2 * std::int64_t{t[k]}], of.uv[2 * std::int64_t{t[k]} + 1]};
    }
    builder.triangle(corners[0], corners[1], corners[2]);
    return {};
}

/// A mesh and its hull, which is empty where it has none.
Result<void> add_mesh(const Model& model, int i, std::int64_t& left, std::vector<Mesh>& to) {
    const std::string what = fmt::format("mesh {}", i);
    const std::int64_t vertex = model.mesh_vertadr[i], face = model.mesh_faceadr[i], faces = model.mesh_facenum[i];
    const std::int64_t normal = model.mesh_normaladr != nullptr ? model.mesh_normaladr[i] : vertex;
    const std::int64_t uv = model.mesh_texcoordadr[i], graph = model.mesh_graphadr[i];
    if (auto ok = check_range(vertex, model.mesh_vertnum[i], static_cast<std::uint64_t>(model.nmeshvert), what + ": vertices"); !ok)
        return ok;
    if (auto ok = check_range(face, faces, static_cast<std::uint64_t>(model.nmeshface), what + ": faces"); !ok) return ok;
    if (auto ok = check_range(normal, 0, static_cast<std::uint64_t>(model.nmeshnormal), what + ": normals"); !ok) return ok;
    if (uv >= 0)
        if (auto ok = check_range(uv, 0, static_cast<std::uint64_t>(model.nmeshtexcoord), what + ": texture coordinates"); !ok) return ok;
    const MeshArrays arrays{model.mesh_vert + 3 * vertex,
                            model.nmeshnormal > 0 ? model.mesh_normal + 3 * normal : nullptr,
                            uv >= 0 ? model.mesh_texcoord + 2 * uv : nullptr,
                            model.mesh_vertnum[i],
                            model.nmeshnormal - normal,
                            uv >= 0 ? model.nmeshtexcoord - uv : 0};
    const auto corners = [&](const std::int32_t* own, std::int64_t f) { return (own != nullptr ? own : model.mesh_face) + 3 * f; };
    if (auto ok = take(left, 3 * faces); !ok) return ok;
    MeshBuilder surface(uv >= 0), hull(uv >= 0);
    for (std::int64_t f = face; f < face + faces; ++f)
        if (auto ok = add_face(surface, arrays, corners(nullptr, f), corners(model.mesh_facenormal, f), corners(model.mesh_facetexcoord, f),
                               false, what);
            !ok)
            return ok;
    if (graph >= 0) {
        const auto size = static_cast<std::uint64_t>(model.nmeshgraph);
        if (auto ok = check_range(graph, 2, size, what + ": convex hull"); !ok) return ok;
        // The counts, then two numbers for each vertex and one more for each edge, of which there are as many as vertices and three a face.
        const std::int64_t vertices = model.mesh_graph[graph], hull_faces = model.mesh_graph[graph + 1];
        const std::int64_t first = graph + 2 + 3 * vertices + 3 * hull_faces;
        if (vertices < 0 || hull_faces < 0) return fail(ErrorCode::bad_input, what + ": convex hull: a negative count");
        if (auto ok = check_range(first, 3 * hull_faces, size, what + ": convex hull"); !ok) return ok;
        if (auto ok = take(left, 3 * hull_faces); !ok) return ok;
        // Hulls of meshes with texture coordinates of their own indices have none.
        MeshArrays of_hull = arrays;
        if (model.mesh_facetexcoord != nullptr) of_hull.uv = nullptr, hull = MeshBuilder();
        for (std::int64_t f = 0; f < hull_faces; ++f) {
            const std::int32_t* p = model.mesh_graph + first + 3 * f;
            if (auto ok = add_face(hull, of_hull, p, p, p, true, what + ": convex hull"); !ok) return ok;
        }
    }
    to.push_back(surface.take());
    to.push_back(hull.take());
    return {};
}

Result<Mesh> hfield_mesh(const Model& model, int i, std::int64_t& left) {
    const std::int64_t rows = model.hfield_nrow[i], columns = model.hfield_ncol[i];
    const std::string what = fmt::format("height field {}", i);
    if (rows < 2 || columns < 2 || rows > 32768 || columns > 32768)
        return fail(ErrorCode::bad_input, what + ": expected 2 to 32768 rows and columns");
    if (auto ok = check_range(model.hfield_adr[i], rows * columns, static_cast<std::uint64_t>(model.nhfielddata), what); !ok)
        return tl::unexpected<Error>(ok.error());
    if (auto ok = take(left, 6 * (rows * columns + model.numquads * model.numquads)); !ok) return tl::unexpected<Error>(ok.error());
    const float* data = model.hfield_data + model.hfield_adr[i];
    float size[4];
    for (int k = 0; k < 4; ++k) size[k] = static_cast<float>(model.hfield_size[4 * i + k]);
    const auto grid = [](float half, std::int64_t k, std::int64_t last) {
        return half * (static_cast<float>(k) / (0.5f * static_cast<float>(last)) - 1.0f);
    };
    const auto x = [&](std::int64_t c) { return grid(size[0], c, columns - 1); };
    const auto y = [&](std::int64_t r) { return grid(size[1], r, rows - 1); };
    const auto top = [&](std::int64_t c, std::int64_t r) { return Vec3f{x(c), y(r), data[r * columns + c] * size[2]}; };
    const auto below = [&](Vec3f p) { return Vec3f{p.x, p.y, -size[3]}; };

    MeshBuilder builder;
    const auto flat = [&](Vec3f a, Vec3f b, Vec3f c) {
        const Vec3f n = face_normal(a, b, c);
        builder.triangle({a, n}, {b, n}, {c, n});
    };
    for (std::int64_t r = 0; r + 1 < rows; ++r)
        for (std::int64_t c = 0; c + 1 < columns; ++c) {
            flat(top(c, r + 1), top(c, r), top(c + 1, r + 1));
            flat(top(c, r), top(c + 1, r), top(c + 1, r + 1));
        }
    const auto wall = [&](Vec3f a, Vec3f b, Vec3f n) { builder.quad({below(a), n}, {below(b), n}, {b, n}, {a, n}); };
    for (std::int64_t r = 0; r + 1 < rows; ++r) {
        wall(top(0, r + 1), top(0, r), {-1, 0, 0});
        wall(top(columns - 1, r), top(columns - 1, r + 1), {1, 0, 0});
    }
    for (std::int64_t c = 0; c + 1 < columns; ++c) {
        wall(top(c, 0), top(c + 1, 0), {0, -1, 0});
        wall(top(c + 1, rows - 1), top(c, rows - 1), {0, 1, 0});
    }
    const int quads = model.numquads;
    const auto floor = [&](int c, int r) { return Corner{{grid(size[0], c, quads), grid(size[1], r, quads), -size[3]}, {0, 0, -1}}; };
    for (int r = 0; r < quads; ++r)
        for (int c = 0; c < quads; ++c) builder.quad(floor(c, r), floor(c, r + 1), floor(c + 1, r + 1), floor(c + 1, r));
    return builder.take();
}

/// A mesh whose vertices come with each scene.
Mesh soft_mesh(std::int64_t count) {
    Mesh mesh;
    mesh.positions.resize(static_cast<std::size_t>(count));
    mesh.normals.resize(mesh.positions.size(), {0, 0, 1});
    return mesh;
}

Result<void> add_skin(const Model& model, int i, std::int64_t& left, ModelMeshes& to) {
    const std::string what = fmt::format("skin {}", i);
    const std::int64_t count = model.skin_vertnum[i], face = model.skin_faceadr[i], faces = model.skin_facenum[i],
                       uv = model.skin_texcoordadr[i];
    if (auto ok = check_range(model.skin_vertadr[i], count, static_cast<std::uint64_t>(model.nskinvert), what + ": vertices"); !ok)
        return ok;
    if (auto ok = check_range(face, faces, static_cast<std::uint64_t>(model.nskinface), what + ": faces"); !ok) return ok;
    if (uv >= 0)
        if (auto ok = check_range(uv, count, static_cast<std::uint64_t>(model.nskintexvert), what + ": texture coordinates"); !ok)
            return ok;
    if (auto ok = take(left, count + 3 * faces); !ok) return ok;
    Mesh mesh = soft_mesh(count);
    for (const std::int32_t* index = model.skin_face + 3 * face; index < model.skin_face + 3 * (face + faces); ++index) {
        if (*index < 0 || *index >= count) return fail(ErrorCode::bad_input, what + ": a face has an index out of range");
        mesh.indices.push_back(static_cast<std::uint32_t>(*index));
    }
    if (uv >= 0)
        for (std::int64_t k = 0; k < count; ++k)
            mesh.uv0.push_back({model.skin_texcoord[2 * (uv + k)], model.skin_texcoord[2 * (uv + k) + 1]});
    to.soft.push_back({model.skin_vertadr[i], count});
    to.meshes.push_back(std::move(mesh));
    return {};
}

Result<void> add_flexes(const Model& model, ModelMeshes& to) {
    std::int64_t first = 0;
    for (int i = 0; i < model.nflex; ++i) {
        const std::int64_t count = model.flex_facenum[i];
        if (count < 0) return fail(ErrorCode::bad_input, fmt::format("flex {}: {} triangles", i, count));
        if (count > kMostFlexTriangles - first)
            return fail(ErrorCode::limit, fmt::format("the flexes have more than {} triangles", kMostFlexTriangles));
        Mesh mesh = soft_mesh(3 * count);
        for (std::uint32_t k = 0; k < 3 * count; ++k) mesh.indices.push_back(k);
        to.soft.push_back({first, count});
        to.meshes.push_back(std::move(mesh));
        first += count;
    }
    return {};
}

}  // namespace

Result<ModelMeshes> make_meshes(const Model& model, bool shapes_have_uv) {
    ModelMeshes made;
    const auto here = [&] { return static_cast<int>(made.meshes.size()); };
    const Vec3f haze{model.haze_rgba[0], model.haze_rgba[1], model.haze_rgba[2]};
    const bool has_uv = shapes_have_uv && std::find(model.tex_type, model.tex_type + model.ntex, 0) != model.tex_type + model.ntex;
    const Fineness fineness{model.numslices, model.numstacks, model.numquads, model.haze, haze, has_uv};
    for (int shape = 0; shape < static_cast<int>(Shape::count); ++shape) made.meshes.push_back(make_shape(Shape{shape}, fineness));
    std::int64_t left = kMostCorners;
    std::map<std::pair<std::vector<float>, std::vector<float>>, int> grids;
    for (int i = 0; i < model.ngeom; ++i) {
        if (model.geom_type[i] != kPlane) continue;
        if (model.geom_matid[i] >= model.nmat)
            return fail(ErrorCode::bad_input, fmt::format("geom_matid: {} of {} materials", model.geom_matid[i], model.nmat));
        std::vector<float> lines[2] = {grid_lines(model, i, 0), grid_lines(model, i, 1)};
        for (const std::vector<float>& along : lines)
            if (!std::all_of(along.begin(), along.end(), [](float at) { return std::isfinite(at); }))
                return fail(ErrorCode::bad_input, fmt::format("geom {}: the grid of the plane is not finite", i));
        const auto [grid, is_new] = grids.try_emplace({std::move(lines[0]), std::move(lines[1])}, here());
        const auto& [x, y] = grid->first;
        made.planes.push_back(grid->second);
        if (!is_new) continue;
        if (auto ok = take(left, 6 * static_cast<std::int64_t>(x.size() * y.size())); !ok) return tl::unexpected<Error>(ok.error());
        made.meshes.push_back(plane_mesh(x, y));
    }
    made.models = here();
    for (int i = 0; i < model.nmesh; ++i)
        if (auto ok = add_mesh(model, i, left, made.meshes); !ok) return tl::unexpected<Error>(ok.error());
    made.hfields = here();
    for (int i = 0; i < model.nhfield; ++i) {
        auto mesh = hfield_mesh(model, i, left);
        if (!mesh) return tl::unexpected<Error>(mesh.error());
        made.meshes.push_back(std::move(*mesh));
    }
    made.skins = here();
    for (int i = 0; i < model.nskin; ++i)
        if (auto ok = add_skin(model, i, left, made); !ok) return tl::unexpected<Error>(ok.error());
    made.flexes = here();
    if (auto ok = add_flexes(model, made); !ok) return tl::unexpected<Error>(ok.error());
    made.end = here();
    return made;
}

Result<std::vector<CodeTexture>> make_textures(const Model& model, const Look& look) {
    constexpr int kLargest = 16384, kSrgb = 2;
    constexpr std::int64_t kMostTexels = std::int64_t{1} << 27;  // in all; several textures may name the same bytes
    std::int64_t sum = 0;
    std::vector<CodeTexture> made;
    for (int i = 0; i < model.ntex; ++i) {
        const std::string what = fmt::format("texture {}", i);
        const int width = model.tex_width[i], height = model.tex_height[i],
                  channels = model.tex_nchannel != nullptr ? model.tex_nchannel[i] : 3;
        const bool cube = model.tex_type[i] != 0, six = cube && width != height;
        if (width < 1 || height < 1 || channels < 1 || channels > 4)
            return fail(ErrorCode::bad_input, fmt::format("{}: {} x {} texels of {} channels", what, width, height, channels));
        if (width > kLargest || height > kLargest * (six ? 6 : 1))
            return fail(ErrorCode::limit, fmt::format("{}: {} x {} texels, expected at most {}", what, width, height, kLargest));
        const std::int64_t rows = cube ? std::int64_t{width} * (six ? 6 : 1) : height, texels = rows * width;
        if (auto ok = check_range(model.tex_adr[i], texels * channels, model.ntexdata, what); !ok) return tl::unexpected<Error>(ok.error());
        sum += cube && !six ? 6 * texels : texels;
        if (sum > kMostTexels) return fail(ErrorCode::limit, fmt::format("{}: more than 2^27 texels with those before it", what));
        const std::uint8_t* from = model.tex_data + model.tex_adr[i];
        CodeTexture texture{width,
                            cube ? width : height,
                            cube,
                            look.decodes_srgb && model.tex_colorspace != nullptr && model.tex_colorspace[i] == kSrgb,
                            {}};
        texture.rgb.reserve(static_cast<std::size_t>(3 * texels));
        for (std::int64_t k = 0; k < texels; ++k, from += channels)
            for (int c = 0; c < 3; ++c) texture.rgb.push_back(c < channels ? from[c] : channels == 1 ? from[0] : 0);
        const std::vector<std::uint8_t> face = texture.rgb;
        for (int copy = 1; cube && !six && copy < 6; ++copy) texture.rgb.insert(texture.rgb.end(), face.begin(), face.end());
        made.push_back(std::move(texture));
    }
    return made;
}

}  // namespace halflit::engine::mujoco
