#include "apps/io/gltf/animation/animation.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/gltf/build/choices.hpp"
#include "apps/io/gltf/build/placed.hpp"
#include "apps/io/gltf/file/indices.hpp"
#include "sh/time_limit.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace halflit::io::detail {

namespace {

using enum Component;

std::string name_of_channel(int animation, std::size_t channel) { return fmt::format("animations[{}].channels[{}]", animation, channel); }

class ChannelFinder {
public:
    explicit ChannelFinder(Document& document) : document_(document), file_(document.file), use_(document.animations) {}

    void find(int animation) {
        AnimationUse::Used& used = use_.used.emplace_back();
        used.animation = animation;
        std::set<std::tuple<const Property*, int, int>> seen;
        const auto& channels = file_.animations[static_cast<std::size_t>(animation)].channels;
        for (std::size_t c = 0; c < channels.size(); ++c) {
            const std::optional<Slot> slot = slot_of(channels[c], name_of_channel(animation, c));
            if (!slot) continue;
            if (!seen.emplace(slot->property, slot->element, slot->place).second)
                document_.warn(
                    fmt::format("{}.target: another channel moves the same, the last one is drawn", name_of_channel(animation, c)));
            document_.geometry.take(sizeof(AnimationUse::Channel));
            used.channels.push_back({*slot, c});
            note(*slot);
        }
    }

    /// To be called when all are found.
    void finish() {
        if (morphing_meshes_.empty()) return;
        for (std::size_t n = 0; n < file_.nodes.size(); ++n)
            if (const int mesh = file_.nodes[n].mesh; mesh >= 0 && static_cast<std::size_t>(mesh) < morphing_meshes_.size())
                if (morphing_meshes_[static_cast<std::size_t>(mesh)]) use_.morphs[n] = true;
    }

private:
    std::optional<Slot> slot_of(const file::AnimationChannel& channel, const std::string& where) {
        std::optional<Slot> slot;
        if (channel.path == "pointer") {
            const std::string key = where + ".target.extensions.KHR_animation_pointer.pointer";
            if (channel.pointer.empty()) {
                document_.warn(fmt::format("{}: is not there, the channel is left out", key));
                return std::nullopt;
            }
            slot = find_slot(file_, channel.pointer);
            if (!slot || !prepare(*slot)) {
                document_.warn(fmt::format("{}: \"{}\" is not animated, left out", key, printable(channel.pointer, 120)));
                return std::nullopt;
            }
            return slot;
        }
        if (channel.node < 0) return std::nullopt;  // for an extension, which may name something else
        slot = node_slot(file_, channel.node, channel.path);
        if (!slot) return std::nullopt;  // a fault, or warned of
        if (prepare(*slot)) return slot;
        if (slot->part() == Part::weights)
            document_.warn(fmt::format("{}.target.path: node {} has no morph targets, left out", where, channel.node));
        else
            document_.warn(fmt::format("{}.target.path: node {} has a matrix, and is drawn by that", where, channel.node));
        return std::nullopt;
    }

    /// Gives the element the numbers that are to be written. False if it cannot have them.
    bool prepare(Slot& slot) {
        const auto element = static_cast<std::size_t>(slot.element);
        const bool of_node = slot.property->list == "/nodes";
        if (slot.part() == Part::transform && file_.nodes[element].transform < 0) {
            document_.geometry.take(sizeof(file::Transform));
            file_.nodes[element].transform = static_cast<int>(file_.transforms.size());
            file_.transforms.emplace_back();
        }
        if (slot.part() == Part::weights) {
            const int mesh = of_node ? file_.nodes[element].mesh : slot.element;
            slot.count = morph_targets(mesh);
            if (slot.count == 0) return false;
            if (of_node)
                own_weights(file_.nodes[element], slot.count);
            else if (file_.meshes[element].weights.size() != slot.count)
                resize(file_.meshes[element].weights, slot.count);
        }
        return locate(file_, slot) != nullptr;
    }

    [[nodiscard]] std::size_t morph_targets(int mesh) const {
        if (mesh < 0 || static_cast<std::size_t>(mesh) >= file_.meshes.size()) return 0;
        const auto& primitives = file_.meshes[static_cast<std::size_t>(mesh)].primitives;
        return primitives.empty() ? 0 : primitives.front().targets.size();
    }

    void resize(std::vector<double>& weights, std::size_t count) {
        document_.geometry.take(count * sizeof(double));
        weights.resize(count, 0.0);
    }

    /// Gives a node a list of weights of its own: what it has, or its mesh's.
    void own_weights(file::Node& node, std::size_t count) {
        if (node.weights.count == count) return;
        document_.geometry.take(count * sizeof(double));
        std::vector<double> weights = file_.meshes[static_cast<std::size_t>(node.mesh)].weights;
        if (node.weights.count > 0)
            weights.assign(file_.weights.begin() + node.weights.first, file_.weights.begin() + node.weights.first + node.weights.count);
        weights.resize(count, 0.0);
        node.weights = {static_cast<std::uint32_t>(file_.weights.size()), static_cast<std::uint32_t>(count)};
        file_.weights.insert(file_.weights.end(), weights.begin(), weights.end());
    }

