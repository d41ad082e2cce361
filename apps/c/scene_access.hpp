// Ways to read and to change a scene: each takes its lock, and a change waits for no frame but is refused.
#pragma once

#include "apps/c/boundary.hpp"
#include "apps/c/scene_handle.hpp"

#include <mutex>
#include <string>

namespace halflit::c {

/// Runs body(), which reads the scene.
template <class Body>
std::int32_t reading(const char* function, const halflit_scene* scene, std::initializer_list<Pointer> pointers, const Body& body) noexcept {
    if (scene == nullptr) return record_failure(ErrorCode::usage, function, "scene is null");
    return guarded(function, pointers, [&] {
        const std::lock_guard lock(scene->access);
        return body();
    });
}

/// Runs body(), which changes the scene. Fails (usage) while the scene is drawn.
template <class Body>
std::int32_t changing(const char* function, halflit_scene* scene, std::initializer_list<Pointer> pointers, const Body& body) noexcept {
    return reading(function, scene, pointers, [&]() -> Result<void> {
        if (scene->drawing > 0) return fail(ErrorCode::usage, std::string(function) + ": the scene is being drawn");
        return body();
    });
}

/// Checks an index of a list of `count` things that the owner has.
[[nodiscard]] inline Result<std::size_t> check_index(std::int32_t index, std::size_t count, const char* thing,
                                                     const char* owner = "the scene") {
    if (index >= 0 && static_cast<std::size_t>(index) < count) return static_cast<std::size_t>(index);
    return fail(ErrorCode::usage, std::string(thing) + " " + std::to_string(index) + ", but " + owner + " has " + std::to_string(count));
}

/// The same for a list of which some places are free.
[[nodiscard]] inline Result<std::size_t> check_index(std::int32_t index, std::size_t count, const FreePlaces& free, const char* thing) {
    auto at = check_index(index, count, thing);
    if (at && free.has(*at)) return fail(ErrorCode::usage, std::string(thing) + " " + std::to_string(index) + " was removed");
    return at;
}

/// Hands over an index, if the caller wants it.
inline void tell(std::size_t place, std::int32_t* index) {
    if (index != nullptr) *index = static_cast<std::int32_t>(place);
}

}  // namespace halflit::c
