// The public face of PreparedData.
#include "halflit/prepared_scene.hpp"

#include "raster/detail/guarded.hpp"
#include "raster/scene/prepared_data.hpp"

namespace halflit {

PreparedScene::PreparedScene(std::unique_ptr<raster::PreparedData> data) : data_(std::move(data)) {}
PreparedScene::PreparedScene(PreparedScene&&) noexcept = default;
PreparedScene& PreparedScene::operator=(PreparedScene&&) noexcept = default;
PreparedScene::~PreparedScene() = default;

Result<PreparedScene> PreparedScene::make(const Scene& scene, const Execution& execution) {
    return raster::guarded("preparing a scene", execution, [&]() -> Result<PreparedScene> {
        auto data = raster::PreparedData::make(scene, execution);
        if (!data) return tl::unexpected<Error>(data.error());
        return PreparedScene(std::make_unique<raster::PreparedData>(std::move(*data)));
    });
}

Result<void> PreparedScene::update(const SceneChanges& changes, const Execution& execution) { return data_->update(changes, execution); }

const Scene& PreparedScene::scene() const { return data_->scene(); }

const Bounds& PreparedScene::bounds() const { return data_->framed_bounds(); }

std::uint64_t PreparedScene::triangle_count() const { return data_->triangle_count(); }

}  // namespace halflit
