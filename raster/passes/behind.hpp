// The picture behind glass that blurs or bends light: drawn before the picture, without such glass and without the background.
#pragma once

#include "halflit/target.hpp"
#include "raster/detail/executor.hpp"
#include "raster/detail/raw_buffer.hpp"
#include "raster/view/view.hpp"
#include "shading/plan/behind_plan.hpp"

namespace halflit::raster {

class Behind {
public:
    /// The linear picture to be drawn into, of the view's whole window.
    Target target(const View& view, StopSignal& stop);
    /// Makes the levels of what was drawn there. exposure: light in the picture is light times this.
    [[nodiscard]] shading::BehindPlan make(const View& view, float exposure, Executor& executor);

private:
    RawBuffer<float> drawn_, levels_;
};

}  // namespace halflit::raster