    void note(const Slot& slot) {
        const bool of_node = slot.property->list == "/nodes";
        if (slot.part() == Part::weights) {
            use_.morphs.resize(file_.nodes.size(), false);
            morphing_meshes_.resize(file_.meshes.size(), false);
            (of_node ? use_.morphs : morphing_meshes_)[static_cast<std::size_t>(slot.element)] = true;
        }
        if (slot.part() == Part::visibility) {
            use_.hides.resize(file_.nodes.size(), false);
            use_.hides[static_cast<std::size_t>(slot.element)] = true;
        }
    }

    Document& document_;
    file::File& file_;
    AnimationUse& use_;
    std::vector<bool> morphing_meshes_;  // whose own weights are animated
};

class TrackReader {
public:
    TrackReader(Document& document, const std::vector<Accessor>& accessors) : document_(document), accessors_(accessors) {}

    /// Nothing if there are no keys.
    std::optional<Track> read(int animation, std::size_t channel_index, const Slot& slot) {
        const file::Animation& source = document_.file.animations[static_cast<std::size_t>(animation)];
        const file::AnimationChannel& channel = source.channels[channel_index];
        const file::AnimationSampler& sampler = element(source.samplers, channel.sampler, "samplers");  // null is none
        const std::string where = fmt::format("animations[{}].samplers[{}]", animation, channel.sampler);
        Track track;
        track.interpolation = sampler.interpolation;
        track.rotation = slot.is_rotation();
        track.count = slot.count;
        if (slot.is_truth() && track.interpolation != file::Interpolation::step) {
            document_.warn(fmt::format("{}.interpolation: expected STEP for true or false, read as STEP", where));
            track.interpolation = file::Interpolation::step;
        }
        if (!read_times(where + ".input", sampler.input, track)) return std::nullopt;
        if (track.interpolation == file::Interpolation::cubic && track.times.size() < 2)
            document_.warn(fmt::format("{}: CUBICSPLINE with one key, expected two", where));
        read_values(where + ".output", sampler.output, slot, channel.path == "pointer", track);
        return track;
    }

private:
    const Accessor& accessor(const std::string& where, int index) {
        if (index < 0) refuse(where, "is not there");
        return usable(accessors_, index);
    }

    bool read_times(const std::string& where, int index, Track& track) {
        const Accessor& input = accessor(where, index);
        if (input.components() != 1 || input.component() != f32)
            refuse(where, fmt::format("{}: expected SCALAR of float for times, found {} components of type {}", input.name(),
                                      input.components(), static_cast<int>(input.component())));
        if (input.count() == 0) return false;  // warned of
        document_.geometry.take(input.count() * sizeof(float));
        track.times.resize(input.count());
        std::size_t equal = 0;
        for (std::size_t i = 0; i < track.times.size(); ++i) {
            float& time = track.times[i];
            input.read_floats(i, &time);
            if (!shading::finite(time)) refuse(where, fmt::format("{}: time {} is not finite", input.name(), i));
            if (i > 0 && time < track.times[i - 1])
                refuse(where, fmt::format("{}: time {} is {}, expected more than {} before it", input.name(), i, time, track.times[i - 1]));
            if (i > 0 && time == track.times[i - 1]) ++equal;
        }
        if (equal > 0)
            document_.warn(
                fmt::format("{}: {}: {} times are those before them, the last of equal ones counts", where, input.name(), equal));
        if (track.times[0] < 0)
            document_.warn(fmt::format("{}: {}: the first time is {}, expected at least 0", where, input.name(), track.times[0]));
        const std::optional<double> max = document_.file.accessors[static_cast<std::size_t>(index)].max;
        if (!max || static_cast<float>(std::clamp(*max, -3e38, 3e38)) != track.times.back())
            document_.warn(fmt::format("{}.max: expected the last time, {}, found {}", input.name(), track.times.back(),
                                       max ? fmt::format("{}", *max) : "none"));
        return true;
    }

    void read_values(const std::string& where, int index, const Slot& slot, bool by_pointer, Track& track) {
        const Accessor& output = accessor(where, index);
        const auto components = slot.part() == Part::weights ? 1 : static_cast<int>(slot.count);
        if (output.components() != components)
            refuse(where, fmt::format("{}: expected {} components, found {}", output.name(), components, output.components()));
        const Component type = output.component();
        const bool small = type == u8 || type == i8 || type == u16 || type == i16;
        const bool normalized = by_pointer || slot.is_rotation() || slot.part() == Part::weights;
        const bool good = slot.is_truth() ? type == u8 : type == f32 || (small && output.normalized() && normalized);
        if (!good)
            refuse(where, fmt::format("{}: found {}component type {}, which glTF does not allow here", output.name(),
                                      output.normalized() ? "normalized " : "", static_cast<int>(type)));
        const std::uint64_t of_key = (track.interpolation == file::Interpolation::cubic ? 3u : 1u) * slot.count;  // numbers
        const std::uint64_t expected = track.times.size() * of_key / static_cast<std::uint64_t>(components);
        if (output.count() != expected)
            refuse(where, fmt::format("{}: expected {} elements for {} times, found {}", output.name(), expected, track.times.size(),
                                      output.count()));
        document_.geometry.take(track.times.size() * of_key * sizeof(float));
        track.values.resize(static_cast<std::size_t>(track.times.size() * of_key));
        const auto step = static_cast<std::size_t>(components);
        for (std::size_t i = 0; i < output.count(); ++i) output.read_floats(i, track.values.data() + i * step);
        if (const auto bad = std::count_if(track.values.begin(), track.values.end(), [](float v) { return !shading::finite(v); }); bad > 0)
            document_.go_on_without({{ErrorCode::bad_input, fmt::format("{}: {}: {} numbers are not finite", where, output.name(), bad)}},
                                    "where they count, the file's own value is drawn");
        if (track.rotation) warn_of_lengths(where, output.name(), track);
    }

