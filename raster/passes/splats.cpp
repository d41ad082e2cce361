#include "raster/passes/splats.hpp"

#include "raster/passes/splat_order.hpp"
#include "raster/view/splat_view.hpp"
#include "sh/power.hpp"
#include "sh/time_limit.hpp"
#include "shading/model/srgb.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

namespace halflit::raster {
namespace {

constexpr std::uint64_t kUnitsASquare = 30, kUnitsAListed = 10;  ///< of charge_work, for a splat in a square, and in a row of them

/// Shares of what may be left out: splats out of reach; faint splats of a square, whatever hides them; those that are faint in a block or
/// hidden there; and what is behind nearly opaque ones. The last pays most where much is hidden.
constexpr double kReachShare = 1.0 / 16, kFaintShare = 3.0 / 16, kDrawnShare = 0.5, kPassedShare = 0.25;
/// Largest slope of the display's code over linear light.
constexpr double kMostCodeSlope = 12.92;

/// Squares of a row or a column, counted from the first one that is drawn, from `first` to `end` - 1; none if they are equal.
struct SquareSpan {
    int first, end;
};
/// Squares that a splat may show in. middle: its pixel; half, reach_log2: as SplatRecord has them; first, end: squares that are drawn. It
/// is the same square of the picture whatever part of it is drawn.
SquareSpan squares_of(std::int32_t middle, float half, float reach_log2, int first, int end) {
    const float reach = std::sqrt(std::max(reach_log2, 0.0f)) * half + 1.0f, at = static_cast<float>(middle);
    const auto held = [&](float x_px) {
        const float square = std::clamp(x_px * (1.0f / kSplatTile), static_cast<float>(first - 1), static_cast<float>(end));
        const int whole = static_cast<int>(square);  // towards 0
        return whole - (static_cast<float>(whole) > square ? 1 : 0) - first;
    };
    const int begin = std::max(held(at - reach), 0), past = std::min(held(at + reach), end - first - 1) + 1;
    return {begin, std::max(begin, past)};
}

/// Least u^2 + w^2 in a square, or less. x, y: from the splat's middle to that of the square.
float least_square_in(const SplatRecord& s, float x, float y) {
    constexpr float kHalf = 0.5f * (kSplatTile - 1);
    const auto least = [&](float m0, float m1) {
        return std::max(std::fabs(m0 * x + m1 * y) - kHalf * (std::fabs(m0) + std::fabs(m1)), 0.0f);
    };
    const float u = least(s.m00, s.m01), w = least(s.m10, s.m11);
    return u * u + w * w;
}

double display_code(double linear) {
    const double v = linear > 0.0 ? std::min(linear, 1.0) : 0.0;
    return v <= shading::kSrgbLinearEnd ? 12.92 * v : 1.055 * power_of(v, 1.0 / 2.4) - 0.055;
}

}  // namespace

bool SplatPicture::begin(const PreparedData& scene, const FramePlan& plan, Executor& executor) {
    if (!scene.has_splats()) return false;
    linear_light_ = false;
    each_splats(scene.scene(), [&](std::size_t, const Instance&, const Mesh& mesh) { linear_light_ |= mesh.splats->linear_light; });
    region_ = plan.picture.region;
    samples_ = plan.picture.samples.count;
    planes_ = scene.triangle_count() > 0 ? std::min(samples_, kMostPlanes) : 0;
    const std::size_t count =
        static_cast<std::size_t>(planes_) * static_cast<std::size_t>(region_.height) * static_cast<std::size_t>(region_.width);
    std::fill_n(depth_.reserve(count, executor.stop()), count, 0.0f);
    return true;
}

void SplatPicture::keep(const TileRect& tile, const TileBuffers& buffers) {
    for (int plane = 0; plane < planes_; ++plane)
        for (int y = 0; y < tile.height; ++y) {
            const auto at =
                (static_cast<std::ptrdiff_t>(plane) * region_.height + (tile.y + y - region_.y)) * region_.width + (tile.x - region_.x);
            std::memcpy(depth_.data() + at, buffers.depth[plane * samples_ / planes_] + y * kTileStride,
                        sizeof(float) * static_cast<std::size_t>(tile.width));
        }
}

void SplatPicture::project(const PreparedData& scene, const FramePlan& plan, const RasterKernels& kernels, int width, int height,
                           bool numbered, Executor& executor) {
    struct Part {
        SplatView view;
        SplatBatch batch;
        std::size_t place;      ///< of its records
        std::size_t count = 0;  ///< of those that are seen
    };
    std::vector<Part> parts;
    std::size_t all = 0;
    const SplatEye eye(plan.camera, plan.picture.clip_from_world, width, height, scene.bounds());
    first_of_instance_.clear();
    each_splats(scene.scene(), [&](std::size_t i, const Instance& instance, const Mesh& mesh) {
        first_of_instance_.emplace_back(static_cast<std::uint32_t>(all), static_cast<std::uint32_t>(i));
        const SplatView view = eye.view_of(instance.world_from_object, mesh.splats->reference, plan.splat_squares);
        for (std::size_t first = 0; first < mesh.splats->opacities.size(); first += kSplatsAtOnce)
            parts.push_back({view, splat_batch(mesh, first, static_cast<std::uint32_t>(all + first)), all + first});
        all += mesh.splats->opacities.size();
    });
    // All of them together may be off by that much where they are out of reach.
    const double colors = static_cast<double>(all + 1) * scene.largest_splat_color();
    least_log2_ = budget_.reach > 0.0 ? std::max(static_cast<float>(log2_of(budget_.reach / colors)), -100.0f) : -100.0f;
    records_.reserve(all, executor.stop());
    distances_.reserve(all, executor.stop());
    std::uint32_t* const numbers = numbered ? numbers_.reserve(all, executor.stop()) : nullptr;
    executor.run(static_cast<int>(parts.size()), [&](int task) {
        Part& part = parts[static_cast<std::size_t>(task)];
        part.view.least_log2 = least_log2_;
        part.count =
            static_cast<std::size_t>(kernels.project_splats(part.view, part.batch, records_.data() + part.place,
                                                            distances_.data() + part.place, numbered ? numbers + part.place : nullptr));
    });
    count_ = 0;
    for (const Part& part : parts) {
        if (part.place != count_) {
            std::move(records_.data() + part.place, records_.data() + part.place + part.count, records_.data() + count_);
            std::move(distances_.data() + part.place, distances_.data() + part.place + part.count, distances_.data() + count_);
            if (numbered) std::move(numbers + part.place, numbers + part.place + part.count, numbers + count_);
        }
        count_ += part.count;
    }
}

void SplatPicture::list_rows(const Region& part, Executor& executor) {
    const int first_row = part.y / kSplatTile, end_row = (part.y + part.height + kSplatTile - 1) / kSplatTile;
    const auto rows = static_cast<std::size_t>(end_row - first_row);
    rows_.reserve(count_, executor.stop());
    // Each task counts its part of the records, and then writes it behind those of the tasks before.
    const std::size_t per_list = std::max<std::size_t>(kSplatsAtOnce, count_ / 16 + 1), lists = (count_ + per_list - 1) / per_list;
    std::vector<std::size_t> places(lists * rows, 0u);
    const auto each = [&](std::size_t list, const auto& visit) {
        for (std::size_t i = list * per_list; i < std::min((list + 1) * per_list, count_); ++i) {
            if (i % kSplatsAtOnce == 0) executor.stop().check();
            visit(i, places.data() + list * rows);
        }
    };
    executor.run(static_cast<int>(lists), [&](int list) {
        each(static_cast<std::size_t>(list), [&](std::size_t i, std::size_t* counts) {
            const SplatRecord& s = records_.data()[i];
            const SquareSpan span = squares_of(s.y, s.half_y, s.log2_opacity - least_log2_, first_row, end_row);
            rows_.data()[i] = {static_cast<std::int16_t>(span.first), static_cast<std::int16_t>(span.end)};
            for (int row = span.first; row < span.end; ++row) ++counts[row];
        });
    });
    row_first_.assign(rows + 1, 0u);
    std::size_t sum = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        row_first_[row] = sum;
        for (std::size_t list = 0; list < lists; ++list) sum += std::exchange(places[list * rows + row], sum);
    }
    row_first_[rows] = sum;
    charge_work(kUnitsAListed * (count_ + sum));
    row_list_.reserve(sum, executor.stop());
    executor.run(static_cast<int>(lists), [&](int list) {
        each(static_cast<std::size_t>(list), [&](std::size_t i, std::size_t* next) {
            const Rows at = rows_.data()[i];
            for (int row = at.first; row < at.end; ++row) row_list_.data()[next[row]++] = static_cast<std::uint32_t>(i);
        });
    });
}

