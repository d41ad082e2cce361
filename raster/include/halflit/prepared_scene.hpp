// A scene prepared for drawing: checked, its meshes cut into clusters, its instances bounded. Many frames are drawn from it. When the scene
// changes, update() is told what changed, and redoes that alone.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/mesh.hpp"
#include "halflit/settings.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace halflit {

struct Scene;
namespace raster {
class PreparedData;
}

/// Parts of a scene that changed after it was prepared. The numbers of meshes, instances and materials must stay the same.
struct SceneChanges {
    std::vector<std::size_t> changed_instances{};  ///< any member of the instance
    std::vector<std::size_t> deformed_meshes{};    ///< any array of the mesh, indices and material included
    bool materials = false;                        ///< materials or textures
    bool lights = false;                           ///< the scene's own light. Nothing is prepared of it: who draws by a copy takes it anew
};

/// Refers to the scene that it was made from: that must stay at its address, and update() must be told its changes. Any number of threads
/// may draw from it at once; none may while it is updated.
class PreparedScene {
public:
    /// Only threads and parallel_for of the execution count. Fails (bad_input) for a faulty scene: an index out of range, arrays of
    /// different lengths, an invalid lobe.
    [[nodiscard]] HALFLIT_API static Result<PreparedScene> make(const Scene& scene, const Execution& execution = {});
    static Result<PreparedScene> make(Scene&& scene, const Execution& execution = {}) = delete;  // it would not outlive the call

    /// @{
    /// A PreparedScene that was moved from may only be assigned to or destroyed.
    HALFLIT_API PreparedScene(PreparedScene&&) noexcept;
    HALFLIT_API PreparedScene& operator=(PreparedScene&&) noexcept;
    /// @}
    HALFLIT_API ~PreparedScene();

    /// Redoes what changed, and sums over all instances: 0.03 ms for one of 1,000 moved instances, 14 ms for one of a million. After an
    /// error no frame is drawn until an update succeeds; that one also redoes what the failed ones were told.
    [[nodiscard]] HALFLIT_API Result<void> update(const SceneChanges& changes, const Execution& execution = {});

    /// The scene that it was made from.
    [[nodiscard]] HALFLIT_API const Scene& scene() const;
    /// World-space box of everything drawn but shadow catchers, instances whose alpha is 0, and those that their matrix gives no extent;
    /// the same as scene_bounds().
    [[nodiscard]] HALFLIT_API const Bounds& bounds() const;
    /// Number of triangles over all instances.
    [[nodiscard]] HALFLIT_API std::uint64_t triangle_count() const;

    /// For the library's own use.
    [[nodiscard]] const raster::PreparedData& data() const { return *data_; }

private:
    explicit PreparedScene(std::unique_ptr<raster::PreparedData> data);
    std::unique_ptr<raster::PreparedData> data_;
};

}  // namespace halflit
