// Shadow-map look-ups in the kernels, on small maps made by hand: the same bits on every instruction set for any input, exact values at
// boundaries, and sums compared with float64.
#include "random_case.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/planner.hpp"
#include "shading/reference/shadow.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

constexpr int kSize = 32;

/// One light from +z with one map over [-1, 1] x [-1, 1]; a receiver at z = 0 is 10 away from the map's plane (perspective: from the
/// light).
struct Setup {
    std::vector<float> texels = std::vector<float>(std::size_t{6} * kSize * kSize, kNoBlocker);
    Material material;
    Light light;
    ShadingPlan plan;
    std::vector<float> wide;

    Setup(ShadowMapPlan::Kind kind, const Lobe& lobe, ShadowMode mode, bool specular = false) {
        material.metallic = 0;
        material.lobe = lobe;
        light.direction_ws = {0, 0, -1};
        if (kind != ShadowMapPlan::Kind::orthographic) {
            light.type = kind == ShadowMapPlan::Kind::cube ? LightType::point : LightType::spot;
            light.position_ws = {0, 0, 10};
            light.color_linear = {100, 100, 100};
            light.outer_cone_rad = 1.5f;
            light.inner_cone_rad = 1.4f;
        }
        const std::vector<SlotMask> available{3u, 3u};
        ShadingSettings options;
        options.specular = specular ? SpecularModel::blinn : SpecularModel::none;
        plan = plan_shading({std::span(&material, 1), {}, available, plan_lights(std::span(&light, 1)), {}, options});
        plan.shadow_mode = mode;
        plan.orthographic = true;
        plan.materials[0].shadow_fade_scale = lobe.wrap > 0 ? 0.5f : 0.0f;
        plan.materials[0].shadow_turn_scale = lobe.wrap > 0 ? kOwnThickness / lobe.wrap : 0.0f;
        plan.lights[0].shadow_map = 0;
        ShadowMapPlan map;
        map.kind = kind;
        map.size = kSize;
        map.texel_size = 2.0f / kSize;
        const float half = 0.5f * kSize;
        if (kind == ShadowMapPlan::Kind::orthographic) {
            map.rows[0][0] = half, map.rows[0][3] = half;
            map.rows[1][1] = -half, map.rows[1][3] = half;
        } else if (kind == ShadowMapPlan::Kind::perspective) {
            map.rows[0][0] = half, map.rows[0][2] = -half, map.rows[0][3] = 10 * half;
            map.rows[1][1] = -half, map.rows[1][2] = -half, map.rows[1][3] = 10 * half;
        } else {
            for (int i = 0; i < 3; ++i) map.origin[i] = plan.lights[0].position[i];
        }
        map.rows[2][2] = -1, map.rows[2][3] = 10;
        plan.shadow_maps.push_back(map);
        connect();
    }
    Setup(const Setup&) = delete;
    Setup& operator=(const Setup&) = delete;
    void connect() { plan.shadow_maps[0].distance = texels.data(); }
    /// Two finer maps of the middle, 0.37 and 0.1 as wide.
    void add_cascades() {
        for (const float width : {0.37f, 0.1f}) {
            ShadowMapPlan map = plan.shadow_maps.front();
            map.coarser = static_cast<std::int32_t>(plan.shadow_maps.size());
            map.texel_size = 2.0f / kSize * width;
            map.rows[0][0] = 0.5f * kSize / width, map.rows[1][1] = -0.5f * kSize / width;
            plan.shadow_maps.insert(plan.shadow_maps.begin(), map);
        }
        for (std::size_t k = 0; k < plan.shadow_maps.size(); ++k) plan.shadow_maps[k].distance = texels.data() + k * kSize * kSize;
    }
    void fill(float distance) { std::fill(texels.begin(), texels.end(), distance); }

    /// The texels of the widest filter.
    void gather_wide() {
        const int side = wide_side(kSize);
        const std::size_t of_map = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
        wide.resize(plan.shadow_maps.size() * of_map);
        for (std::size_t k = 0; k < plan.shadow_maps.size(); ++k) {
            if (plan.shadow_maps[k].penumbra == 0) continue;
            for (int j = 0; j < side; ++j)
                for (int i = 0; i < side; ++i)
                    wide[k * of_map + static_cast<std::size_t>(j * side + i)] =
                        plan.shadow_maps[k].distance[wide_texel(j, kSize) * kSize + wide_texel(i, kSize)];
            plan.shadow_maps[k].wide = wide.data() + k * of_map;
        }
    }