void SplatPicture::Drawn::add(const Drawn& part) {
    left_out = std::max(left_out, part.left_out), rounding = std::max(rounding, part.rounding), pixels += part.pixels;
}

float SplatPicture::depth_at(int plane, int x, int y) const {
    const int column = x - region_.x, row = y - region_.y;
    if (column < 0 || row < 0 || column >= region_.width || row >= region_.height) return 0.0f;
    return depth_.data()[(static_cast<std::ptrdiff_t>(plane) * region_.height + row) * region_.width + column];
}

bool SplatPicture::set_limits(const FramePlan& plan, int plane, int x_px, int y_px, SplatTile& tile) const {
    bool any = false;
    for (int y = 0; y < kSplatTile; ++y)
        for (int x = 0; x < kSplatTile; ++x) {
            float& limit = tile.limit[SplatTile::at(x, y)];
            limit = std::numeric_limits<float>::infinity();
            const float depth = depth_at(plane, x_px + x, y_px + y);
            if (!(depth > 0.0f)) continue;
            limit = static_cast<float>(plan.depth.distance(static_cast<double>(depth)));
            any = true;
        }
    return any;
}

std::uint64_t SplatPicture::write(const FramePlan& plan, const Output& output, const SplatTile& tile, int x_px, int y_px) const {
    constexpr double kSeen = 0.998;  // less light passes where splats are seen
    std::uint64_t seen = 0;
    double of_code[3] = {-1, -1, -1}, code[3] = {};
    const Region& part = plan.written;
    // Behind: codes / 255, straight, and alpha. Front: as it was summed.
    const auto blended = [&](const double(&front)[3], double passed, const double(&behind)[4], double(&out)[4]) {
        out[3] = 1.0 - passed * (1.0 - behind[3]);
        for (int c = 0; c < 3; ++c) {
            const double back = linear_light_ ? shading::linear_from_srgb(behind[c]) : behind[c];
            const double sum = (front[c] + passed * behind[3] * back) / out[3];
            out[c] = std::clamp(linear_light_ ? display_code(sum) : sum, 0.0, 1.0);
        }
    };
    for (int y = std::max(y_px, part.y); y < std::min(y_px + kSplatTile, part.y + part.height); ++y)
        for (int x = std::max(x_px, part.x); x < std::min(x_px + kSplatTile, part.x + part.width); ++x) {
            const int at = SplatTile::at(x - x_px, y - y_px);
            if (output.coverage) *output.coverage.at(x, y) = 1.0f - tile.passed[at] * (1.0f - *output.coverage.at(x, y));
            const double passed = tile.passed[at], front[3] = {tile.color[0][at], tile.color[1][at], tile.color[2][at]};
            if (passed == 1.0) continue;
            seen += passed < kSeen && !(planes_ > 0 && depth_at(0, x, y) > 0.0f) ? 1 : 0;
            double out[4];
            if (output.codes) {
                double behind[4];
                output.read_code(x, y, behind);
                // The plain background is known to more digits than its codes have.
                if (std::equal(behind, behind + 4, background_codes_)) std::copy_n(background_, 4, behind);
                blended(front, passed, behind, out);
                output.write_code(x, y, out);
            }
            if (output.linear) {
                float* const light = output.linear.at(x, y);
                const double alpha = light[3], per_alpha = output.is_premultiplied() && alpha > 0.0 ? 1.0 / alpha : 1.0;
                double behind[4] = {0, 0, 0, alpha};
                for (int c = 0; c < 3; ++c) {
                    // The background is the same in many pixels.
                    const double linear = light[c] * per_alpha;
                    if (linear != of_code[c]) of_code[c] = linear, code[c] = display_code(linear);
                    behind[c] = code[c];
                }
                blended(front, passed, behind, out);
                for (double* c : {&out[0], &out[1], &out[2]}) *c = shading::linear_from_srgb(*c);
                output.write_linear(x, y, static_cast<float>(out[0]), static_cast<float>(out[1]), static_cast<float>(out[2]),
                                    static_cast<float>(out[3]));
            }
        }
    return seen;
}

