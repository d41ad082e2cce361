// Meshes of a model of MuJoCo, and models that contradict themselves.
#include "apps/engine/mujoco/model_meshes.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

using namespace halflit;
using namespace halflit::engine::mujoco;

namespace {

/// A tetrahedron with its hull, a height field, a texture, an infinite plane, a skin and a flex.
struct SmallModel {
    std::int32_t zero[1] = {0}, one[1] = {1}, none[1] = {-1};
    std::int32_t four[1] = {4}, two[1] = {2}, three[1] = {3};
    double plane_size[3] = {0, 0, 1}, field_size[4] = {2, 1, 0.5, 0.25};
    float repeat[2] = {2, 4};
    float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    float normals[12] = {-0.6f, -0.6f, -0.53f, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    std::int32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    std::vector<std::int32_t> graph = std::vector<std::int32_t>(2 + 12 + 24);
    float heights[6] = {0, 1, 0, 0, 0.5f, 0};
    std::int64_t address[1] = {0};
    std::uint8_t texels[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    float coordinates[8] = {0, 0, 1, 0, 0, 1, 1, 1};
    Model model;

    SmallModel() {
        graph[0] = graph[1] = 4;
        std::copy_n(faces, 12, graph.begin() + 2 + 12 + 12);
        model.ngeom = model.nmat = model.nmesh = model.nhfield = model.ntex = model.nskin = model.nflex = 1;
        model.nmeshvert = model.nmeshnormal = model.nmeshface = model.nskinvert = model.nskinface = model.nskintexvert = 4;
        model.nmeshgraph = static_cast<std::int32_t>(graph.size());
        model.nhfielddata = 6, model.ntexdata = 12;
        model.geom_type = zero, model.geom_matid = zero, model.geom_size = plane_size, model.mat_texrepeat = repeat;
        model.mesh_vertadr = model.mesh_faceadr = model.mesh_graphadr = zero, model.mesh_vertnum = model.mesh_facenum = four;
        model.mesh_texcoordadr = none, model.mesh_vert = corners, model.mesh_normal = normals, model.mesh_face = faces;
        model.mesh_graph = graph.data();
        model.hfield_size = field_size, model.hfield_nrow = two, model.hfield_ncol = three, model.hfield_adr = zero;
        model.hfield_data = heights;
        model.tex_type = one, model.tex_width = two, model.tex_height = two, model.tex_adr = address, model.tex_data = texels;
        model.skin_vertadr = model.skin_faceadr = model.skin_texcoordadr = zero, model.skin_vertnum = model.skin_facenum = four;
        model.skin_texcoord = coordinates, model.skin_face = faces, model.flex_facenum = two;
    }
    SmallModel(const SmallModel&) = delete;
};

double volume(const Mesh& mesh) {
    double sum = 0;
    const auto at = [&](std::size_t i) {
        const Vec3f p = mesh.positions[mesh.indices[i]];
        return Vec3d{p.x, p.y, p.z};
    };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) sum += dot(at(i), cross(at(i + 1), at(i + 2))) / 6;
    return sum;
}

std::string error_of(const Model& model) {
    if (const auto ok = check_model(model); !ok) return ok.error().message;
    const auto meshes = make_meshes(model);
    if (!meshes) return meshes.error().message;
    const auto textures = make_textures(model, *look_of("3.3.3"));
    return textures ? "" : textures.error().message;
}

}  // namespace

TEST_CASE("mujoco model: each kind of mesh is where its number says", "[engine][mujoco]") {
    const SmallModel small;
    const auto made = make_meshes(small.model);
    if (!made) FAIL(made.error().message);
    REQUIRE(made->end == static_cast<int>(made->meshes.size()));
    const auto mesh = [&](int index) -> const Mesh& { return made->meshes[static_cast<std::size_t>(index)]; };
    CHECK(volume(mesh(made->models)) == Approx(1.0 / 6));
    CHECK(volume(mesh(made->models + 1)) == Approx(1.0 / 6));
    // The hull's normals are its faces'. Of the mesh's own, those count that are within acos(0.8) of the face.
    for (const Vec3f n : mesh(made->models + 1).normals) CHECK(length(n) == Approx(1));
    CHECK(mesh(made->models + 1).positions.size() == 12);
    CHECK(mesh(made->models).positions.size() == 12);
    // The base is 4 x 2 x 0.25. Each of the four triangles above has an area of 2 and the mean height of its corners.
    CHECK(volume(mesh(made->hfields)) == Approx(2 + 2 * (0.25 + 0.75 + 0.75 + 0.5) / 3));
    CHECK(mesh(made->skins).uv0.size() == 4);
    CHECK(mesh(made->flexes).positions.size() == 6);
    REQUIRE(made->soft.size() == 2);
    CHECK(made->soft[1].count == 2);
    // The infinite plane reaches beyond the sky, by a grid that the texture's period divides.
    const Mesh& plane = mesh(made->planes.at(0));
    CHECK(plane.positions.size() == 201 * 201);
    CHECK(plane.positions.front().x == Approx(-(2.1 * 50 + 2 * 1) / 2));
    CHECK(plane.positions.back().y == Approx((2.1 * 50 + 2 * 0.5) / 2));
}

TEST_CASE("mujoco model: a plane's grid is padded where its cells do not fill it", "[engine][mujoco]") {
    SmallModel small;
    small.plane_size[0] = 5, small.plane_size[1] = 2, small.plane_size[2] = 0.7;
    const auto made = make_meshes(small.model);
    const Mesh& plane = made->meshes[static_cast<std::size_t>(made->planes.at(0))];
    Bounds bounds;
    for (const Vec3f p : plane.positions) bounds.add(p);
    CHECK(bounds.min == Vec3f{-5, -2, 0});
    CHECK(bounds.max == Vec3f{5, 2, 0});
    CHECK(plane.positions.size() == (6 + 3) * (2 + 3));  // floor(size / cell), even, and two for the padding
}

TEST_CASE("mujoco model: cubes of one picture have it on six faces", "[engine][mujoco]") {
    SmallModel small;
    const auto made = make_textures(small.model, *look_of("3.3.3"));
    REQUIRE(made);
    const CodeTexture& cube = made->front();
    CHECK(cube.cube);
    CHECK(!cube.decodes_srgb);
    REQUIRE(cube.rgb.size() == 6 * 12);
    for (std::size_t i = 0; i < cube.rgb.size(); ++i) CHECK(cube.rgb[i] == small.texels[i % 12]);
    Model large = small.model;
    const std::int32_t side[1] = {8192};
    large.tex_width = large.tex_height = side;
    large.ntexdata = std::uint64_t{1} << 40;
    CHECK(make_textures(large, *look_of("3.3.3")).error().message == "texture 0: more than 2^27 texels with those before it");
    const std::int32_t srgb[1] = {2};
    small.model.tex_colorspace = srgb;
    CHECK(make_textures(small.model, *look_of("3.3.3"))->front().decodes_srgb);
    CHECK(!make_textures(small.model, *look_of("3.3.2"))->front().decodes_srgb);
    for (const auto& [release, look] : {std::pair{"2.2", "2.2.2"},
                                        {"2.3.7", "2.2.2"},
                                        {"3.0", "2.2.2"},
                                        {"3.3", "3.3.2"},
                                        {"3.3.2", "3.3.2"},
                                        {"3.3.3", "3.3.3"},
                                        {"3.11.0", "3.3.3"},
                                        {"3.12.1", "3.12.0"},
                                        {"3.99.99", "3.12.0"}})
        CHECK(look_of(release)->name == look);
    for (const char* other : {"", "3", "3.", "3.3.", ".3", "3.-1", "3.3.3.3", "3.100", "2.1", "4.0", "999999999.0", "3.3.3 ", "3,3"})
        CHECK(look_of(other).error().message ==
              fmt::format("look: '{}', expected a release of MuJoCo from 2.2 on, below 4, such as 2.2.2 or 3.12.0", other));
}

TEST_CASE("mujoco model: a wrong number is one line of error", "[engine][mujoco]") {
    SmallModel s;
    REQUIRE(error_of(s.model).empty());
    struct Row {
        const char* words;
        std::int32_t* number;
    };
    const auto check = [&](const Row& row, std::int32_t value) {
        const std::int32_t before = *row.number;
        *row.number = value;
        const std::string found = error_of(s.model);
        *row.number = before;
        INFO(row.words << " " << value << ": " << found);
        CHECK(found.find(row.words) == 0);
        CHECK(found.find('\n') == std::string::npos);
    };
    const Row counts[] = {{"ngeom is", &s.model.ngeom}, {"nskinface is", &s.model.nskinface}, {"nflex is", &s.model.nflex}};
    const Row others[] = {{"numslices is", &s.model.numslices},
                          {"numquads is", &s.model.numquads},
                          {"shadowsize is", &s.model.shadowsize},
                          {"mesh 0: vertices", s.four},
                          {"mesh 0: a face", &s.faces[5]},
                          {"mesh 0: convex hull: ", &s.graph[1]},
                          {"mesh 0: convex hull: a face", &s.graph[37]},
                          {"height field 0", s.three}};
    for (const Row& row : counts) check(row, -1);
    for (const Row& row : others)
        for (const std::int32_t value : {-1, -2147483647, 2147483647}) check(row, value);
    const Model sound = s.model;
    s.model.mesh_face = nullptr;
    CHECK(error_of(s.model) == "mesh_face is null");
    s.model = sound, s.model.nmeshnormal = 0;
    CHECK(error_of(s.model) == "mesh 0: a face has an index out of range");
    s.model = sound, s.model.ntexdata = 11;
    CHECK(error_of(s.model).find("texture 0: 12 from 0 on") == 0);
    s.model = sound, s.address[0] = INT64_MAX;
    CHECK(error_of(s.model).find("texture 0: ") == 0);
    s.address[0] = 0, s.plane_size[0] = std::numeric_limits<double>::infinity();
    CHECK(error_of(s.model) == "geom 0: the grid of the plane is not finite");
    s.plane_size[0] = 0, s.repeat[0] = 1e-39f;
    CHECK(error_of(s.model) == "geom 0: the grid of the plane is not finite");
    s.repeat[0] = 2, s.two[0] = (1 << 22) + 1;
    CHECK(error_of(s.model).find("height field 0: ") == 0);
    s.model.nhfield = s.model.ntex = 0;
    CHECK(error_of(s.model) == "the flexes have more than 4194304 triangles");
    s.model = sound, s.two[0] = 2;
    for (float* number : {&s.model.znear, &s.model.zfar, &s.model.haze, &s.model.linewidth, &s.model.fog_rgba[1]}) {
        const float before = *number;
        *number = std::numeric_limits<float>::quiet_NaN();
        CHECK(error_of(s.model).find(" is nan, expected a number") != std::string::npos);
        *number = before;
    }
    s.model.linewidth = 101;
    CHECK(error_of(s.model) == "linewidth is 101, expected 0 to 100");
}

TEST_CASE("mujoco model: planes of one grid have one mesh, and grids are counted", "[engine][mujoco]") {
    constexpr std::size_t kCount = 600;
    const std::vector<std::int32_t> planes(kCount, kPlane), none(kCount, -1);
    std::vector<double> sizes(3 * kCount, 0.0);
    Model model;
    model.ngeom = kCount, model.geom_type = planes.data(), model.geom_matid = none.data(), model.geom_size = sizes.data();
    const auto made = make_meshes(model);
    REQUIRE(made);
    CHECK(made->planes.size() == kCount);
    CHECK(made->planes.front() == made->planes.back());
    CHECK(made->meshes.size() == static_cast<std::size_t>(Shape::count) + 1);
    for (std::size_t i = 0; i < kCount; ++i) sizes[3 * i] = 1.0 + static_cast<double>(i);
    const auto too_many = make_meshes(model);
    REQUIRE(!too_many);
    CHECK(too_many.error().code == ErrorCode::limit);
}

TEST_CASE("mujoco model: a mesh of vertices that are no numbers takes no longer than another", "[engine][mujoco]") {
    // Quadratic, 150,000 vertices would take minutes.
    std::vector<std::int32_t> faces(150000, 0);
    std::vector<float> normals(3, 1.0f), corners(3, std::numeric_limits<float>::quiet_NaN());
    SmallModel s;
    s.model.nhfield = s.model.ntex = s.model.nskin = s.model.nflex = s.model.ngeom = s.model.nmeshgraph = 0;
    s.model.mesh_face = faces.data(), s.model.mesh_vert = corners.data(), s.model.mesh_normal = normals.data();
    s.model.nmeshface = s.four[0] = 50000, s.model.nmeshvert = s.model.nmeshnormal = 1;
    const std::int32_t one[1] = {1};
    s.model.mesh_vertnum = one, s.model.mesh_graphadr = s.none;
    const auto made = make_meshes(s.model);
    REQUIRE(made);
    CHECK(made->meshes[static_cast<std::size_t>(made->models)].positions.size() == 1);
}

TEST_CASE("mujoco model: a texture with a side above 16384 is a limit", "[engine][mujoco]") {
    SmallModel s;
    std::int32_t height[1] = {16385};
    s.model.tex_height = height;
    for (const std::int32_t type : {0, 1}) {  // a cube's six faces, one above the other, may be higher; here their texels are missing
        INFO("type " << type);
        const std::int32_t kind[1] = {type};
        s.model.tex_type = kind;
        const auto made = make_textures(s.model, *look_of("3.3.3"));
        REQUIRE(!made);
        CHECK(made.error().code == (type == 0 ? ErrorCode::limit : ErrorCode::bad_input));
    }
}