    void shade(Isa isa, FragmentBlock& block) {
        gather_wide();
        shade_kernels(isa).shade(plan, plan.materials[0], all_lights(plan), block, kBlockSize);
    }
};

constexpr ShadowMapPlan::Kind kKinds[] = {ShadowMapPlan::Kind::orthographic, ShadowMapPlan::Kind::perspective, ShadowMapPlan::Kind::cube};
constexpr ShadowMode kModes[] = {ShadowMode::off, ShadowMode::hard, ShadowMode::soft_split};

/// All lanes at one place with one normal.
FragmentBlock uniform(Vec3f position, Vec3f normal) {
    FragmentBlock block{};
    for (int lane = 0; lane < kBlockSize; ++lane) {
        block.lane[kPosX][lane] = position.x, block.lane[kPosY][lane] = position.y, block.lane[kPosZ][lane] = position.z;
        block.lane[kNormalX][lane] = normal.x, block.lane[kNormalY][lane] = normal.y, block.lane[kNormalZ][lane] = normal.z;
        block.lane[kFacing][lane] = 1;
    }
    return block;
}

}  // namespace

TEST_CASE("shadow kernel: random maps and any fragments give scalar's bits on every set", "[shading][shadow]") {
    FloatMaker make(808);
    std::int64_t compared = 0;
    int hidden = 0;
    for (int round = 0; round < 1800; ++round) {
        Setup setup(kKinds[round % 3], make_lobe(make), kModes[1 + round / 3 % 2], round % 5 == 0);
        const bool wild_map = round % 7 == 0;
        for (float& d : setup.texels)
            d = make.below(3) == 0 ? kNoBlocker : wild_map ? make.wild(5, 15) : make.below(4) == 0 ? 10.0f : make.ordinary(5, 15);
        if (round % 3 == 0 && round % 4 != 0) setup.plan.shadow_maps[0].penumbra = make.ordinary(0, 1);
        FragmentBlock input{};
        fill_block(make, input, round % 2 == 0);
        FragmentBlock want = input;
        setup.shade(Isa::scalar, want);
        setup.plan.shadow_mode = ShadowMode::off;
        FragmentBlock open = input;
        setup.plan.lights[0].shadow_map = -1;
        setup.shade(Isa::scalar, open);
        setup.plan.lights[0].shadow_map = 0;
        setup.plan.shadow_mode = kModes[1 + round / 3 % 2];
        int different = 0, nans = 0;
        for (int lane = 0; lane < kBlockSize; ++lane) {
            hidden += want.red[lane] < open.red[lane];
            // A shadow must not turn a finite value into NaN.
            nans += std::isnan(want.red[lane]) && std::isfinite(open.red[lane]);
        }
        for (const Isa isa : other_isas()) {
            FragmentBlock got = input;
            setup.shade(isa, got);
            for (int lane = 0; lane < kBlockSize; ++lane)
                different += !same_bits(want.red[lane], got.red[lane]) || !same_bits(want.green[lane], got.green[lane]);
        }
        INFO("round " << round);
        if (different != 0) CHECK(different == 0);
        if (!wild_map && nans != 0) CHECK(nans == 0);
        compared += kBlockSize;
    }
    CHECK(compared > 100000);
    CHECK(hidden > 10000);
}

