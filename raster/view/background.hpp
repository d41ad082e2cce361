// Background from an environment: its light along the view ray of each pixel.
#pragma once

#include "raster/view/projection.hpp"
#include "shading/environment.hpp"

namespace halflit::raster {

class Background {
public:
    Background() = default;
    /// width, height: of the whole picture, pixels. Requires: `environment` has its image (Environment::rgb) and outlives this object.
    Background(const Environment& environment, const Camera& camera, int width, int height, float exposure);

    /// False if there is no environment; at() must not be called then.
    [[nodiscard]] explicit operator bool() const { return environment_ != nullptr; }

    /// Linear light after exposure at the pixel's centre, alpha 1. Depends only on the pixel's position in the whole picture.
    [[nodiscard]] Vec4f at(int x_px, int y_px) const;

private:
    const Environment* environment_ = nullptr;
    ViewRays rays_;  ///< in the coordinate frame of the environment's image
    double width_ = 1, height_ = 1;
    float exposure_ = 1;
};

}  // namespace halflit::raster