void SplatPicture::write_planes(const FramePlan& plan, const Output& output, const SplatTile& tile, int x_px, int y_px,
                                std::span<const std::uint32_t> of_row) const {
    const Region& part = plan.written;
    for (int y = std::max(y_px, part.y); y < std::min(y_px + kSplatTile, part.y + part.height); ++y)
        for (int x = std::max(x_px, part.x); x < std::min(x_px + kSplatTile, part.x + part.width); ++x) {
            const int at = SplatTile::at(x - x_px, y - y_px);
            if (!(tile.passed[at] < 0.5f)) continue;
            if (output.depth) *output.depth.at(x, y) = tile.median[at];
            for (const Plane<float>* plane : {&output.normal, &output.shading_normal, &output.albedo, &output.position})
                if (*plane) std::fill_n(plane->at(x, y), 3, 0.0f);
            for (const Plane<float>* plane : {&output.barycentric, &output.uv})
                if (*plane) std::fill_n(plane->at(x, y), 2, 0.0f);
            if (output.lights) *output.lights.at(x, y) = 0u;
            if (!output.instance && !output.triangle) continue;
            const std::uint32_t number = numbers_.data()[of_row[static_cast<std::size_t>(tile.most_shown[at])]];
            const auto above = std::upper_bound(first_of_instance_.begin(), first_of_instance_.end(), number,
                                                [](std::uint32_t n, const auto& entry) { return n < entry.first; });
            const auto& [first, instance] = *(above - 1);
            if (output.instance) *output.instance.at(x, y) = instance + 1;
            if (output.triangle) *output.triangle.at(x, y) = number - first + 1;
        }
}

