// Pictures of a model of MuJoCo, one or many at once.
#pragma once

#include "apps/engine/mujoco/frame.hpp"
#include "halflit/fixed_function.hpp"

#include <chrono>
#include <memory>
#include <span>
#include <vector>

namespace halflit::engine::mujoco {

/// A picture of a scene, in the caller's memory. Null: not drawn.
struct Picture {
    const Scene* scene = nullptr;
    const std::byte* camera = nullptr;    ///< two; null: the scene's
    const std::uint8_t* flags = nullptr;  ///< null: the scene's
    std::uint8_t* rgb = nullptr;          ///< three codes a pixel
    float* depth = nullptr;
    std::int32_t* segid = nullptr;   ///< -1: nothing
    std::int32_t* object = nullptr;  ///< two a pixel: objid and objtype; -1, -1: nothing
    int width = 0, height = 0;       ///< pixels
    int samples = 1;                 ///< 1 or 4, of rgb
    bool bottom_up = false;
    bool depth_is_distance = false;    ///< along the view; false: 0 at the near plane, 1 at the far plane
    bool depth_of_color_pass = false;  ///< of opaque geoms and the sky; false: of all geoms
};

/// Fails (usage) for sides below 1 or above 16384, and for other samples than 1 and 4.
[[nodiscard]] Result<void> check_size(const Picture& picture);

/// Keeps shapes and textures, once for all threads. One call of render() at a time.
class Drawer {
public:
    /// Fails (bad_input) for a model that contradicts itself, (usage) for a layout that does.
    [[nodiscard]] static Result<Drawer> make(const Model& model, const Look& look, const Execution& execution);

    /// Draws pictures, several at once if there are several. Fails as the first of them in the list that fails, and (usage) if the host's
    /// loop did not draw all.
    [[nodiscard]] Result<void> render(std::span<const Picture> pictures);

    void set_execution(const Execution& execution) { execution_ = execution; }

private:
    /// What a thread draws with.
    struct Worker {
        FixedFunctionRenderer renderer;
        std::vector<std::uint32_t> ids;
        std::vector<Vec3f> positions, normals;
    };
    Drawer(FrameModel model, FixedFunctionRenderer renderer, const Execution& execution);

    /// execution: of the whole call, which began at `start`.
    [[nodiscard]] Result<void> draw(Worker& by, const Picture& picture, const Execution& execution,
                                    std::chrono::steady_clock::time_point start) const;
    [[nodiscard]] Result<void> move_vertices(Worker& by, const Scene& scene, const Execution& execution) const;

    FrameModel model_;
    Execution execution_;
    std::vector<std::unique_ptr<Worker>> workers_;  ///< the first one is there
};

}  // namespace halflit::engine::mujoco
