#include "apps/halflit/golden/list.hpp"

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/hash_text.hpp"
#include "apps/engine/basics/output_folder.hpp"
#include "apps/engine/job/built_in_scenes.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/files/file_access.hpp"
#include "apps/io/platform/files.hpp"
#include "apps/io/platform/paths.hpp"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>

namespace halflit::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kListName = "golden.json";
constexpr const char* kHashesName = "hashes.txt";
constexpr const char* kCamerasName = "cameras.txt";
constexpr const char* kSchema = "halflit.golden-list/1";
constexpr int kMaxDepth = 16;
constexpr std::size_t kMaxListBytes = std::size_t{16} << 20;

bool is_name_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
}

bool is_name(const std::string& text) {
    return !text.empty() && text.size() <= 200 && text[0] != '.' && text[0] != '-' &&
           std::all_of(text.begin(), text.end(), is_name_character);
}

/// Reads the values of one place in the list; its first error stays.
class Place {
public:
    Place(const Json& object, std::string name) : object_(object), name_(std::move(name)) {}

    [[nodiscard]] tl::unexpected<Error> expected(const std::string& key, const std::string& what) const {
        return fail(ErrorCode::bad_input, fmt::format("{}{}: expected {}, found {}", name_.empty() ? "" : name_ + ".", key, what,
                                                      object_.contains(key) ? printable(object_[key].dump()).substr(0, 80) : "nothing"));
    }
    [[nodiscard]] Result<void> check_keys(std::initializer_list<const char*> known) const {
        if (!object_.is_object()) return fail(ErrorCode::bad_input, (name_.empty() ? "" : name_ + ": ") + "expected an object");
        for (const auto& [key, value] : object_.items())
            if (std::find(known.begin(), known.end(), key) == known.end())
                return fail(ErrorCode::bad_input, fmt::format("{}unknown key \"{}\", expected {}", name_.empty() ? "" : name_ + ": ",
                                                              printable(key), fmt::join(known, ", ")));
        return {};
    }
    [[nodiscard]] const Json* find(const char* key) const { return object_.contains(key) ? &object_[key] : nullptr; }

private:
    const Json& object_;
    std::string name_;
};

Result<GoldenScene> scene_of(const Json& json, std::size_t index) {
    const Place place(json, fmt::format("scenes[{}]", index));
    if (const auto checked = place.check_keys({"name", "scene", "flags", "max", "max_share"}); !checked)
        return tl::unexpected(checked.error());
    GoldenScene scene;
    const Json *name = place.find("name"), *path = place.find("scene"), *flags = place.find("flags");
    if (name == nullptr || !name->is_string() || !is_name(name->get<std::string>()))
        return place.expected("name", "letters, digits, '-', '_' and '.', beginning with a letter, a digit or '_'");
    scene.name = name->get<std::string>();
    if (path == nullptr || !path->is_string() || path->get<std::string>().empty())
        return place.expected("scene", "a path relative to the list, or a built-in scene");
    scene.scene = path->get<std::string>();
    if (flags != nullptr) {
        if (!flags->is_array() || !std::all_of(flags->begin(), flags->end(), [](const Json& flag) { return flag.is_string(); }))
            return place.expected("flags", "a list of strings");
        scene.flags = flags->get<std::vector<std::string>>();
    }
    if (const Json* max = place.find("max"); max != nullptr) {
        if (!max->is_number_unsigned() || max->get<std::uint64_t>() > 255) return place.expected("max", "a whole number from 0 to 255");
        scene.max_codes = max->get<int>();
    }
    if (const Json* share = place.find("max_share"); share != nullptr) {
        if (!share->is_number() || !(share->get<double>() >= 0 && share->get<double>() <= 1))
            return place.expected("max_share", "a number from 0 to 1");
        scene.max_share = share->get<double>();
    }
    return scene;
}

