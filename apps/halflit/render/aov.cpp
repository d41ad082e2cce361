#include "apps/halflit/render/aov.hpp"

#include "apps/halflit/program/spelling.hpp"
#include "apps/io/pictures/exr_file.hpp"
#include "apps/io/pictures/grey_png.hpp"
#include "apps/io/pictures/pfm_file.hpp"
#include "halflit/image.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>

namespace halflit::cli {
namespace {

std::string_view name_of(Aov aov) { return kAovNames[static_cast<std::size_t>(aov)]; }

/// Whole numbers, which are written as they are.
bool is_number(Aov aov) { return aov == Aov::id || aov == Aov::coverage || aov == Aov::lights; }

constexpr std::uint32_t kMostNumber = 65535;

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

}  // namespace

Result<std::vector<Aov>> parse_aovs(const std::string& text) {
    std::vector<Aov> aovs;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        const auto found = std::find(std::begin(kAovNames), std::end(kAovNames), word);
        if (found == std::end(kAovNames)) {
            const std::vector<std::string> names(std::begin(kAovNames), std::end(kAovNames));
            return fail(ErrorCode::usage,
                        fmt::format("expected names of {}, found '{}'{}", joined(names, ", "), word, did_you_mean(word, names)));
        }
        const auto aov = static_cast<Aov>(found - std::begin(kAovNames));
        if (std::find(aovs.begin(), aovs.end(), aov) == aovs.end()) aovs.push_back(aov);
        begin = end + 1;
    }
    return aovs;
}

std::string aov_path(const std::string& picture, Aov aov) {
    const std::size_t name = picture.rfind('/') + 1;  // npos + 1 is 0
    const std::size_t dot = picture.rfind('.');
    const std::string stem = dot == std::string::npos || dot <= name ? picture : picture.substr(0, dot);
    return fmt::format("{}.{}.{}", stem, name_of(aov), is_number(aov) ? "png" : has_exr() ? "exr" : "pfm");
}

AovPlanes::AovPlanes(const std::vector<Aov>& aovs, const RenderJob& job)
    : aovs_(aovs), width_(job.settings.region.width), height_(job.settings.region.height) {
    const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    if (has(Aov::depth) || has(Aov::position)) depth_.resize(pixels);  // tells where positions are
    if (has(Aov::normal)) normal_.resize(3 * pixels);
    if (has(Aov::albedo)) albedo_.resize(3 * pixels);
    if (has(Aov::position)) position_.resize(3 * pixels);
    if (has(Aov::id)) id_.resize(pixels);
    if (has(Aov::coverage)) coverage_.resize(pixels);
    if (has(Aov::lights)) lights_.resize(pixels);
}

bool AovPlanes::has(Aov aov) const { return std::find(aovs_.begin(), aovs_.end(), aov) != aovs_.end(); }

void AovPlanes::add_to(Target& target) {
    const auto memory = [](auto& plane) { return plane.empty() ? nullptr : plane.data(); };
    target.depth = memory(depth_);
    target.shading_normal = memory(normal_);
    target.albedo = memory(albedo_);
    target.position = memory(position_);
    target.instance = memory(id_);
    target.coverage = memory(coverage_);
    target.lights = memory(lights_);
}

void AovPlanes::to_world_of_file(const RenderJob& job) {
    const double scale = job.source.placement.scale;
    const Vec3d origin = job.source.placement.origin;
    if (scale == 1.0 && origin == Vec3d{}) return;
    const auto inverse = static_cast<float>(1.0 / scale);  // a power of two
    for (std::size_t i = 0; i < depth_.size(); ++i) {
        if (!(depth_[i] < 3e38f)) continue;  // nothing is there
        depth_[i] *= inverse;
        if (position_.empty()) continue;
        float* const p = &position_[3 * i];
        const Vec3d at = Vec3d{p[0], p[1], p[2]} * (1.0 / scale) + origin;
        p[0] = static_cast<float>(at.x);
        p[1] = static_cast<float>(at.y);
        p[2] = static_cast<float>(at.z);
    }
}

Result<std::vector<std::uint8_t>> AovPlanes::encode_numbers(Aov aov) const {
    std::vector<std::uint16_t> values;
    values.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    if (aov == Aov::coverage) {
        // Shares are sixteenths: the product is exact, and each share has a number of its own.
        for (const float share : coverage_) values.push_back(static_cast<std::uint16_t>(share * 65535.0f + 0.5f));
    } else {
        const std::vector<std::uint32_t>& numbers = aov == Aov::id ? id_ : lights_;
        for (const std::uint32_t number : numbers) {
            if (number > kMostNumber)
                return fail(ErrorCode::limit,
                            fmt::format("--aov: {} {} in the picture, a 16-bit PNG holds {}", name_of(aov), number, kMostNumber));
            values.push_back(static_cast<std::uint16_t>(number));
        }
    }
    return io::encode_grey16(width_, height_, values);
}

Result<std::vector<std::uint8_t>> AovPlanes::encode(Aov aov) const {
    switch (aov) {
        case Aov::depth:
            return encode_floats(width_, height_, depth_, 1);
        case Aov::normal:
            return encode_floats(width_, height_, normal_, 3);
        case Aov::albedo:
            return encode_floats(width_, height_, albedo_, 3);
        case Aov::position:
            return encode_floats(width_, height_, position_, 3);
        case Aov::id:
        case Aov::coverage:
        case Aov::lights:
            break;
    }
    return encode_numbers(aov);
}

Result<std::vector<AovFile>> AovPlanes::encode(const std::string& picture, const RenderJob& job) {
    to_world_of_file(job);
    std::vector<AovFile> files;
    for (const Aov aov : aovs_) {
        auto bytes = encode(aov);
        if (!bytes) return tl::unexpected(bytes.error());
        files.push_back({aov, aov_path(picture, aov), std::move(*bytes)});
    }
    return files;
}

}  // namespace halflit::cli