SplatPicture::Drawn SplatPicture::draw_square(const FramePlan& plan, const Output& output, const RasterKernels& kernels, int x_px, int y_px,
                                              std::span<const SplatRecord> records, std::span<const std::uint32_t> list,
                                              std::span<const std::uint32_t> of_row, float largest, Executor& executor) const {
    // Each sample of a pixel has a depth of its own, behind which splats are hidden. Without surfaces all samples are alike.
    SplatTile sum, one;
    bool hides = false;
    Drawn drawn;
    for (int plane = 0; plane < std::max(planes_, 1); ++plane) {
        SplatTile& tile = plane == 0 ? sum : one;
        tile.hides = planes_ > 0 && set_limits(plan, plane, x_px, y_px, tile);
        hides |= tile.hides;
        if (plane > 0 && !hides) break;
        std::memset(tile.color, 0, sizeof tile.color);
        std::fill_n(tile.passed, kSplatTile * kSplatTile, 1.0f);
        tile.largest = largest, tile.least_passed = static_cast<float>(budget_.passed) / largest;
        std::fill_n(tile.budget, kSplatBlocks, budget_.drawn);
        std::fill_n(tile.rounding, kSplatBlocks, 0.0);
        std::fill_n(tile.most_passed, kSplatBlocks, 1.0f);
        tile.planes = plane == 0 && output.has_planes();
        if (tile.planes) std::fill_n(tile.most_share, kSplatTile * kSplatTile, 0.0f);
        for (std::size_t n = 0; n < list.size(); n += kSplatsAtOnce) {
            const std::size_t count = std::min(kSplatsAtOnce, list.size() - n);
            executor.stop().check();
            if (!kernels.blend_splats(records.data(), list.data() + n, static_cast<int>(count), list.size() - n - count, x_px, y_px, tile))
                break;
        }
        for (int b = 0; b < kSplatBlocks; ++b) {
            const bool finished = tile.most_passed[b] < tile.least_passed;
            drawn.left_out =
                std::max(drawn.left_out, budget_.drawn - tile.budget[b] + (finished ? double{tile.most_passed[b]} * double{largest} : 0.0));
            drawn.rounding = std::max(drawn.rounding, tile.rounding[b]);
        }
        if (tile.planes) write_planes(plan, output, tile, x_px, y_px, of_row);
        if (plane == 0) continue;
        for (int i = 0; i < kSplatTile * kSplatTile; ++i) {
            for (int c = 0; c < 3; ++c) sum.color[c][i] += one.color[c][i];
            sum.passed[i] += one.passed[i];
        }
    }
    if (hides && planes_ > 1) {
        const float share_of_one = 1.0f / static_cast<float>(planes_);
        for (int i = 0; i < kSplatTile * kSplatTile; ++i) {
            for (int c = 0; c < 3; ++c) sum.color[c][i] *= share_of_one;
            sum.passed[i] *= share_of_one;
        }
    }
    drawn.pixels = write(plan, output, sum, x_px, y_px);
    return drawn;
}

