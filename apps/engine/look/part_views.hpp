// Counts the pixels by which views show a model's parts, and tells whether a view can be relied on.
#pragma once

#include "apps/engine/look/view_shot.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace halflit::engine {

/// Pixels [x0, x1) x [y0, y1); none if x0 == x1.
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    void add(int x, int y);
    [[nodiscard]] bool empty() const { return x0 == x1; }
};

/// A part in a view. A pixel shows what its first sample shows; what is transparent does not count, and hides nothing.
struct PartInView {
    int part = 0;             ///< index into Parts::list()
    std::int64_t pixels = 0;  ///< that show it
    PixelBox box;             ///< around them
    /// Pixels that would show it if it stood alone; none: not drawn, as there are too many parts.
    std::optional<std::int64_t> alone;
    int hidden_by = -1;              ///< the part that most of the others show; -1: none, or not known
    std::int64_t hidden_pixels = 0;  ///< that show that part
};

/// Reasons not to rely on a view.
struct ViewFaults {
    bool blank = false;    ///< no pixel shows the model, and it is not seen edge-on
    bool cropped = false;  ///< a vertex lies beside the picture
    bool cut = false;      ///< a vertex lies before the near plane or behind the viewer, or beyond the far plane
    bool inside = false;   ///< the viewer is within the box around the model
    bool tiny = false;     ///< what is seen spans less than a sixth of the picture's width and of its height
    [[nodiscard]] bool any() const { return blank || cropped || cut || inside || tiny; }
    /// "blank", "cropped" and so on.
    [[nodiscard]] std::vector<std::string> names() const;
};

struct ViewContent {
    std::int64_t pixels = 0;  ///< that show the model
    PixelBox box;             ///< around them
    bool edge_on = false;     ///< no pixel shows the model, which is flat and seen along its plane
    ViewFaults faults;
    std::vector<PartInView> parts;  ///< of all parts, by their numbers
};

/// Counts what the shots show. Parts are drawn alone, without colours, if there are at most `most_alone` of them. Leaves the scene as it
/// was.
[[nodiscard]] Result<std::vector<ViewContent>> count_parts(RenderJob& job, Renderer& renderer, std::span<const ViewShot> shots,
                                                           std::size_t most_alone);

}  // namespace halflit::engine
