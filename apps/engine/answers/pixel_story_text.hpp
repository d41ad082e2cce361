// A pixel's story as lines for people.
#pragma once

#include "apps/engine/job/scene_source.hpp"
#include "halflit/explain.hpp"

#include <string>
#include <string_view>

namespace halflit::engine {

constexpr std::string_view shows_name(PixelShows shows) {
    constexpr std::string_view kNames[] = {"surface", "splats", "layers", "background"};
    return kNames[static_cast<std::size_t>(shows)];
}
constexpr std::string_view topology_name(Topology topology) {
    constexpr std::string_view kNames[] = {"triangle", "line", "point"};
    return kNames[static_cast<std::size_t>(topology)];
}
constexpr std::string_view background_name(BackgroundKind kind) {
    constexpr std::string_view kNames[] = {"transparent", "color", "environment"};
    return kNames[static_cast<std::size_t>(kind)];
}

/// One fact a line, with names escaped (see printable).
[[nodiscard]] std::string story_text(const PixelStory& story, const NameOfInstance& name = {});

}  // namespace halflit::engine
