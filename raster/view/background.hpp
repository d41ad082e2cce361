// The environment behind the scene: what each pixel's view ray meets when nothing is drawn there.
#pragma once

#include "raster/view/projection.hpp"
#include "shading/environment.hpp"

namespace halflit::raster {

class Background {
public:
    Background() = default;
    /// Of a picture of that size. `environment` keeps its image, and outlives this.
    Background(const shading::Environment& environment, const Camera& camera, int width, int height, float exposure);

    /// False: there is none, and at() must not be called.
    [[nodiscard]] explicit operator bool() const { return environment_ != nullptr; }

    /// Linear light after exposure at the pixel's centre, alpha 1; a function of the place in the whole picture alone.
    [[nodiscard]] Vec4f at(int x_px, int y_px) const;

private:
    const shading::Environment* environment_ = nullptr;
    ViewRays rays_;  ///< in the image's frame
    double width_ = 1, height_ = 1;
    float exposure_ = 1;
};

}  // namespace halflit::raster
