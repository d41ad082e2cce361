// The last step of a frame that shows edges: finds them, and paints their lines over the picture.
#include "raster/passes/paint_lines.hpp"
#include "raster/renderer_impl.hpp"

#include <vector>

namespace halflit {

using namespace raster;

/// What is kept of the edges between frames.
struct Renderer::Impl::EdgeDrawing {
    ModelEdges edges;
    SceneRevision of;  ///< the scene that they were found in
    float angle_deg = -1.0f;
    Impl visible;  ///< draws which triangle each pixel's middle shows
    std::vector<std::uint32_t> instance, triangle;
};

Renderer::Impl::Impl() { plan_memory.shadow_texels.emplace(); }
Renderer::Impl::~Impl() = default;

Result<void> Renderer::Impl::draw_edges(const PreparedData& scene, const Camera& camera, const Settings& settings, const Output& output,
                                        int width, int height, const Execution& execution, Isa isa) {
    if (edge_drawing == nullptr) edge_drawing = std::make_unique<EdgeDrawing>();
    EdgeDrawing& drawing = *edge_drawing;
    if (!(drawing.of == scene.revision()) || drawing.angle_deg != settings.edge_angle_deg) {
        drawing.edges.find(scene.scene(), static_cast<double>(settings.edge_angle_deg));
        drawing.of = scene.revision();
        drawing.angle_deg = settings.edge_angle_deg;
    }
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    drawing.instance.resize(pixels);
    drawing.triangle.resize(pixels);
    Settings plain;  // one sample, in the pixel's middle
    plain.point_size = settings.point_size;
    plain.line_width = settings.line_width;
    Target target{width, height};
    target.instance = drawing.instance.data();
    target.triangle = drawing.triangle.data();
    Execution silent = execution;
    silent.on_tile = {}, silent.progress = {};
    const auto drawn = drawing.visible.render(scene, {}, camera, plain, target, silent, isa, {});
    if (!drawn) return tl::unexpected<Error>(drawn.error());
    const SeenTriangles seen{width, height, drawing.instance.data(), drawing.triangle.data()};
    const std::vector<EdgeLine> lines =
        edge_lines(drawing.edges, camera, seen, settings.edges, settings.hidden_edges == HiddenEdges::dashed, executor);
    paint_lines(lines, settings, plan.written, output, shading::shade_kernels(isa), executor);
    return {};
}

}  // namespace halflit