TEST_CASE("shadow kernel: an empty map, full shadow and depths at the limits are exact", "[shading][shadow]") {
    for (const auto kind : kKinds) {
        for (const ShadowMode mode : {ShadowMode::hard, ShadowMode::soft_split}) {
            for (const Lobe& lobe : {Lobe::lambert(), Lobe::sloan(0.5f), Lobe::valve(), Lobe{0.5f, 1, true}}) {
                INFO("kind " << static_cast<int>(kind) << ", mode " << static_cast<int>(mode) << ", wrap " << lobe.wrap);
                Setup setup(kind, lobe, mode);
                const auto red = [&](Vec3f position, Vec3f normal) {
                    FragmentBlock block = uniform(position, normal);
                    setup.shade(Isa::scalar, block);
                    return block.red[7];
                };
                const Vec3f here{0.1f, 0.05f, 0};
                const float ulp_up = std::nextafter(0.0f, 1.0f);
                const std::vector<Vec3f> normals{{0, 0, 1},
                                                 {0.6f, 0, 0.8f},
                                                 {1, 0, 0},
                                                 {1, 0, ulp_up},
                                                 {1, 0, -ulp_up},
                                                 {0.8660254f, 0, -0.5f},
                                                 {0, 1, -0.1f},
                                                 {0.8660254f, 0, -0.49999997f},
                                                 {0.8660254f, 0, -0.50000006f},
                                                 {0, 0, -1}};
                for (const Vec3f& n : normals) {
                    INFO("normal " << n.x << " " << n.y << " " << n.z);
                    setup.plan.shadow_mode = mode;
                    setup.plan.lights[0].shadow_map = -1;
                    setup.fill(kNoBlocker);
                    const float open = red(here, n);
                    setup.plan.lights[0].shadow_map = 0;
                    CHECK(open >= 0.0f);
                    CHECK(same_bits(red(here, n), open));  // nothing in the map
                    setup.fill(10.5f);                     // all of the map behind the receiver
                    CHECK(same_bits(red(here, n), open));
                    setup.fill(1.0f);  // far in front: distance d > fade distance d0 = 2
                    CHECK(red(here, n) == 0.0f);
                    setup.fill(9.0f);  // half of d0 in front: between 0 and the open value
                    CHECK(red(here, n) >= 0.0f);
                    CHECK(red(here, n) <= open);
                }
                // Facing the light, at exactly the stored depth: not hidden.
                setup.fill(10.0f);
                CHECK(red({0, 0, 0}, {0, 0, 1}) > 0.0f);
                // Off the map, and on its edges: no look-up leaves it.
                setup.fill(1.0f);
                for (const float x : {-1.0f, 1.0f, -1.0000001f, 1.0000001f, 11.0f, -1e30f, kInf, -kInf, kNan}) {
                    CHECK_FALSE(red({x, 0, 0}, {0, 0, 1}) < 0.0f);
                    CHECK_FALSE(red({0, x, x}, {0, 0, 1}) < 0.0f);
                }
                if (kind == ShadowMapPlan::Kind::orthographic) CHECK(red({1.5f, 0, 0}, {0, 0, 1}) == Approx(lobe.scale()));
            }
        }
    }
}

TEST_CASE("shadow kernel: a lit share is the weighted mean over 3 x 3 texels", "[shading][shadow]") {
    FloatMaker make(77);
    for (const ShadowMode mode : {ShadowMode::hard, ShadowMode::soft_split}) {
        const Lobe lobe = Lobe::sloan(0.5f);
        Setup setup(ShadowMapPlan::Kind::orthographic, lobe, mode);
        for (float& d : setup.texels) d = make.below(2) == 0 ? kNoBlocker : make.ordinary(7, 9.5f);
        for (int round = 0; round < 500; ++round) {
            const float x = make.ordinary(-0.65f, 0.65f), y = make.ordinary(-0.65f, 0.65f), cosine = make.ordinary(-0.49f, 1);
            const float sine = std::sqrt(1 - cosine * cosine);
            FragmentBlock block = uniform({x, y, 0}, {sine, 0, cosine});
            setup.shade(Isa::scalar, block);
            // In double: the point moves along the normal by 3 texels times the sine; the box around it is 3 texels wide.
            const double texel = 2.0 / kSize, offset = 3 * texel * double{sine};
            const double u = (x + offset * double{sine} + 1) / texel, v = (1 - double{y}) / texel;
            const double receiver = 10 - offset * double{cosine} - 0.5 * texel;
            double hard = 0, soft = 0;
            for (int j = 0; j < kSize; ++j) {
                for (int i = 0; i < kSize; ++i) {
                    const double du = std::clamp(2.0 - std::fabs(i + 0.5 - u), 0.0, 1.0),
                                 dv = std::clamp(2.0 - std::fabs(j + 0.5 - v), 0.0, 1.0);
                    const double d = receiver - double{setup.texels[static_cast<std::size_t>(j * kSize + i)]};
                    const double own = std::max(0.0, -double{cosine}) / 0.5 * 8 / 9;
                    const double t = std::clamp((d * 0.5 - own) / (1 - own), 0.0, 1.0);
                    hard += du * dv / 9 * (d > 0);
                    soft += du * dv / 9 * (1 - (1 - t) * (1 - t) * (1 + 2 * t));
                }
            }
            const double f = reference::lobe_value(lobe, double{cosine}),
                         core = mode == ShadowMode::hard ? f : std::min(f, std::max(0.0, double{cosine}));
            INFO("x " << x << ", y " << y << ", cosine " << cosine);
            CHECK(block.red[3] == Approx((1 - hard) * core + (1 - soft) * (f - core)).margin(2e-5));
        }
    }
}