void SplatPicture::draw_row(const FramePlan& plan, const Output& output, const RasterKernels& kernels, int row, Executor& executor) {
    const Region& part = plan.written;
    const int y_px = row * kSplatTile, first = part.x / kSplatTile, end = (part.x + part.width + kSplatTile - 1) / kSplatTile;
    const auto squares = static_cast<std::size_t>(end - first), in_rows = static_cast<std::size_t>(row - part.y / kSplatTile);
    const std::span<std::uint32_t> in_row(row_list_.data() + row_first_[in_rows], row_first_[in_rows + 1] - row_first_[in_rows]);
    if (in_row.empty()) return;
    Pool<RowScratch>::Loan scratch(scratch_);
    sort_by_distance(in_row, distances_.data(), scratch->order, executor.stop());
    // Side by side, as they are read by many squares.
    SplatRecord* const records = scratch->records.reserve(std::bit_ceil(in_row.size()), executor.stop());
    std::uint16_t* const spans = scratch->spans.reserve(2 * std::bit_ceil(in_row.size()), executor.stop());
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < in_row.size(); ++i) {
        if (i % kSplatsAtOnce == 0) executor.stop().check();
        constexpr std::size_t kAhead = 12;
        if (i + kAhead < in_row.size()) __builtin_prefetch(&records_.data()[in_row[i + kAhead]]);
        const SplatRecord& s = records[i] = records_.data()[in_row[i]];
        const SquareSpan span = squares_of(s.x, s.half_x, s.log2_opacity - least_log2_, first, end);
        spans[2 * i] = static_cast<std::uint16_t>(span.first), spans[2 * i + 1] = static_cast<std::uint16_t>(span.end);
        pairs += static_cast<std::size_t>(span.end - span.first);
    }
    charge_work(kUnitsASquare * pairs);
    // How faint each splat is in each square, as whole logarithms: the faintest are left out, as many as the budget pays.
    constexpr int kDepths = 64, kNever = kDepths - 1;
    std::uint8_t* const depths = scratch->depths.reserve(std::bit_ceil(pairs), executor.stop());
    std::vector<std::uint32_t> counts(squares * kDepths, 0u);
    std::vector<float> largest(squares, 1.0f);
    constexpr float kMiddle = 0.5f * (kSplatTile - 1);
    const auto each = [&](const auto& visit) {
        std::size_t pair = 0;
        for (std::size_t i = 0; i < in_row.size(); ++i) {
            if (i % kSplatsAtOnce == 0) executor.stop().check();
            for (std::size_t square = spans[2 * i]; square < spans[2 * i + 1]; ++square) visit(i, square, pair++);
        }
    };
    each([&](std::size_t i, std::size_t square, std::size_t pair) {
        const SplatRecord& s = records[i];
        const float x = s.way_x((first + static_cast<int>(square)) * kSplatTile) + kMiddle, y = s.way_y(y_px) + kMiddle,
                    faint = least_square_in(s, x, y) - s.log2_opacity;
        depths[pair] = static_cast<std::uint8_t>(std::min(faint, static_cast<float>(kNever)));
        ++counts[square * kDepths + depths[pair]];
        largest[square] = std::max({largest[square], s.color[0], s.color[1], s.color[2]});
    });
    std::vector<std::uint8_t> drawn(squares, std::uint8_t{kDepths});  // depths below this are
    std::vector<double> faint(squares, budget_.faint);                // what is left
    std::vector<std::size_t> place(squares + 1, 0u);
    for (std::size_t square = 0; square < squares; ++square) {
        const std::uint32_t* const count = counts.data() + square * kDepths;
        for (int depth = kNever; depth > 0; --depth) {
            const double left =
                faint[square] - static_cast<double>(largest[square]) * count[depth] / static_cast<double>(std::uint64_t{1} << depth);
            if (left < 0.0) break;
            faint[square] = left;
            drawn[square] = static_cast<std::uint8_t>(depth);
        }
        place[square + 1] = place[square] + std::accumulate(count, count + drawn[square], std::size_t{0});
    }
    std::uint32_t* const list = scratch->list.reserve(std::bit_ceil(place[squares] + 1), executor.stop());
    std::vector<std::size_t> next(place.begin(), place.end() - 1);
    each([&](std::size_t i, std::size_t square, std::size_t pair) {
        if (depths[pair] < drawn[square]) list[next[square]++] = static_cast<std::uint32_t>(i);
    });
    for (std::size_t square = 0; square < squares; ++square) {
        Drawn of_square;
        executor.stop().check();
        if (place[square + 1] > place[square])
            of_square = draw_square(plan, output, kernels, (first + static_cast<int>(square)) * kSplatTile, y_px, {records, in_row.size()},
                                    {list + place[square], place[square + 1] - place[square]}, in_row, largest[square], executor);
        of_square.left_out += budget_.faint - faint[square];
        row_drawn_[in_rows].add(of_square);
    }
}