Result<std::vector<GoldenScene>> scenes_of(const std::string& text) {
    Json json;
    try {
        json = Json::parse(text, [&](int depth, Json::parse_event_t, Json&) {
            if (depth > kMaxDepth) throw std::length_error("nested deeper than 16 levels");
            return true;
        });
    } catch (const std::length_error& error) {
        return fail(ErrorCode::bad_input, error.what());
    } catch (const Json::exception& exception) {
        const std::string what = exception.what();  // "[json.exception.parse_error.101] parse error at line 3, column 5: ..."
        return fail(ErrorCode::bad_input, printable(what.substr(std::min(what.find("] ") + 2, what.size()))));
    }
    const Place place(json, "");
    if (const auto checked = place.check_keys({"schema", "scenes"}); !checked) return tl::unexpected(checked.error());
    const Json *schema = place.find("schema"), *list = place.find("scenes");
    if (schema == nullptr || *schema != kSchema) return place.expected("schema", fmt::format("\"{}\"", kSchema));
    if (list == nullptr || !list->is_array() || list->empty()) return place.expected("scenes", "a list of scenes, one or more");
    std::vector<GoldenScene> scenes;
    std::set<std::string> names;
    for (const Json& one : *list) {
        auto scene = scene_of(one, scenes.size());
        if (!scene) return tl::unexpected(scene.error());
        if (!names.insert(scene->name).second)
            return fail(ErrorCode::bad_input, fmt::format("scenes[{}].name: \"{}\" is used twice", scenes.size(), scene->name));
        scenes.push_back(std::move(*scene));
    }
    return scenes;
}