TEST_CASE("shadow kernel: wrapped light does not return where a surface turns away below a caster", "[shading][shadow]") {
    // Sphere of radius 1 behind a plane blocker at distance d from the sphere's terminator. Where x = N.L is negative, the surface is |x|
    // farther from the blocker, and the sphere itself is 2 |x| thick towards the light. The light that is left must not grow with |x|. It
    // must be 0 from d0 on, and the lobe's f where d is 0.
    int compared = 0;
    for (const Lobe& lobe : {Lobe::sloan(0.25f), Lobe::sloan(0.5f), Lobe::sloan(1), Lobe::green(0.5f), Lobe::half_lambert()}) {
        Setup setup(ShadowMapPlan::Kind::orthographic, lobe, ShadowMode::soft_split);
        const float d0 = 2 * lobe.wrap / kOwnThickness;
        setup.plan.materials[0].shadow_fade_scale = 1 / d0;
        for (int i = 0; i <= 16; ++i) {
            const float d = d0 * static_cast<float>(i) / 16;
            setup.fill(10 - d);
            float before = kInf;
            for (int k = 0; k < 200; ++k) {
                const float x = -lobe.wrap * static_cast<float>(k) / 200;
                // Position whose look-up, 3 texels of the small map off the surface, is |x| farther.
                const float sine = std::sqrt(1 - x * x),
                            off = setup.plan.shadow_maps[0].offset * setup.plan.shadow_maps[0].texel_size * sine * x;
                FragmentBlock block = uniform({0, 0, x - off}, {sine, 0, x});
                setup.shade(Isa::scalar, block);
                const float left = block.red[0];
                INFO("wrap " << lobe.wrap << ", d " << d << ", x " << x << ", left " << left);
                ++compared;
                // The last bit of the light taken away is visible if hardly any light is left.
                if (!(left <= before + 1e-7f)) CHECK(left <= before);
                if (i == 0 && !(left >= 0.999f * static_cast<float>(reference::lobe_value(lobe, double{x}))))
                    CHECK(left == Approx(reference::lobe_value(lobe, double{x})));
                // The kernel takes half a texel off the distance.
                if (d - x > d0 + setup.plan.shadow_maps[0].texel_size && left != 0.0f) CHECK(left == 0.0f);
                before = left;
            }
        }
    }
    CHECK(compared == 5 * 17 * 200);
}

