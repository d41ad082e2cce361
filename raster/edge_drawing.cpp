// The last step of a frame that shows edges: finds them, and paints their lines over the picture.
#include "raster/passes/paint_lines.hpp"
#include "raster/renderer_impl.hpp"
#include "raster/scene/mean_color.hpp"

#include <vector>

namespace halflit {

using namespace raster;

/// Data of the edges that are kept between frames.
struct Renderer::Impl::EdgeDrawing {
    ModelEdges edges;
    SceneRevision of;  ///< the scene that they were found in
    float angle_deg = kNotFound;
    bool contrast = false;
    Impl visible;  ///< draws which triangle each pixel's middle shows
    std::vector<std::uint32_t> instance, triangle;
    MemoryShare memory;

    static constexpr float kNotFound = -1.0f;
};

Renderer::Impl::Impl() { plan_memory.shadow_texels.emplace(); }
Renderer::Impl::~Impl() = default;

Result<void> Renderer::Impl::draw_edges(const PreparedData& scene, const Camera& camera, const Settings& settings, const Output& output,
                                        std::vector<DrawnEdge>* found, int width, int height, const Execution& execution, Isa isa) {
    if (edge_drawing == nullptr) edge_drawing = std::make_unique<EdgeDrawing>();
    EdgeDrawing& drawing = *edge_drawing;
    const Region part = seen_region(plan.written, static_cast<double>(settings.edge_width), width, height);
    const std::size_t pixels = static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height);
    constexpr std::uint64_t kMostTriangles = 1u << 30;  // numbers are uint32
    if (scene.triangle_count() > kMostTriangles) return fail(ErrorCode::limit, "edges: expected at most 2^30 triangles over all instances");
    const auto hold = [&](std::uint64_t bytes) { drawing.memory.hold(executor.stop(), static_cast<std::size_t>(bytes + pixels * 8)); };
    // Mean luminance below which a surface has light lines. In the studio, of a surface at this limit nine tenths of the pixels are above
    // 36 codes, where black lines show, and nine tenths below 121, where light lines do.
    constexpr double kDark = 0.2;
    const bool contrast = settings.edge_contrast && settings.edge_color_linear == Vec3f{};
    if (!(drawing.of == scene.revision()) || drawing.angle_deg != settings.edge_angle_deg || drawing.contrast != contrast) {
        drawing.angle_deg = EdgeDrawing::kNotFound;  // until the search has ended
        hold(ModelEdges::most_bytes(scene.scene()));
        drawing.edges.find(scene.scene(), static_cast<double>(settings.edge_angle_deg),
                           [&](const Instance& instance) { return contrast && mean_luminance(scene.scene(), instance) < kDark; });
        drawing.contrast = contrast;
        drawing.of = scene.revision();
        drawing.angle_deg = settings.edge_angle_deg;
    }
    hold(drawing.edges.bytes());
    drawing.instance.resize(pixels);
    drawing.triangle.resize(pixels);
    Settings plain;  // one sample, in the pixel's middle
    plain.point_size = settings.point_size;
    plain.line_width = settings.line_width;
    plain.region = part;
    Target target{width, height};
    target.region_alone = true;
    target.instance = drawing.instance.data();
    target.triangle = drawing.triangle.data();
    Execution silent = execution;
    silent.on_tile = {}, silent.progress = {};
    if (execution.memory_limit > 0) {
        const std::size_t held = executor.stop().memory();
        silent.memory_limit = execution.memory_limit > held ? execution.memory_limit - held : 1;
    }
    const auto drawn = drawing.visible.render(scene, {}, camera, plain, target, silent, isa, {});
    if (!drawn) return tl::unexpected<Error>(drawn.error());
    const PixelTriangles seen{width, height, part, drawing.instance.data(), drawing.triangle.data()};
    hold(drawing.edges.bytes() + drawing.visible.executor.stop().memory());
    MemoryShare of_lines;
    const std::vector<EdgeLine> lines = edge_lines(drawing.edges, camera, seen, plan.written, settings, executor, of_lines);
    for (std::size_t i = 0; found != nullptr && i < lines.size(); ++i) {
        const EdgeLine& line = lines[i];
        const auto x = [&](double t) { return line.x0 + (line.x1 - line.x0) * t; };
        const auto y = [&](double t) { return line.y0 + (line.y1 - line.y0) * t; };
        found->push_back({x(line.t0), y(line.t0), x(line.t1), y(line.t1), line.hidden});
    }
    paint_lines(lines, settings, plan.written, output, shading::shade_kernels(isa), executor);
    return {};
}

}  // namespace halflit