Result<std::string> read_text(const std::string& path) {
    const auto bytes = io::read_file(path, kMaxListBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

/// Lines "HASH  NAME", and after another space `rest`; those that begin with # are comments. add(name, hash, rest) takes each.
template <class Add>
Result<void> each_line(const std::string& text, const Add& add) {
    int number = 0;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        std::string line = text.substr(start, end - start);
        start = end + 1;
        ++number;
        if (line.ends_with('\r')) line.pop_back();
        if (line.empty() || line[0] == '#') continue;
        const std::size_t space = std::min(line.find(' ', 18), line.size());
        if (line.size() <= 18 || line.find_first_not_of("0123456789abcdef") != 16 || line.substr(16, 2) != "  " ||
            !is_name(line.substr(18, space - 18)))
            return fail(ErrorCode::bad_input, fmt::format("line {}: expected 16 hexadecimal digits, two spaces and a new name, found '{}'",
                                                          number, printable(line)));
        const auto added = add(line.substr(18, space - 18), line.substr(0, 16), line.substr(std::min(space + 1, line.size())));
        if (!added) return fail(ErrorCode::bad_input, fmt::format("line {}: {}", number, added.error().message));
    }
    return {};
}

tl::unexpected<Error> not_new(const std::string& name) {
    return fail(ErrorCode::bad_input, fmt::format("expected a new name, found '{}' again", printable(name)));
}

Result<std::map<std::string, std::string>> hashes_of(const std::string& text) {
    std::map<std::string, std::string> hashes;
    const auto read = each_line(text, [&](const std::string& name, const std::string& hash, const std::string& rest) -> Result<void> {
        if (!rest.empty()) return fail(ErrorCode::bad_input, fmt::format("expected nothing after the name, found '{}'", printable(rest)));
        if (!hashes.emplace(name, hash).second) return not_new(name);
        return {};
    });
    if (!read) return tl::unexpected(read.error());
    return hashes;
}

Result<std::map<std::string, GoldenCamera>> cameras_of(const std::string& text) {
    std::map<std::string, GoldenCamera> cameras;
    const auto read = each_line(text, [&](const std::string& name, const std::string& flags, const std::string& rest) -> Result<void> {
        const auto view = parse_kept_view(rest);
        if (!view) return tl::unexpected(view.error());
        if (!cameras.emplace(name, GoldenCamera{flags, *view}).second) return not_new(name);
        return {};
    });
    if (!read) return tl::unexpected(read.error());
    return cameras;
}

/// Reads a file of lines beside golden.json. A missing one leaves `target` as it is.
template <class Target, class Parse>
Result<void> read_lines(const std::string& path, Target& target, const Parse& parse) {
    if (!is_file(path) && !is_folder(path)) return {};
    const auto text = read_text(path);
    if (!text) return tl::unexpected(text.error());
    auto parsed = parse(*text);
    if (!parsed) return fail(parsed.error().code, printable(path) + ": " + parsed.error().message);
    target = std::move(*parsed);
    return {};
}

/// The path below the folder, which must not leave it.
Result<std::string> confined(const std::string& folder, const std::string& relative, const char* what) {
    const fs::path path = platform::to_path(relative);
    const bool climbs = std::any_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
    const bool odd = platform::is_absolute(relative) || !platform::fault_of_path(relative).empty();
    const fs::path base = platform::to_path(platform::whole_path(folder)),
                   whole = odd ? fs::path() : platform::to_path(platform::whole_path(path_in(folder, relative)));
    const bool below = !base.empty() && std::mismatch(base.begin(), base.end(), whole.begin(), whole.end()).first == base.end();
    if (path.empty() || odd || climbs || !below)
        return fail(ErrorCode::bad_input,
                    fmt::format("{}: expected a path within the folder of {}, found '{}'", what, kListName, printable(relative)));
    return path_in(folder, relative);
}

std::string quoted_for_shell(const std::string& word) {
    const bool plain = !word.empty() && word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_=./:,+") ==
                                            std::string::npos;
    if (plain) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

/// Names for the models' paths: the stem, or the path with '-' for '/' if two have the same stem.
std::vector<std::string> names_for(const std::vector<std::string>& paths) {
    std::vector<std::string> names;
    std::set<std::string> used;
    for (const std::string& path : paths) {
        const auto cleaned = [](std::string name) {
            for (char& c : name)
                if (!is_name_character(c)) c = '-';
            while (!name.empty() && (name[0] == '-' || name[0] == '.')) name.erase(0, 1);
            return name.empty() ? std::string("scene") : name.substr(0, 180);
        };
        std::string name = cleaned(platform::to_name(platform::to_path(path).stem()));
        if (used.contains(name)) name = cleaned(platform::to_name(platform::to_path(path).replace_extension()));
        const std::string first = name;
        for (int i = 2; !used.insert(name).second; ++i) name = fmt::format("{}-{}", first, i);
        names.push_back(name);
    }
    return names;
}

Result<std::vector<std::string>> models_below(const std::string& folder) {
    std::vector<std::string> paths;
    std::error_code error;
    const fs::path top = platform::to_path(folder);
    for (fs::recursive_directory_iterator it(top, error), end; !error && it != end; it.increment(error)) {
        const std::string name = platform::to_name(it->path().filename());
        if (it->is_directory(error) && (name.starts_with('.') || name == "report")) it.disable_recursion_pending();
        if (it->is_regular_file(error) && is_model_name(name)) paths.push_back(platform::to_name(it->path().lexically_relative(top)));
    }
    if (error) return fail(ErrorCode::io, printable(folder) + ": " + error.message());
    // The upper ones first, so that they get the short names.
    std::sort(paths.begin(), paths.end(), [](const std::string& a, const std::string& b) {
        const auto depth = [](const std::string& path) { return std::count(path.begin(), path.end(), '/'); };
        return std::pair(depth(a), a) < std::pair(depth(b), b);
    });
    return paths;
}

}  // namespace

std::string flags_hash(const GoldenScene& scene) {
    std::string text;
    for (const std::string& flag : scene.flags) text += flag + '\n';
    return hash_text({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string GoldenList::picture(const std::string& name) const { return path_in(folder, name + ".png"); }

std::string GoldenList::hash(const std::string& name) const {
    const auto found = hashes.find(name);
    return found == hashes.end() ? "" : found->second;
}

const KeptView* GoldenList::camera(const GoldenScene& scene) const {
    const auto found = cameras.find(scene.name);
    return found == cameras.end() || found->second.flags != flags_hash(scene) ? nullptr : &found->second.view;
}

bool has_golden_list(const std::string& folder) {
    std::error_code ignored;
    return fs::exists(platform::to_path(path_in(folder, kListName)), ignored);
}

Result<GoldenList> read_golden_list(const std::string& folder) {
    const std::string list_path = path_in(folder, kListName);
    const auto text = read_text(list_path);
    if (!text) return tl::unexpected(text.error());
    auto scenes = scenes_of(*text);
    if (!scenes) return fail(scenes.error().code, printable(list_path) + ": " + scenes.error().message);
    GoldenList list{folder, std::move(*scenes), {}, {}};
    if (const auto read = read_lines(path_in(folder, kHashesName), list.hashes, hashes_of); !read) return tl::unexpected(read.error());
    if (const auto read = read_lines(path_in(folder, kCamerasName), list.cameras, cameras_of); !read) return tl::unexpected(read.error());
    return list;
}

Result<void> make_golden_list(const std::string& folder) {
    const auto models = models_below(folder);
    if (!models) return tl::unexpected(models.error());
    const std::string path = path_in(folder, kListName);
    if (models->empty()) return fail(ErrorCode::io, printable(path) + ": does not exist, and there is no model to make it from");
    const std::vector<std::string> names = names_for(*models);
    Json list{{"schema", kSchema}, {"scenes", Json::array()}};
    for (std::size_t i = 0; i < names.size(); ++i)
        list["scenes"].push_back({{"name", names[i]}, {"scene", (*models)[i]}, {"flags", {"--size", "640x360"}}});
    return write_text(path, to_text(list));
}

Result<void> write_golden_hashes(const GoldenList& list) {
    std::string text = "# Hashes of the pixels of the expected pictures; halflit golden update writes this file.\n";
    for (const auto& [name, hash] : list.hashes) text += fmt::format("{}  {}\n", hash, name);
    return write_text(path_in(list.folder, kHashesName), text);
}

Result<void> write_golden_cameras(const GoldenList& list) {
    std::string text = "# Hash of the flags, name and camera of each picture that was framed; halflit golden update writes this file.\n";
    for (const auto& [name, camera] : list.cameras) text += fmt::format("{}  {} {}\n", camera.flags, name, kept_view_text(camera.view));
    return write_text(path_in(list.folder, kCamerasName), text);
}

Result<std::vector<const GoldenScene*>> chosen_scenes(const GoldenList& list, const std::vector<std::string>& names) {
    std::vector<const GoldenScene*> chosen;
    for (const std::string& name : names)
        if (std::none_of(list.scenes.begin(), list.scenes.end(), [&](const GoldenScene& scene) { return scene.name == name; }))
            return fail(ErrorCode::usage, fmt::format("NAME: expected a name of {}, found '{}'", printable(path_in(list.folder, kListName)),
                                                      printable(name)));
    for (const GoldenScene& scene : list.scenes)
        if (names.empty() || std::find(names.begin(), names.end(), scene.name) != names.end()) chosen.push_back(&scene);
    return chosen;
}

Result<RenderOptions> golden_options(const GoldenList& list, const GoldenScene& scene) {
    auto options = parse_render_flags(scene.flags);
    if (!options) return fail(ErrorCode::bad_input, "flags: " + options.error().message);
    options->scene = scene.scene;
    if (!is_built_in_name(scene.scene)) {
        auto path = confined(list.folder, scene.scene, "scene");
        if (!path) return tl::unexpected(path.error());
        options->scene = std::move(*path);
    }
    if (!options->environment.empty() && options->environment != "sky") {
        auto path = confined(list.folder, options->environment, "--env");
        if (!path) return tl::unexpected(path.error());
        options->environment = std::move(*path);
    }
    if (!options->camera_file.empty()) {
        auto path = confined(list.folder, options->camera_file, "--camera-file");
        if (!path) return tl::unexpected(path.error());
        options->camera_file = std::move(*path);
    }
    for (std::string& folder : options->load.allow_external) {
        auto path = confined(list.folder, folder, "--allow-external");
        if (!path) return tl::unexpected(path.error());
        folder = std::move(*path);
    }
    if (const KeptView* const camera = list.camera(scene)) options->kept_view = *camera;
    return options;
}

std::string golden_command_line(const GoldenScene& scene) {
    std::string line = fmt::format("halflit render {}", quoted_for_shell(scene.scene));
    for (const std::string& flag : scene.flags) line += fmt::format(" {}", quoted_for_shell(flag));
    return fmt::format("{} -o {}.png", line, scene.name);
}

}  // namespace halflit::cli