TEST_CASE("shadow kernel: shares agree with the float64 reference away from their jumps", "[shading][shadow][reference]") {
    FloatMaker make(4711);
    double worst = 0;
    int compared = 0, partly = 0, skipped = 0;
    for (int round = 0; round < 1200; ++round) {
        const auto kind = kKinds[round % 3];
        const ShadowMode mode = kModes[1 + round / 3 % 2];
        Lobe lobe = make_lobe(make);
        lobe.power = std::max(lobe.power, 1.0f);  // below 1 the lobe has an unbounded slope, and so has the error
        Setup setup(kind, lobe, mode);
        for (float& d : setup.texels) d = make.below(3) == 0 ? kNoBlocker : make.ordinary(7, 11);
        if (round >= 600 && kind == ShadowMapPlan::Kind::orthographic) setup.plan.shadow_maps[0].penumbra = make.ordinary(0, 1);
        if (round >= 900 && kind == ShadowMapPlan::Kind::orthographic) setup.add_cascades();
        FragmentBlock block{};
        for (int lane = 0; lane < kBlockSize; ++lane) {
            // Positions around the map's middle; one in four may lie beyond its rim. For a cube they surround the light, so that every face
            // is used.
            const float reach = lane % 4 == 0 ? 1.2f : 0.8f, spread = kind == ShadowMapPlan::Kind::cube ? 12.0f : 9 * reach;
            const Vec3d n = [&] {
                const Vec3d v{make.ordinary(-1, 1), make.ordinary(-1, 1), make.ordinary(-1, 1)};
                return v * (1 / std::sqrt(std::max(dot(v, v), 1e-3)));
            }();
            const bool flat = kind == ShadowMapPlan::Kind::orthographic;
            block.lane[kPosX][lane] = make.ordinary(-1, 1) * (flat ? reach : spread);
            block.lane[kPosY][lane] = make.ordinary(-1, 1) * (flat ? reach : spread);
            block.lane[kPosZ][lane] = flat ? make.ordinary(-1, 1) : make.ordinary(kind == ShadowMapPlan::Kind::cube ? 20.0f : 1.0f, -3);
            block.lane[kNormalX][lane] = static_cast<float>(n.x), block.lane[kNormalY][lane] = static_cast<float>(n.y);
            block.lane[kNormalZ][lane] = static_cast<float>(n.z), block.lane[kFacing][lane] = 1;
        }
        const FragmentBlock input = block;
        setup.shade(Isa::scalar, block);
        ShadingSettings options;
        options.specular = SpecularModel::none;
        const reference::FrameInputs frame{{}, std::span(&setup.light, 1), {}, options, {}, {0, 0, -1}, true};
        for (int lane = 0; lane < kBlockSize; ++lane) {
            const auto at = [&](int row) { return double{input.lane[row][lane]}; };
            const Vec3d position{at(kPosX), at(kPosY), at(kPosZ)}, n{at(kNormalX), at(kNormalY), at(kNormalZ)};
            const Vec3d normal = n * (1 / std::sqrt(dot(n, n)));
            Vec3d to_light{0, 0, 1};
            if (kind != ShadowMapPlan::Kind::orthographic) to_light = Vec3d{0, 0, 10} - position;
            to_light = to_light * (1 / std::sqrt(dot(to_light, to_light)));
            const auto hidden =
                reference::hidden_share(setup.plan.shadow_maps[0], position, normal, to_light, setup.plan.materials[0], mode);
            if (hidden.margin < 1e-5 * 25) {  // distances are up to 25, with errors of some 1e-6 of that
                ++skipped;
                continue;
            }
            const double x = dot(normal, to_light), open = reference::shade(frame, setup.material, 3u, input, lane).r;
            const double f = reference::lobe_value(lobe, x);
            const double want = f > 0 ? open * reference::shadowed_lobe(lobe, x, hidden, mode) / f : 0.0;
            const double error = std::fabs(block.red[lane] - want) / std::max(1.0, open);
            INFO("round " << round << ", lane " << lane << ", hidden " << hidden.hard << ", " << hidden.soft << ", margin "
                          << hidden.margin);
            if (!(error <= 4e-6)) CHECK(block.red[lane] == Approx(want));
            worst = std::max(worst, error), ++compared;
            partly += f > 0 && hidden.hard > 0 && hidden.hard < 1;
        }
    }
    INFO("worst " << worst << " of " << compared << ", " << partly << " partly hidden, " << skipped << " near a jump");
    CHECK(worst <= 4e-6);  // measured: 1.5e-6, for white surfaces under light of colour 1
    CHECK(compared > 40000);
    CHECK(partly > 5000);
}

TEST_CASE("shadow kernel: a penumbra is as wide as the distance from the blocker asks", "[shading][shadow]") {
    Setup setup(ShadowMapPlan::Kind::orthographic, {}, ShadowMode::hard);
    setup.plan.shadow_maps[0].penumbra = 0.25f;
    const double texel = double{setup.plan.shadow_maps[0].texel_size};
    // The left half is hidden by an edge that lies `height` above the receiver.
    const auto share_at = [&](double x) {
        FragmentBlock block = uniform({static_cast<float>(x), 0, 0}, {0, 0, 1}), open = block;
        setup.shade(Isa::scalar, block);
        setup.plan.lights[0].shadow_map = -1;
        setup.shade(Isa::scalar, open);
        setup.plan.lights[0].shadow_map = 0;
        return 1.0 - double{block.red[0]} / double{open.red[0]};
    };
    for (const double height : {0.25, 0.75, 1.5, 3.0}) {
        for (int i = 0; i < kSize * kSize; ++i)
            setup.texels[static_cast<std::size_t>(i)] = i % kSize < kSize / 2 ? static_cast<float>(10 - height) : kNoBlocker;
        double first = 0, last = 0, before = 1;
        for (double x = -0.8; x < 0.8; x += 0.005) {
            const double share = share_at(x);
            CHECK(share <= before + 1e-6);
            if (share > 0.9) first = x;
            if (share > 0.1) last = x;
            before = share;
        }
        const double wanted = 0.8 * std::max(3 * texel, height * 0.25);
        CAPTURE(height);
        CHECK(last - first == Approx(wanted).epsilon(0.35));
        CHECK(0.5 * (first + last) == Approx(0).margin(0.5 * wanted));
    }
    setup.fill(kNoBlocker);
    CHECK(share_at(0) == 0);
    setup.fill(5.0f);
    CHECK(share_at(0) == Approx(1));
}
