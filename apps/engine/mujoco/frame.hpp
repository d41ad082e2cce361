// A scene of MuJoCo to a frame of the renderer for fixed-function pictures.
#pragma once

#include "apps/engine/mujoco/model_meshes.hpp"
#include "apps/engine/mujoco/scene_reader.hpp"

namespace halflit::engine::mujoco {

/// What frames need of a model.
struct FrameModel {
    Layout layout;
    Look look;
    float shadow_clip = 1, shadow_scale = 0.6f, fog_start = 0, fog_end = 0, line_width = 1;
    Vec3f fog_color{};
    int shadow_size = 4096;
    ModelMeshes numbers;                ///< without the meshes
    std::vector<TextureUse> materials;  ///< where geoms name materials
    std::vector<bool> cubes;            ///< of each texture, whether it is a cube
    int sky = -1;                       ///< texture; -1: none
};

/// Fails (bad_input) for materials whose texture is not there. The meshes are the caller's to take out of `made`.
[[nodiscard]] Result<FrameModel> frame_model(const Model& model, const Look& look, const ModelMeshes& made);

/// Passes of MuJoCo that a frame is for. depth: that of the color pass alone, where the sky has depth and transparent geoms have none.
enum class Pass { color, segment, depth };

struct FrameRequest {
    const std::byte* camera = nullptr;
    const std::uint8_t* flags = nullptr;
    int width = 0, height = 0;
    Pass pass = Pass::color;
};

struct SceneFrame {
    FixedFrame frame;                 ///< in the model's space and unit
    float near_z = 0.1f, far_z = 50;  ///< of the camera, in the unit of its room, which Scene::translate, rotate and scale lead to
    bool has_segments = false;        ///< its planes are those of the segment pass
    std::vector<Geom> geoms;          ///< FixedItem::id is an index + 1
};

/// Fails (bad_input) for an index out of range and numbers that are not finite, (usage) for a camera that sees nothing.
[[nodiscard]] Result<SceneFrame> make_frame(const FrameModel& model, const Scene& scene, const FrameRequest& request);

}  // namespace halflit::engine::mujoco
