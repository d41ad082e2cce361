#include "apps/engine/job/aov.hpp"

#include "apps/engine/basics/spelling.hpp"
#include "apps/engine/job/aov_names.hpp"
#include "apps/io/pictures/exr_file.hpp"
#include "apps/io/pictures/pfm_file.hpp"
#include "apps/io/pictures/picture_reader.hpp"
#include "apps/io/pictures/png_writer.hpp"
#include "halflit/fragment_planes.hpp"
#include "halflit/image.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

namespace halflit::engine {
namespace {

Result<void> as_rays(const RenderJob& job, const Camera& camera, AovPlane& plane) {
    return make_ray_distances(camera, {job.width, job.height}, job.settings.region, plane.floats);
}
/// Normals along the axes of the file.
Result<void> as_normals(const RenderJob& job, const Camera&, AovPlane& plane) {
    const UpAxis up = job.source.placement.up;
    for (std::size_t i = 0; up != UpAxis::y && i < plane.floats.size(); i += 3) {
        float* const n = &plane.floats[i];
        const Vec3f told = to_float(turned_back(Vec3d{n[0], n[1], n[2]}, up));
        n[0] = told.x, n[1] = told.y, n[2] = told.z;
    }
    return {};
}
Result<void> as_view_normals(const RenderJob&, const Camera& camera, AovPlane& plane) { return make_view_normals(camera, plane.floats); }
Result<void> as_meshes(const RenderJob& job, const Camera&, AovPlane& plane) {
    make_mesh_numbers(job.scene(), plane.numbers);
    return {};
}
Result<void> as_materials(const RenderJob& job, const Camera&, AovPlane& plane) {
    make_material_numbers(job.scene(), plane.numbers);
    return {};
}
Result<void> as_parts(const RenderJob& job, const Camera&, AovPlane& plane) {
    for (std::uint32_t& number : plane.numbers) number = part_number(job.source, number);
    return {};
}
/// Two floats as three, the last one 0: files have one channel or three.
Result<void> as_three(const RenderJob&, const Camera&, AovPlane& plane) {
    std::vector<float> three(plane.floats.size() / 2 * 3);
    for (std::size_t i = 0; i < three.size() / 3; ++i) three[3 * i] = plane.floats[2 * i], three[3 * i + 1] = plane.floats[2 * i + 1];
    plane.floats = std::move(three);
    return {};
}

constexpr AovKind kKinds[] = {
    {"depth", AovFormat::floats, 1, &Target::depth, nullptr, nullptr, false, "distance along the view axis; infinity where nothing is"},
    {"ray", AovFormat::floats, 1, &Target::depth, nullptr, as_rays, false,
     "distance from the camera's eye, along the ray through the pixel's centre; infinity where nothing is"},
    {"normal", AovFormat::floats, 3, &Target::shading_normal, nullptr, as_normals, false,
     "unit normal that light falls on, normal map included, in world space"},
    {"vertex_normal", AovFormat::floats, 3, &Target::normal, nullptr, as_normals, false, "the same without the normal map"},
    {"view_normal", AovFormat::floats, 3, &Target::shading_normal, nullptr, as_view_normals, false,
     "`normal` in the camera's space: x to the right, y up, z towards the viewer"},
    {"albedo", AovFormat::floats, 3, &Target::albedo, nullptr, nullptr, false, "base colour, linear"},
    {"position", AovFormat::floats, 3, &Target::position, nullptr, nullptr, false, "position in world space"},
    {"barycentric", AovFormat::floats, 2, &Target::barycentric, nullptr, as_three, false,
     "weights of the triangle's second and third corner, then 0; that of the first is 1 minus both"},
    {"uv", AovFormat::floats, 2, &Target::uv, nullptr, as_three, false,
     "texture coordinates of set 0, before a texture's own transform, then 0"},
    {"id", AovFormat::number16, 1, nullptr, &Target::instance, nullptr, true, "number of the object: its instance's index plus 1"},
    {"part", AovFormat::number16, 1, nullptr, &Target::instance, as_parts, true, "number of its part: what one node of the file places"},
    {"mesh", AovFormat::number16, 1, nullptr, &Target::instance, as_meshes, true, "number of its mesh, plus 1"},
    {"material", AovFormat::number16, 1, nullptr, &Target::instance, as_materials, true,
     "number of its material, plus 1; 0 for the default material too"},
    {"coverage", AovFormat::share16, 1, &Target::coverage, nullptr, nullptr, false,
     "share of the samples that a surface covers: 65535 for all"},
    {"lights", AovFormat::number16, 1, nullptr, &Target::lights, nullptr, false, "number of lights that have it in their range and cone"},
    {"triangle", AovFormat::number32, 1, nullptr, &Target::triangle, nullptr, false, "number of the triangle in its mesh, plus 1"},
    {"depth16", AovFormat::depth16, 1, &Target::depth, nullptr, nullptr, false,
     "depth as 1 to 65535 between the least and the largest of the picture, which x.depth16.json has; 0 where nothing is"},
};

constexpr std::uint32_t kMostNumber = 65535;
constexpr std::string_view kNames = "names";

/// Depth of nothing is infinite.
bool is_something(float depth) { return depth < 3e38f; }

/// One or three floats a pixel. A distance is the channel Z, as is usual.
Result<std::vector<std::uint8_t>> encode_floats(int width, int height, const std::vector<float>& values, int channels) {
    if (!has_exr()) return io::encode_pfm(width, height, channels, values);
    const float* const data = values.data();
    if (channels == 1) {
        const io::ExrChannel depth[] = {{"Z", data, 1}};
        return io::encode_exr(width, height, depth);
    }
    const io::ExrChannel color[] = {{"R", data, 3}, {"G", data + 1, 3}, {"B", data + 2, 3}};
    return io::encode_exr(width, height, color);
}

/// The four bytes of each number as red, green, blue and alpha, the least first.
Result<std::vector<std::uint8_t>> encode_bytes(int width, int height, const std::vector<std::uint32_t>& numbers) {
    Image image = Image::make(width, height);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        for (std::size_t k = 0; k < 4; ++k) image.rgba8[4 * i + k] = static_cast<std::uint8_t>(numbers[i] >> (8 * k));
    return encode_image(image, OutputFormat::png);
}

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::string_view extension_of(const AovKind& aov) { return aov.format != AovFormat::floats ? "png" : has_exr() ? "exr" : "pfm"; }

/// The name without extension. A view's name, such as 22.5,0, may have a dot where --format gives the format.
std::string stem_of_picture(const std::string& picture) {
    if (!io::is_picture_name(picture)) return picture;
    const std::size_t name = picture.rfind('/') + 1;  // npos + 1 is 0
    const std::size_t dot = picture.rfind('.');
    return dot == std::string::npos || dot <= name ? picture : picture.substr(0, dot);
}

std::string path_of(const std::string& picture, std::string_view name, std::string_view extension) {
    return fmt::format("{}.{}.{}", stem_of_picture(picture), name, extension);
}

bool any_named(std::span<const Aov> aovs) {
    return std::any_of(aovs.begin(), aovs.end(), [](Aov aov) { return aov->named; });
}

}  // namespace

Result<std::vector<Aov>> parse_aovs(const std::string& text) {
    std::vector<Aov> aovs;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        const auto* const found =
            std::find_if(std::begin(kKinds), std::end(kKinds), [&](const AovKind& kind) { return kind.name == word; });
        if (found == std::end(kKinds)) {
            std::vector<std::string> names;
            for (const AovKind& kind : kKinds) names.emplace_back(kind.name);
            return fail(ErrorCode::usage,
                        fmt::format("expected names of {}, found '{}'{}", joined(names, ", "), word, did_you_mean(word, names)));
        }
        if (std::find(aovs.begin(), aovs.end(), found) == aovs.end()) aovs.push_back(found);
        begin = end + 1;
    }
    return aovs;
}

