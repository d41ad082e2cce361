#include "raster/scene/seen_vertices.hpp"

#include "raster/scene/seen_texels.hpp"
#include "raster/scene/used_vertices.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>

namespace halflit::raster {
namespace {

/// Finds the vertices of triangles that alpha does not hide, and points around the texels that are seen of large ones.
class SeenVertices {
public:
    SeenVertices(const Scene& scene, const Mesh& mesh, const Material& material)
        : mesh_(mesh), material_(material), texels_(scene, material.textures[TextureSlot::base_color]) {
        const auto& uv = texels_.use().uv_set == 0 ? mesh.uv0 : mesh.uv1;
        uv_ = !texels_.all() && uv.size() == mesh.positions.size() ? uv.data() : nullptr;
        colors_ = mesh.colors.size() == mesh.positions.size() ? mesh.colors.data() : nullptr;
    }
    /// False: each triangle is seen.
    [[nodiscard]] bool hides_some() const { return uv_ != nullptr || colors_ != nullptr; }

    /// Marks vertices; returns false if all that are used are marked and there are no points.
    bool mark(std::vector<bool>& used, std::vector<Vec3f>& points) {
        constexpr std::size_t kFew = 1024;  // triangles, whose texels are looked at closely
        bool less = false;
        for (std::size_t i = 0; i + 3 <= mesh_.indices.size(); i += 3) {
            check_();
            const std::uint32_t* const corner = &mesh_.indices[i];
            if (!std::all_of(corner, corner + 3, [&](std::uint32_t v) { return v < used.size(); })) continue;
            const auto share = has_alpha(corner) ? share_of(corner) : SeenTexels::Share::none;
            less |= share == SeenTexels::Share::none;
            if (share == SeenTexels::Share::some && triangles_of(mesh_) <= kFew) {
                less = true;
                Piece piece;
                for (int k = 0; k < 3; ++k) piece.at[k] = to_double(mesh_.positions[corner[k]]), piece.uv[k] = uv_[corner[k]];
                add_seen(piece, kMostCuts, points);
            } else if (share != SeenTexels::Share::none) {
                for (int k = 0; k < 3; ++k) used[corner[k]] = true;
            }
        }
        return less;
    }

private:
    static constexpr int kMostCuts = 5;
    struct Piece {
        Vec3d at[3];
        Vec2f uv[3];
    };

    [[nodiscard]] bool has_alpha(const std::uint32_t* corner) const {
        if (colors_ == nullptr) return true;
        const float alpha = material_.base_color.w * std::max({colors_[corner[0]].w, colors_[corner[1]].w, colors_[corner[2]].w});
        return material_.alpha_mode == AlphaMode::mask ? alpha >= material_.alpha_cutoff : alpha > 0.0f;
    }
    [[nodiscard]] SeenTexels::Share share_of(const std::uint32_t* corner) const {
        return uv_ == nullptr ? SeenTexels::Share::all : texels_.share({uv_[corner[0]], uv_[corner[1]], uv_[corner[2]]});
    }
    /// Halves the sides of a triangle until its parts show all or nothing.
    void add_seen(const Piece& piece, int cuts, std::vector<Vec3f>& points) {
        check_();
        const auto share = texels_.share(piece.uv);
        if (share == SeenTexels::Share::none) return;
        if (share == SeenTexels::Share::all || cuts == 0) {
            for (const Vec3d& at : piece.at) points.push_back(to_float(at));
            return;
        }
        Piece middle;  // of the opposite sides
        for (int k = 0; k < 3; ++k) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            middle.at[k] = (piece.at[a] + piece.at[b]) * 0.5;
            middle.uv[k] = (piece.uv[a] + piece.uv[b]) * 0.5f;
        }
        for (int k = 0; k < 3; ++k) {
            Piece part = middle;
            part.at[k] = piece.at[k], part.uv[k] = piece.uv[k];
            add_seen(part, cuts - 1, points);
        }
        add_seen(middle, cuts - 1, points);
    }

    const Mesh& mesh_;
    const Material& material_;
    SeenTexels texels_;
    const Vec2f* uv_ = nullptr;
    const Vec4f* colors_ = nullptr;
    TimeCheck check_;
};

}  // namespace

FramedVertices seen_vertices(const Scene& scene, const Mesh& mesh, const Material* material, bool& whole) {
    FramedVertices out;
    std::vector<bool> used;
    if (material != nullptr && material->alpha_mode != AlphaMode::opaque && !material->transmits() &&
        mesh.topology == Topology::triangles) {
        SeenVertices seen(scene, mesh, *material);
        if (seen.hides_some()) {
            used.resize(mesh.positions.size());
            whole &= !seen.mark(used, out.points);
        }
    }
    if (used.empty()) used = used_vertices(mesh);
    out.vertices.reserve(static_cast<std::size_t>(std::count(used.begin(), used.end(), true)));
    TimeCheck check;
    for (std::uint32_t v = 0; v < used.size(); ++v) {
        check();
        if (used[v]) out.vertices.push_back(v);
    }
    out.measure(mesh);
    return out;
}

}  // namespace halflit::raster
