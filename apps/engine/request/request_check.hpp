// What a request has wrong that can be told before its scene is loaded.
#pragma once

#include "apps/engine/request/render_options.hpp"
#include "halflit/error.hpp"

namespace halflit::engine {

/// Fails (usage) for options that exclude each other, and for values that no scene could have.
[[nodiscard]] Result<void> check_request(const RenderOptions& options);

/// The flags of size and camera alone. views: of --view. region: of the picture.
[[nodiscard]] Result<void> check_view(const ViewRequest& request, const std::vector<GivenView>& views, const Region& region);

/// Fails (limit, usage) for a size or a region that is too large, and a region beyond the picture.
[[nodiscard]] Result<void> check_size(PictureSize size, const Region& region);

/// The flags' settings with the flags' lobe.
[[nodiscard]] Result<Settings> checked_settings(const SettingsRequest& request);

}  // namespace halflit::engine
