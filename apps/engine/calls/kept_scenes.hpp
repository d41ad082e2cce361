// Scenes that were loaded, kept for the next call on the same file.
#pragma once

#include "apps/engine/job/scene_source.hpp"
#include "apps/io/platform/files.hpp"

#include <cstddef>
#include <cstdint>
#include <list>
#include <string>
#include <vector>

namespace halflit::engine {

/// Keeps the last scenes that were asked for. A scene is loaded anew if its file, or a file that it refers to, has another size or another
/// time of change, or if options of loading differ.
class KeptScenes : public SceneKeeper {
public:
    static constexpr std::size_t kMostScenes = 4;
    static constexpr std::size_t kMostBytes = std::size_t{512} << 20;  ///< of all of them, about

    [[nodiscard]] Result<SceneSource> load(const ModelRequest& model) override;

private:
    /// A file as it was; size -1: it is not there.
    struct FileState {
        std::string path;
        std::int64_t size = -1, changed_ns = 0;
        platform::FileId id{};
        friend bool operator==(const FileState&, const FileState&) = default;
    };
    struct Kept {
        std::string scene;
        LoadOptions load;
        std::vector<FileState> files;
        SceneSource source;
        std::size_t bytes = 0;
    };
    [[nodiscard]] static FileState state_of(const std::string& path);
    [[nodiscard]] static bool is_fresh(const Kept& kept);

    std::list<Kept> kept_;  ///< the one that was used last comes first
};

}  // namespace halflit::engine
