// A scene while a reader of another format than glTF makes it. The glTF reader's Document is the context: limits, time, warnings, the
// model's folder, and the pictures.
#pragma once

#include "apps/io/gltf/build/images.hpp"
#include "apps/io/gltf/file/document.hpp"
#include "apps/io/gltf/file/transform.hpp"
#include "apps/io/models/soup.hpp"
#include "halflit/gltf.hpp"

#include <cstddef>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// Properties of a model's frame about which formats say more than glTF, or nothing.
struct ModelFrame {
    UpAxis up = UpAxis::y;  ///< by custom
    double unit_m = 0.0;    ///< length of the file's unit in metres; 0: it has none
};

/// A mesh that was made of a part of a soup.
struct PartMesh {
    std::uint32_t part;
    int mesh;  ///< index into the scene's meshes
};

class ModelBuilder {
public:
    /// Throws LoadFailure. `bytes` must outlive the builder.
    ModelBuilder(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options, const char* format);

    Document& document() { return *document_; }
    LoadedScene& loaded() { return loaded_; }
    [[nodiscard]] const LoadOptions& options() const { return document_->options; }

    /// Memory for so many more triangles; above a limit, throws LoadFailure.
    void take_triangles(std::uint64_t count);
    /// Memory for so many more entries of a list.
    template <class T>
    void take_entries(std::uint64_t count) {
        document_->geometry.take(count * (sizeof(T) + kPlaceBytes));
    }

    int add_material(const Material& material);
    /// The material of surfaces that have none: neutral grey.
    int grey_material();
    /// White, for vertices with colours.
    int colored_material();

    /// A picture in a file, as the model writes its name; `where` is for messages. Index into the scene's textures.
    int texture(std::string_view name, std::string where, ColorSpace space, MipRule rule = MipRule::equal);
    /// A picture in memory.
    int texture(std::vector<std::byte> picture, std::string where, ColorSpace space, MipRule rule = MipRule::equal);
    /// The file's name, with slashes, and without the folders of another machine: "C:\art\wood.png" is wood.png.
    [[nodiscard]] static std::string file_name(std::string_view name);
    /// Notes a file that the model refers to, there or not.
    void add_file(std::string_view name);

    /// Makes the scene's meshes of a soup, in order. name_of, material_of: of each part.
    std::vector<PartMesh> add_meshes(Soup&& soup, std::span<const std::string> name_of, std::span<const int> material_of);
    /// Adds a mesh that is complete, and lies at `origin` in its object. Returns its index.
    int add_mesh(Mesh mesh, Vec3d origin);
    /// Adds and places the meshes of a soup that is one object.
    void place_alone(Soup&& soup, std::span<const int> material_of);
    /// Adds and places the positions of a soup as points, with its normals and colours where there is one for each. Those without normals
    /// are not lit: without any, or where more than a tenth is 0, as some programs write where there is none.
    void place_points(Soup&& soup, AlphaMode alpha = AlphaMode::opaque);
    /// Places meshes by a node under the root.
    void place(std::span<const int> meshes, const std::string& name, const Affine& root_from_node = {});
    /// A picture of what the file has no shape of becomes a card before an orthographic camera, with a warning. False: it is no picture.
    bool place_card(std::vector<std::byte> picture, const std::string& name);
    /// A camera in the file's space; the projection's lengths are the file's too.
    void add_camera(Camera camera, const Affine& root_from_camera);
    /// Everything placed, completed and counted. Ends the builder.
    LoadedScene finish(const ModelFrame& frame);

private:
    static constexpr std::uint64_t kPlaceBytes = 52;  ///< while equal positions are looked for

    int add_image(file::Image image, std::string where, ColorSpace space, MipRule rule);

    std::unique_ptr<Document> document_;
    LoadedScene loaded_;
    std::deque<std::string> texts_;  ///< what the document's views point to
    std::unique_ptr<ImageStore> images_;
    std::vector<Affine> local_;  ///< of loaded_.nodes; the root is node 0
    std::vector<Vec3d> origin_;  ///< of the scene's meshes, in the object's coordinates
    int grey_ = -1, colored_ = -1;
    std::uint64_t triangles_ = 0;
    std::size_t left_out_ = 0;
};

/// Linear light of an sRGB value; values outside [0, 1] are held.
[[nodiscard]] float linear_color(double encoded);

}  // namespace halflit::io::detail
