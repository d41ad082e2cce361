#include "apps/io/models/model_builder.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/files/uri.hpp"
#include "apps/io/gltf/build/choices.hpp"
#include "apps/io/gltf/build/materials.hpp"
#include "apps/io/gltf/build/nodes.hpp"
#include "apps/io/gltf/build/open.hpp"
#include "apps/io/gltf/build/placed.hpp"
#include "apps/io/gltf/build/world.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/pictures/image_reader.hpp"
#include "shading/material_properties.hpp"
#include "shading/model/srgb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace halflit::io::detail {

float linear_color(double encoded) {
    if (!(encoded > 0.0)) return 0.0f;
    return static_cast<float>(shading::linear_from_srgb(std::min(encoded, 1.0)));
}

ModelBuilder::ModelBuilder(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options, const char* format)
    : document_(std::make_unique<Document>(options, base_dir)) {
    check_threads(options);
    refuse_choices(options);
    const LoadLimits& limits = options.limits;
    if (bytes.size() > limits.max_file_bytes)
        refuse("", fmt::format("has {} bytes, the limit is {} (max_file_bytes)", bytes.size(), limits.max_file_bytes), ErrorCode::limit);
    if (!(options.crease_deg >= 0.0f && options.crease_deg <= 180.0f))
        refuse("", fmt::format("crease_deg is {}, expected 0 to 180", options.crease_deg), ErrorCode::usage);
    take(document_->folder.check(), "");
    document_->file_bytes = bytes.size();
    set_geometry_limit(*document_);
    document_->encoded_images = Budget("reading the pictures", limits.max_total_bytes);
    document_->info.format = format;
    images_ = std::make_unique<ImageStore>(*document_, loaded_.scene.textures);
    loaded_.nodes.emplace_back();
    local_.emplace_back();
}

void ModelBuilder::take_triangles(std::uint64_t count) {
    document_->geometry.take(count * kTriangleBytes);
    triangles_ += count;
    constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max() / 3;
    if (triangles_ > kMost) refuse("", fmt::format("has more than {} triangles, which is the limit", kMost), ErrorCode::limit);
}

int ModelBuilder::add_material(const Material& material) {
    document_->geometry.take(sizeof(Material) + material.name.size());
    loaded_.scene.materials.push_back(material);
    return static_cast<int>(loaded_.scene.materials.size()) - 1;
}

int ModelBuilder::grey_material() {
    if (grey_ >= 0) return grey_;
    Material grey;
    grey.base_color = {0.5f, 0.5f, 0.5f, 1.0f};
    grey.metallic = 0.0f;
    grey.roughness = 0.4f;
    grey.double_sided = true;
    return grey_ = add_material(grey);
}

int ModelBuilder::colored_material() {
    if (colored_ >= 0) return colored_;
    Material white;
    white.metallic = 0.0f;
    white.roughness = 0.6f;
    white.double_sided = true;
    return colored_ = add_material(white);
}

std::string ModelBuilder::file_name(std::string_view name) {
    std::string file(name);
    std::replace(file.begin(), file.end(), '\\', '/');
    const bool has_drive = file.size() > 1 && file[1] == ':';
    if (has_drive || file.starts_with('/')) file.erase(0, file.find_last_of("/:") + 1);
    return file;
}

void ModelBuilder::add_file(std::string_view name) {
    for (std::string& path : document_->folder.places(file_name(name))) {
        document_->geometry.take(sizeof path + path.size());
        document_->info.files.push_back(std::move(path));
    }
}

int ModelBuilder::add_image(file::Image image, std::string where, ColorSpace space, MipRule rule) {
    image.place = texts_.emplace_back(std::move(where));
    document_->file.images.push_back(image);
    return images_->texture_for(static_cast<int>(document_->file.images.size()) - 1, space, rule);
}

int ModelBuilder::texture(std::string_view name, std::string where, ColorSpace space, MipRule rule) {
    document_->geometry.take(sizeof(file::Image) + sizeof(std::string) + 4 * name.size() + where.size());
    std::string uri;  // as the picture's reader decodes it
    for (const char c : file_name(name)) {
        if (c == '%' || c == ':')
            uri += c == '%' ? "%25" : "%3A";
        else
            uri += c;
    }
    file::Image image;
    image.uri = texts_.emplace_back(std::move(uri));
    return add_image(image, std::move(where), space, rule);
}

int ModelBuilder::texture(std::vector<std::byte> picture, std::string where, ColorSpace space, MipRule rule) {
    file::BufferView view;
    view.buffer = static_cast<int>(document_->buffers.size());
    view.byte_length = picture.size();
    document_->owned_buffers.push_back(std::move(picture));
    document_->buffers.emplace_back(document_->owned_buffers.back());  // a vector that moves keeps its bytes
    document_->file.buffer_views.push_back(view);
    file::Image image;
    image.buffer_view = static_cast<int>(document_->file.buffer_views.size()) - 1;
    return add_image(image, std::move(where), space, rule);
}