SplatPicture::Drawn SplatPicture::draw(const PreparedData& scene, const FramePlan& plan, const Output& output, const RasterKernels& kernels,
                                       int width, int height, Executor& executor) {
    const double codes = plan.options.accuracy == Accuracy::reference ? 0.0 : kExactSplatCodes + plan.splat_codes,
                 codes_to_light = 1.0 / 255.0 / (linear_light_ ? kMostCodeSlope : 1.0), allowed = codes * codes_to_light;
    budget_ = {kReachShare * allowed, kFaintShare * allowed, kDrawnShare * allowed, kPassedShare * allowed};
    project(scene, plan, kernels, width, height, output.instance || output.triangle, executor);
    list_rows(plan.written, executor);
    const Vec4f back = plan.background_linear;
    const double channels[4] = {back.x, back.y, back.z, back.w};
    for (int c = 0; c < 4; ++c) {
        background_[c] = c < 3 ? display_code(channels[c]) : channels[c];
        background_codes_[c] = plan.background ? -1.0 : std::floor(background_[c] * 255.0 + 0.5) / 255.0;
    }
    const Region& part = plan.written;
    const int first = part.y / kSplatTile, end = (part.y + part.height + kSplatTile - 1) / kSplatTile;
    row_drawn_.assign(static_cast<std::size_t>(std::max(end - first, 0)), Drawn{});
    executor.run(end - first, [&](int row) { draw_row(plan, output, kernels, first + row, executor); });
    Drawn all;
    for (const Drawn& of_row : row_drawn_) all.add(of_row);
    return {(budget_.reach + all.left_out) / codes_to_light, all.rounding / codes_to_light, all.pixels};
}

}  // namespace halflit::raster