std::string aov_help() {
    const auto names = [](bool floats) {
        std::vector<std::string> list;
        for (const AovKind& kind : kKinds)
            if ((kind.format == AovFormat::floats) == floats && kind.format != AovFormat::number32) list.emplace_back(kind.name);
        return joined(list, ", ");
    };
    return "Also write files beside the picture, as x.depth.exr for x.png: " + names(true) + " as floats (.exr; .pfm without OpenEXR); " +
           names(false) +
           " as 16-bit PNG; triangle as the four bytes of a PNG's pixels, the least first. x.names.json has the names of what "
           "is numbered, x.depth16.json the depths of the codes 1 and 65535";
}

std::vector<std::string> aov_paths(const std::string& picture, std::span<const Aov> aovs) {
    std::vector<std::string> paths;
    for (const Aov aov : aovs) {
        paths.push_back(path_of(picture, aov->name, extension_of(*aov)));
        if (aov->format == AovFormat::depth16) paths.push_back(path_of(picture, aov->name, "json"));
    }
    if (any_named(aovs)) paths.push_back(path_of(picture, kNames, "json"));
    return paths;
}

AovPlanes::AovPlanes(const std::vector<Aov>& aovs, const RenderJob& job)
    : aovs_(aovs), width_(job.settings.region.width), height_(job.settings.region.height) {
    for (const Aov aov : aovs_) {
        (void)drawn(aov->floats, aov->numbers, aov->channels);
        if (aov->floats == &Target::position) (void)drawn(&Target::depth, nullptr, 1);  // tells where positions are
    }
}