std::vector<PartMesh> ModelBuilder::add_meshes(Soup&& soup, std::span<const std::string> name_of, std::span<const int> material_of) {
    std::vector<PartMesh> all;
    Scene& scene = loaded_.scene;
    const Vec3d origin = move_near(soup, document_->options.recentre);
    const LoadOptions& options = document_->options;
    for (SoupMesh& made : make_meshes(std::move(soup), static_cast<double>(options.crease_deg), options.threads, left_out_)) {
        Mesh& mesh = made.mesh;
        mesh.name = name_of[made.part];
        mesh.material = material_of[made.part];
        document_->geometry.take(sizeof(Mesh) + mesh.name.size());
        if (mesh.material >= 0) {
            const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
            const auto used = [](const TextureUse& use) { return use.used(); };
            if (mesh.uv0.empty() && std::any_of(material.textures.begin(), material.textures.end(), used))
                document_->warn(
                    fmt::format("material \"{}\": the surface has no texture coordinates, its textures are drawn with the colour at "
                                "(0, 0)",
                                printable(material.name, 80)));
            if (shading::tangent_uv_set(material) && !mesh.uv0.empty()) {
                document_->geometry.take(std::uint64_t{mesh.indices.size()} * 16);
                generate_tangents(mesh, 0);
            }
        }
        all.push_back({made.part, add_mesh(std::move(mesh), origin)});
    }
    return all;
}

int ModelBuilder::add_mesh(Mesh mesh, Vec3d origin) {
    origin_.push_back(origin);
    document_->info.vertices += mesh.positions.size();
    document_->info.triangles_stored += triangles_of(mesh);
    if (mesh.topology != Topology::triangles) ++document_->info.point_and_line_primitives;
    loaded_.scene.meshes.push_back(std::move(mesh));
    return static_cast<int>(loaded_.scene.meshes.size()) - 1;
}

void ModelBuilder::place_alone(Soup&& soup, std::span<const int> material_of) {
    const std::vector<std::string> names(material_of.size());
    std::vector<int> meshes;
    for (const PartMesh& made : add_meshes(std::move(soup), names, material_of)) meshes.push_back(made.mesh);
    place(meshes, "");
}

void ModelBuilder::place_points(Soup&& soup, AlphaMode alpha) {
    // A file that was cut off may have fewer.
    if (soup.normals.size() != soup.positions.size()) soup.normals.clear();
    if (soup.colors.size() != soup.positions.size()) soup.colors.clear();
    if (static_cast<std::size_t>(std::count(soup.normals.begin(), soup.normals.end(), Vec3f{})) > soup.normals.size() / 10)
        soup.normals.clear();
    take_entries<std::uint32_t>(soup.positions.size());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < soup.positions.size(); ++i) {
        if (!fits_float(soup.positions[i])) continue;
        soup.positions[kept] = soup.positions[i];
        if (!soup.normals.empty()) soup.normals[kept] = soup.normals[i];
        if (!soup.colors.empty()) soup.colors[kept] = soup.colors[i];
        ++kept;
    }
    if (const std::size_t lost = soup.positions.size() - kept; lost > 0)
        document_->warn(fmt::format("{} points with coordinates that are not finite are left out", lost));
    if (kept == 0) return;
    soup.positions.resize(kept);
    if (!soup.normals.empty()) soup.normals.resize(kept);
    if (!soup.colors.empty()) soup.colors.resize(kept);
    soup.position_of.resize(kept);
    std::iota(soup.position_of.begin(), soup.position_of.end(), 0u);
    const Vec3d origin = move_near(soup, options().recentre);
    Mesh mesh;
    mesh.topology = Topology::points;
    mesh.positions = std::move(soup.points);
    mesh.normals = std::move(soup.normals);
    mesh.colors = std::move(soup.colors);
    mesh.indices = std::move(soup.position_of);
    mesh.material = mesh.colors.empty() ? grey_material() : colored_material();
    Material& material = loaded_.scene.materials[static_cast<std::size_t>(mesh.material)];
    material.alpha_mode = alpha;
    if (mesh.normals.empty()) material.unlit = true;
    const int index = add_mesh(std::move(mesh), origin);
    place({&index, 1}, "");
}

/// Bytes that an instance takes until it is drawn, at most; files may place a mesh by few bytes.
constexpr std::uint64_t kInstanceBytes = 4096;

void ModelBuilder::place(std::span<const int> meshes, const std::string& name, const Affine& root_from_node) {
    if (meshes.empty()) return;
    document_->geometry.take(sizeof(Node) + sizeof(Affine) + name.size() + meshes.size() * kInstanceBytes);
    Node node;
    node.name = name;
    node.parent = 0;
    node.parent_from_node = to_node_transform(root_from_node);
    const auto origin = [&](int mesh) { return origin_[static_cast<std::size_t>(mesh)]; };
    const bool moved = std::any_of(meshes.begin(), meshes.end(), [&](int mesh) { return !(origin(mesh) == Vec3d{}); });
    for (const int mesh : meshes) {
        if (moved) node.node_from_instance.push_back(to_node_transform({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, origin(mesh)}}));
        node.instances.push_back(static_cast<int>(loaded_.scene.instances.size()));
        loaded_.scene.instances.push_back({mesh, {}});
        loaded_.node_of_instance.push_back(static_cast<int>(loaded_.nodes.size()));
        document_->info.triangles_drawn += triangles_of(loaded_.scene.meshes[static_cast<std::size_t>(mesh)]);
    }
    loaded_.nodes.push_back(std::move(node));
    local_.push_back(root_from_node);
}

