#include "raster/view/background.hpp"

#include "sh/equirect.hpp"

namespace halflit::raster {

Background::Background(const Environment& environment, const Camera& camera, int width, int height, float exposure)
    : environment_(&environment),
      rays_(view_rays(camera, static_cast<float>(width) / static_cast<float>(height))),
      width_(width),
      height_(height),
      exposure_(exposure) {
    const sh::Rotation back = sh::inverse(sh::rotation_about_y(environment.rotate_rad));
    rays_ = {back * rays_.middle, back * rays_.right, back * rays_.up};
}

Vec4f Background::at(int x_px, int y_px) const {
    const double right = (2.0 * x_px + 1.0) / width_ - 1.0, up = 1.0 - (2.0 * y_px + 1.0) / height_;
    const sh::EquirectPoint point = sh::equirect_point((rays_.middle + rays_.right * right) + rays_.up * up);
    // Bilinear between pixel centres. Columns wrap around; rows end at the first and the last.
    const int w = environment_->width, h = environment_->height;
    // x, y: their whole parts are the right column and the lower row of the four pixels; not negative.
    const double x = point.u * w + 0.5, y = point.v * h + 0.5;
    const int right_column = static_cast<int>(x), lower_row = static_cast<int>(y);
    const int x1 = right_column % w, x0 = (right_column + w - 1) % w;
    const int y1 = lower_row < h ? lower_row : h - 1, y0 = lower_row > 0 ? lower_row - 1 : 0;
    const double fx = x - right_column, fy = y - lower_row;
    const sh::EquirectView image{w, h, environment_->rgb};
    const Vec3d upper = image.at(x0, y0) * (1.0 - fx) + image.at(x1, y0) * fx,
                lower = image.at(x0, y1) * (1.0 - fx) + image.at(x1, y1) * fx;
    const Vec3d light = upper * (1.0 - fy) + lower * fy;
    return {static_cast<float>(light.x) * exposure_, static_cast<float>(light.y) * exposure_, static_cast<float>(light.z) * exposure_,
            1.0f};
}

}  // namespace halflit::raster