AovPlane& AovPlanes::drawn(float* Target::*floats, std::uint32_t* Target::*numbers, int channels) {
    for (Drawn& one : drawn_)
        if (one.floats == floats && one.numbers == numbers) return one.plane;
    const std::size_t size = static_cast<std::size_t>(channels) * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    Drawn made{floats, numbers, {}};
    if (floats != nullptr)
        made.plane.floats.resize(size);
    else
        made.plane.numbers.resize(size);
    return drawn_.emplace_back(std::move(made)).plane;
}

void AovPlanes::add_to(Target& target) {
    for (Drawn& one : drawn_) {
        if (one.floats != nullptr) target.*one.floats = one.plane.floats.data();
        if (one.numbers != nullptr) target.*one.numbers = one.plane.numbers.data();
    }
}

void AovPlanes::to_world_of_file(const RenderJob& job) {
    const Placement& placement = job.source.placement;
    if (placement == Placement{}) return;
    const auto has = [&](float* Target::*floats) {
        return std::any_of(drawn_.begin(), drawn_.end(), [=](const Drawn& one) { return one.floats == floats; });
    };
    if (!has(&Target::depth)) return;
    const auto inverse = static_cast<float>(1.0 / placement.scale);  // a power of two
    const bool has_position = has(&Target::position);
    for (std::size_t i = 0; i < static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); ++i) {
        float& depth = drawn(&Target::depth, nullptr, 1).floats[i];
        if (!is_something(depth)) continue;
        depth *= inverse;
        if (!has_position) continue;
        float* const p = &drawn(&Target::position, nullptr, 3).floats[3 * i];
        const Vec3f at = to_float(placement.out(Vec3d{p[0], p[1], p[2]}));
        p[0] = at.x, p[1] = at.y, p[2] = at.z;
    }
}

Result<std::vector<std::uint8_t>> AovPlanes::encode16(const AovKind& aov, const AovPlane& plane) const {
    std::vector<std::uint16_t> values;
    values.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    // Shares are sixteenths: the product is exact, and each share has a number of its own.
    for (const float share : plane.floats) values.push_back(static_cast<std::uint16_t>(share * 65535.0f + 0.5f));
    for (const std::uint32_t number : plane.numbers) {
        if (number > kMostNumber)
            return fail(ErrorCode::limit, fmt::format("--aov: {} {} in the picture, a 16-bit PNG holds {}", aov.name, number, kMostNumber));
        values.push_back(static_cast<std::uint16_t>(number));
    }
    return io::encode_grey16(width_, height_, values);
}

Result<std::vector<std::uint8_t>> AovPlanes::encode_depth16(const std::vector<float>& depth, AovFiles& files) const {
    std::vector<std::uint16_t> codes(depth.size());
    files.depth16 = make_depth_codes(depth, codes);
    return io::encode_grey16(width_, height_, codes);
}

Result<std::vector<std::uint8_t>> AovPlanes::encode(const AovKind& aov, const AovPlane& plane, AovFiles& files) const {
    switch (aov.format) {
        case AovFormat::floats:
            return encode_floats(width_, height_, plane.floats, aov.channels == 1 ? 1 : 3);
        case AovFormat::number32:
            return encode_bytes(width_, height_, plane.numbers);
        case AovFormat::depth16:
            return encode_depth16(plane.floats, files);
        case AovFormat::share16:
        case AovFormat::number16:
            break;
    }
    return encode16(aov, plane);
}

Result<void> AovPlanes::derive(const RenderJob& job, const Camera& camera) {
    to_world_of_file(job);
    derived_.clear();
    for (const Aov aov : aovs_) {
        AovPlane& plane = derived_.emplace_back(drawn(aov->floats, aov->numbers, aov->channels));
        if (aov->derive == nullptr) continue;
        if (auto made = aov->derive(job, camera, plane); !made) return made;
    }
    if (any_named(aovs_)) names_ = names_text(job.source);
    return {};
}

Result<AovFiles> AovPlanes::encode(const std::string& picture) const {
    AovFiles files;
    for (std::size_t i = 0; i < aovs_.size(); ++i) {
        const Aov aov = aovs_[i];
        auto bytes = encode(*aov, derived_[i], files);
        if (!bytes) return tl::unexpected(bytes.error());
        files.files.push_back({std::string(aov->name), path_of(picture, aov->name, extension_of(*aov)), std::move(*bytes)});
        if (aov->format == AovFormat::depth16)
            files.files.push_back({"depth16_range", path_of(picture, aov->name, "json"), bytes_of(depth16_text(*files.depth16))});
    }
    if (any_named(aovs_)) files.files.push_back({std::string(kNames), path_of(picture, kNames, "json"), bytes_of(names_)});
    return files;
}

}  // namespace halflit::engine
