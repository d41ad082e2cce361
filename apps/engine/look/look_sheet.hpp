// The sheet of `halflit look`: labelled views with scale bar, axes and dimensions.
#pragma once

#include "apps/engine/look/part_views.hpp"
#include "apps/engine/pictures/canvas.hpp"

#include <span>
#include <string>
#include <vector>

namespace halflit::engine {

/// Unit of length that people read, of a model whose largest side has this length in the drawn world.
[[nodiscard]] ShownUnit shown_unit(const SceneSource& source, double largest);

/// How views lie beside each other: third angle has the view from above above the front, first angle below it.
enum class Projection : std::uint8_t { third_angle, first_angle };

/// The shot's picture with dimensions, axes and scale.
[[nodiscard]] Image marked_view(const RenderJob& job, const ViewShot& shot, const ViewContent& content);

/// False if views of these names make no drawing: then they come row by row. Sides make one with the front, each of them once.
[[nodiscard]] bool make_drawing(std::span<const std::string> names);

/// Draws dimensions, axes and scale into the shots' pictures, and lays them out: as a drawing, if they make one.
/// shapes: gets the same with the shots' edges in place of their pictures, for a file of vectors; null: it is not wanted.
[[nodiscard]] Result<Image> look_sheet(const RenderJob& job, std::span<const ViewShot> shots, std::span<const ViewContent> contents,
                                       Projection projection, const std::string& footer, std::vector<VectorShape>* shapes = nullptr);

}  // namespace halflit::engine