    void warn_of_lengths(const std::string& where, const std::string& name, const Track& track) {
        const bool cubic = track.interpolation == file::Interpolation::cubic;
        constexpr double kTolerance = 0.01;  // of the square; a quaternion of 8-bit integers is wrong by up to 0.008
        std::size_t bad = 0;
        for (std::size_t i = cubic ? 4 : 0; i + 4 <= track.values.size(); i += cubic ? 12 : 4) {
            double length2 = 0;
            for (std::size_t k = 0; k < 4; ++k)
                length2 += static_cast<double>(track.values[i + k]) * static_cast<double>(track.values[i + k]);
            if (!(length2 > 1 - kTolerance && length2 < 1 + kTolerance)) ++bad;
        }
        if (bad > 0) document_.warn(fmt::format("{}: {}: {} quaternions are not of length 1, drawn as if they were", where, name, bad));
    }

    Document& document_;
    const std::vector<Accessor>& accessors_;
};

}  // namespace

void find_animations(Document& document) {
    const LoadOptions& options = document.options;
    check_pose_time(options);
    std::vector<std::string> names;
    document.geometry.take(document.file.animations.size() * sizeof(std::string));
    for (const file::Animation& animation : document.file.animations) names.emplace_back(animation.name);
    AnimationUse& use = document.animations;
    use.drawn = choose_animation(names, options.animation);
    ChannelFinder finder(document);
    for (int i = 0; i < static_cast<int>(names.size()); ++i)
        if (options.keep_animations || i == use.drawn) finder.find(i);
    finder.finish();
}

std::vector<Animation> read_animations(Document& document, const std::vector<Accessor>& accessors) {
    std::vector<Animation> animations;
    TrackReader reader(document, accessors);
    for (const AnimationUse::Used& used : document.animations.used) {
        Animation& animation = animations.emplace_back();
        animation.index = used.animation;
        try {
            for (const AnimationUse::Channel& channel : used.channels) {
                check_time();
                std::optional<Track> track = reader.read(used.animation, channel.channel, channel.slot);
                if (!track) continue;
                animation.end_s = std::max(animation.end_s, static_cast<double>(track->times.back()));
                animation.moves.push_back({channel.slot, std::move(*track)});
            }
        } catch (const LoadFailure& failure) {
            if (document.options.strict || failure.error.code != ErrorCode::bad_input) throw;
            document.warn(fmt::format("{}; the animation is left out", failure.error.message));
            animation.moves.clear();
        }
    }
    return animations;
}

void apply(const Animation& animation, double time_s, file::File& file) {
    std::map<int, file::Camera> cameras;  // as they were
    std::vector<double> value;
    for (const auto& [slot, track] : animation.moves) {
        double* const at = locate(file, slot);
        if (at == nullptr) continue;
        if (slot.part() == Part::camera) cameras.try_emplace(slot.element, file.cameras[static_cast<std::size_t>(slot.element)]);
        value.resize(slot.count);
        if (sample(track, time_s, value.data())) std::copy(value.begin(), value.end(), at);
    }
    for (const auto& [index, camera] : cameras)
        if (file::Camera& moved = file.cameras[static_cast<std::size_t>(index)]; !is_valid(moved)) moved = camera;
}

std::vector<AnimationInfo> describe_animations(const file::File& file, const std::vector<Animation>& read) {
    std::vector<AnimationInfo> out;
    for (std::size_t i = 0; i < file.animations.size(); ++i) {
        const file::Animation& source = file.animations[i];
        AnimationInfo& info = out.emplace_back();
        info.name = source.name;
        info.channels = source.channels.size();
        for (const file::AnimationSampler& sampler : source.samplers)
            if (sampler.input >= 0 && static_cast<std::size_t>(sampler.input) < file.accessors.size())
                info.end_s = std::max(info.end_s, file.accessors[static_cast<std::size_t>(sampler.input)].max.value_or(0.0));
    }
    for (const Animation& animation : read) out[static_cast<std::size_t>(animation.index)].end_s = animation.end_s;
    return out;
}

}  // namespace halflit::io::detail
