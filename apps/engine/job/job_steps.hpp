// The steps that make a job, in their order. Each takes the part of the request that it reads.
#pragma once

#include "apps/engine/job/render_job.hpp"

namespace halflit::engine {

/// LoadOptions::detail_px before the scene is loaded: of a model that is framed, at its nearest point.
[[nodiscard]] double framed_detail(const ViewRequest& request);

/// Finds the parts that the flags name, sets RenderJob::looks and hides instances. A part that several flags name is hidden rather than
/// highlighted, and highlighted rather than a ghost. Fails (usage) for a name that finds no part, and where no part is left.
[[nodiscard]] Result<void> choose_parts(RenderJob& job, const PartFlags& flags);

/// The box of the scene in 33 poses, from time 0 to the animation's end at even distances. Leaves the scene in the pose of time 0.
[[nodiscard]] Result<Bounds> swept_bounds(RenderJob& job);

/// Cuts the job's scene by the flags' planes, and adds lines of choices and warnings. Nodes of a file are parts.
[[nodiscard]] Result<void> cut_job(RenderJob& job, const ContentRequest& request);

/// Paints ghosts, highlighted and dimmed parts, caps of sections too. Vertex colours go with the first highlight.
void paint_parts(RenderJob& job, const PartFlags& flags);

/// Sets the light to begin with, and what the flags say of the rest: RenderJob::film. Settings of the job decide what an environment keeps.
[[nodiscard]] Result<void> begin_light(RenderJob& job, const LightRequest& request);

/// Gives a light the size that the flags say, unless it has one.
void soften(Light& light, const Film& film);

/// The view that the flags ask for, and the light that was begun. Sets the views and bounds of RenderJob::film. frame: a view of the whole
/// scene or of its parts is asked for.
[[nodiscard]] Result<PictureRequest> picture_request(RenderJob& job, const ViewRequest& request, const FilmOptions& film, bool frame);

/// Keeps what was chosen for people to read, and warns where the usual side shows nothing.
void tell_view(RenderJob& job, const ViewSettings& drawn, ViewReason reason);

/// LoadOptions::detail_px that the job's views need of what they show, of a model whose whole box has this diagonal.
[[nodiscard]] double seen_detail(const RenderJob& job, double diagonal);

/// Adds lines of camera, lights, exposure and background, and warns of what a view of the whole leaves out. given: the flags as they were
/// given.
void tell_choices(RenderJob& job, const RenderOptions& given);

}  // namespace halflit::engine
