// A mesh from triangles and quads as OpenGL's lists have them. Corners that are equal in everything become one vertex.
#pragma once

#include "halflit/mesh.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace halflit::engine::mujoco {

struct Corner {
    Vec3f position, normal;
    Vec2f uv{};
};

class MeshBuilder {
public:
    /// has_uv: corners have texture coordinates, which become Mesh::uv0.
    explicit MeshBuilder(bool has_uv = false) : has_uv_(has_uv) {}

    /// reversed: c, b, a.
    void triangle(const Corner& a, const Corner& b, const Corner& c, bool reversed = false) {
        for (const Corner* corner : {reversed ? &c : &a, &b, reversed ? &a : &c}) mesh_.indices.push_back(index_of(*corner));
    }
    /// Split as Mesa splits it, from b to d, which the picture shows where light is computed at corners. reversed: d, c, b, a.
    void quad(const Corner& a, const Corner& b, const Corner& c, const Corner& d, bool reversed = false) {
        if (reversed) {
            triangle(d, c, a);
            triangle(c, b, a);
        } else {
            triangle(a, b, d);
            triangle(b, c, d);
        }
    }
    [[nodiscard]] Mesh take() { return std::move(mesh_); }

private:
    using Key = std::array<std::uint32_t, 8>;  // bits, since NaN is not equal to itself
    struct Hash {
        std::size_t operator()(const Key& key) const {
            std::uint64_t h = 0;
            for (const std::uint32_t bits : key) h = (h ^ bits) * 0x9e3779b97f4a7c15u, h ^= h >> 29;
            return static_cast<std::size_t>(h);
        }
    };

    std::uint32_t index_of(const Corner& corner) {
        const auto [p, n, uv] = corner;
        // + 0 makes -0 to 0, which is equal and has other bits.
        Key key;
        std::size_t k = 0;
        for (const float x : {p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y}) key[k++] = std::bit_cast<std::uint32_t>(x + 0.0f);
        const auto [at, is_new] = found_.try_emplace(key, static_cast<std::uint32_t>(mesh_.positions.size()));
        if (is_new) {
            mesh_.positions.push_back(p);
            mesh_.normals.push_back(n);
            if (has_uv_) mesh_.uv0.push_back(uv);
        }
        return at->second;
    }

    bool has_uv_;
    Mesh mesh_;
    std::unordered_map<Key, std::uint32_t, Hash> found_;
};

}  // namespace halflit::engine::mujoco
