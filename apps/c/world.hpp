// The caller's world and the one that is drawn. What is passed in and returned has the coordinates of the file, or of the caller's arrays.
// The scene that is drawn has y up, lies near the origin and is neither tiny nor huge.
#pragma once

#include "halflit/halflit.h"

#include <halflit/camera.hpp>
#include <halflit/light.hpp>
#include <halflit/model.hpp>
#include <halflit/scene.hpp>
#include <halflit/settings.hpp>

#include <optional>

namespace halflit::c {

/// A point of the caller's world: the numbers of a struct in float32, and what they lack (place_rest, position_rest).
struct FinePoint {
    Vec3d point{0, 0, 0}, rest{0, 0, 0};
};

/// A camera in the caller's world. Its matrix has the place in float32.
struct CallersCamera {
    Camera camera{};
    Vec3d rest{0, 0, 0};
};
struct CallersLight {
    Light light{};
    Vec3d rest{0, 0, 0};
};
struct CallersInstance {
    Instance instance{};
    Vec3d rest{0, 0, 0};
};

/// world_from_object in double, column after column.
struct Placing {
    Vec3d axes[3], place, rest{0, 0, 0};
};

/// Takes into() the world that is drawn, and out() of it. Quarter turns and powers of two are exact; into(out(x)) is x.
class World {
public:
    World() = default;
    explicit World(Placement placement) : at_(std::move(placement)) {}

    [[nodiscard]] const Placement& placement() const { return at_; }
    void set_up(UpAxis up) { at_.up = up; }
    /// The mesh's positions are multiplied by this.
    void set_mesh_scale(std::size_t mesh, double scale);
    /// The place of a mesh is another's from now on, whose positions are as they were given.
    void forget_mesh_scale(std::size_t mesh) {
        if (mesh < at_.mesh_scales.size()) at_.mesh_scales[mesh] = 1.0;
    }

    [[nodiscard]] Vec3d into(const FinePoint& p) const;
    [[nodiscard]] FinePoint out(Vec3d p) const;
    /// Least and largest corner.
    struct Box {
        Vec3d min, max;
    };
    [[nodiscard]] std::optional<Box> out(const Bounds& bounds) const;
    [[nodiscard]] Camera into(const CallersCamera& given) const;
    [[nodiscard]] CallersCamera out(const Camera& drawn) const;
    [[nodiscard]] Light into(const CallersLight& given) const;
    [[nodiscard]] CallersLight out(const Light& drawn) const;
    /// Where an instance of a mesh is drawn. A file's meshes may be drawn in another size than the file's.
    [[nodiscard]] Mat4 into(const Placing& given, int mesh) const;
    [[nodiscard]] CallersInstance out(const Instance& drawn) const;
    /// Positions of a mesh that takes the place of another one.
    void into(Mesh& mesh, std::size_t index) const;
    /// Lengths of settings.
    [[nodiscard]] Settings into(Settings given) const;
    [[nodiscard]] Settings out(Settings drawn) const;
    /// A frame's planes, in place. Where positions move(), `target` has a plane of depth or instance too, which shows where a surface is.
    void out(const halflit_target& target, const Region& region) const;
    /// Whether out() of positions needs a plane that shows where a surface is.
    [[nodiscard]] bool moves() const { return !(at_.origin == Vec3d{}); }

private:
    [[nodiscard]] double mesh_scale(int mesh) const;
    Placement at_;
};

}  // namespace halflit::c