bool ModelBuilder::place_card(std::vector<std::byte> picture, const std::string& name) {
    const LoadLimits& limits = options().limits;
    const auto header = read_image_header(picture, {limits.max_texture_side, limits.max_texture_pixels, limits.max_jpeg_scans});
    if (!header) return false;
    Material card;
    card.unlit = true;
    card.double_sided = true;
    card.alpha_mode = AlphaMode::blend;
    card.metallic = 0.0f;
    auto& slot = card.textures[TextureSlot::base_color];
    slot.texture = texture(std::move(picture), printable(name, 120), ColorSpace::srgb);
    slot.sampler.wrap_u = slot.sampler.wrap_v = TextureWrap::clamp;
    const auto w = static_cast<float>(static_cast<double>(header->width) / static_cast<double>(header->height));
    Mesh mesh;
    mesh.name = name;
    mesh.material = add_material(card);
    mesh.positions = {{-w, 0, -1}, {w, 0, -1}, {w, 0, 1}, {-w, 0, 1}};  // z is up
    mesh.normals.assign(4, {0, -1, 0});
    mesh.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    const int index = add_mesh(std::move(mesh), {});
    place(std::span(&index, 1), name);
    Camera camera;
    camera.name = name;
    camera.orthographic = true;
    camera.half_height = 1.0f;
    camera.half_width = w;
    camera.near_z = 0.1f;
    camera.far_z = 10.0f;
    add_camera(camera, {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {0, -2, 0}}});
    document_->warn(fmt::format("the file has no mesh; its picture \"{}\" is drawn", printable(name, 120)));
    return true;
}

void ModelBuilder::add_camera(Camera camera, const Affine& root_from_camera) {
    document_->geometry.take(sizeof(Node) + sizeof(Affine) + sizeof(Camera) + camera.name.size());
    Node node;
    node.name = camera.name;
    node.parent = 0;
    node.parent_from_node = to_node_transform(root_from_camera);
    node.camera = static_cast<int>(loaded_.scene.cameras.size());
    loaded_.scene.cameras.push_back(std::move(camera));
    loaded_.nodes.push_back(std::move(node));
    local_.push_back(root_from_camera);
}

LoadedScene ModelBuilder::finish(const ModelFrame& frame) {
    images_->start();
    NodeTree tree;
    for (std::size_t n = 0; n < loaded_.nodes.size(); ++n) {
        const Affine& world = local_[n];
        const Node& node = loaded_.nodes[n];
        for (std::size_t k = 0; k < node.instances.size(); ++k)
            loaded_.scene.instances[static_cast<std::size_t>(node.instances[k])].world_from_object =
                to_mat4(node.node_from_instance.empty() ? world : world * to_affine(node.node_from_instance[k]));
        tree.parent.push_back(loaded_.nodes[n].parent);
        tree.drawn.push_back(static_cast<int>(n));
        tree.world_from_node.push_back(world);
    }
    place_scene(*document_, document_->options.up.value_or(frame.up), tree, loaded_);
    for (std::size_t n = 0; n < loaded_.nodes.size(); ++n) {
        if (loaded_.nodes[n].camera < 0) continue;
        Camera& camera = loaded_.scene.cameras[static_cast<std::size_t>(loaded_.nodes[n].camera)];
        camera.world_from_camera = rigid_part(tree.world_from_node[n]);
        const auto scale = static_cast<float>(loaded_.placement.scale);
        for (float* length : {&camera.half_height, &camera.half_width, &camera.near_z, &camera.far_z}) *length *= scale;
    }
    images_->finish(loaded_.scene.materials);
    make_visible(*document_, loaded_.scene);
    if (left_out_ > 0) document_->warn(fmt::format("{} triangles with coordinates that are not finite are left out", left_out_));
    if (loaded_.scene.instances.empty() && document_->first_failure) throw LoadFailure{*document_->first_failure};
    if (loaded_.scene.instances.empty()) document_->warn("the model has nothing to draw");
    SceneInfo& info = document_->info;
    info.meshes = info.primitives = loaded_.scene.meshes.size();
    info.nodes = loaded_.nodes.size();
    info.materials = loaded_.scene.materials.size();
    info.textures = loaded_.scene.textures.size();
    info.images = document_->file.images.size();
    info.scenes = 1;
    info.unit_m = frame.unit_m;
    std::sort(info.files.begin(), info.files.end());
    info.files.erase(std::unique(info.files.begin(), info.files.end()), info.files.end());
    loaded_.warnings = document_->take_warnings();
    loaded_.info = std::move(info);
    loaded_.scene.calibrated = true;
    loaded_.scene.frame_work = document_->allowed_work();
    return std::move(loaded_);
}

}  // namespace halflit::io::detail
