// A folder of golden pictures: golden.json lists scenes and the flags to draw them with, NAME.png is the expected picture of each,
// hashes.txt has the hashes of their pixels, and cameras.txt the cameras of those that were framed. docs/golden.md describes the files.
#pragma once

#include "apps/engine/pictures/picture_diff.hpp"
#include "apps/engine/request/render_options.hpp"
#include "apps/halflit/program/engine.hpp"
#include "halflit/error.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace halflit::cli {

struct GoldenScene {
    std::string name;                ///< letters, digits, '-', '_' and '.', not at the start
    std::string scene;               ///< a path relative to the folder, or a built-in scene
    std::vector<std::string> flags;  ///< of halflit render
    std::optional<int> max_codes;
    std::optional<double> max_share;
};

/// A camera that was chosen for a scene, and the flags that it was chosen by.
struct GoldenCamera {
    std::string flags;  ///< 16 hexadecimal digits: the hash of GoldenScene::flags
    KeptView view;
    friend bool operator==(const GoldenCamera&, const GoldenCamera&) = default;
};

/// The hash of a scene's flags, as GoldenCamera has it.
[[nodiscard]] std::string flags_hash(const GoldenScene& scene);

struct GoldenList {
    std::string folder;
    std::vector<GoldenScene> scenes;
    std::map<std::string, std::string> hashes;    ///< 16 hexadecimal digits by name
    std::map<std::string, GoldenCamera> cameras;  ///< by name

    /// "FOLDER/NAME.png"
    [[nodiscard]] std::string picture(const std::string& name) const;
    /// The recorded hash; empty if there is none.
    [[nodiscard]] std::string hash(const std::string& name) const;
    /// The camera that is recorded for the scene with these flags; null if there is none.
    [[nodiscard]] const KeptView* camera(const GoldenScene& scene) const;
};

/// True if the folder has a golden.json.
[[nodiscard]] bool has_golden_list(const std::string& folder);

/// Reads golden.json, and hashes.txt and cameras.txt, which may be missing. Errors name the file and the place in it.
[[nodiscard]] Result<GoldenList> read_golden_list(const std::string& folder);

/// Writes a golden.json with every model (by its name: .glb, .gltf, .stl, .ply, .obj, .3mf) below the folder, except in hidden folders and
/// those named report.
Result<void> make_golden_list(const std::string& folder);

/// Writes hashes.txt, sorted by name.
Result<void> write_golden_hashes(const GoldenList& list);
/// Writes cameras.txt, sorted by name.
Result<void> write_golden_cameras(const GoldenList& list);

/// The scenes of these names; without names, all. An unknown name is a usage error.
[[nodiscard]] Result<std::vector<const GoldenScene*>> chosen_scenes(const GoldenList& list, const std::vector<std::string>& names);

/// The flags' values with the scene's path, and with the camera that was recorded for these flags. Scene, environment and --allow-external
/// must be within the folder, symbolic links resolved.
[[nodiscard]] Result<RenderOptions> golden_options(const GoldenList& list, const GoldenScene& scene);

/// The command that draws the scene, for a shell in the list's folder.
[[nodiscard]] std::string golden_command_line(const GoldenScene& scene);

}  // namespace halflit::cli
