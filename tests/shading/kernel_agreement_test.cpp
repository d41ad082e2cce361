// Promise: every instruction set gives the scalar kernel's result bit for bit, for any input.
#include "random_case.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "tests/support/all_cores.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <mutex>
#include <sstream>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

/// Gives some lanes whole vectors that are zero, tiny (denormal, or with a length that underflows), huge (a length that overflows) or
/// infinite; every fourth lane is left as it is.
void roughen_vectors(FloatMaker& make, FragmentBlock& block) {
    constexpr float kScales[] = {0.0f, 1e-45f, 1e-40f, 1e-30f, 1e-20f, 1e15f, 1e30f, 1e38f, kInf};
    for (int lane = 0; lane < kBlockSize; ++lane) {
        if (lane % 4 == 3) continue;
        for (const int row : {static_cast<int>(kPosX), static_cast<int>(kNormalX), static_cast<int>(kTangentX)}) {
            if (make.below(2) == 0) continue;
            const float scale = kScales[make.below(std::size(kScales))];
            for (int i = 0; i < 3; ++i) block.lane[row + i][lane] *= scale;
        }
    }
}

/// True if a lane keeps the same bits of the light behind; for materials that transmit.
bool same_keep(const MaterialPlan& material, const FragmentBlock& a, const FragmentBlock& b, int lane) {
    if ((material.stages & kStageTransmission) == 0) return true;
    return same_bits(a.keep[0][lane], b.keep[0][lane]) && same_bits(a.keep[1][lane], b.keep[1][lane]) &&
           same_bits(a.keep[2][lane], b.keep[2][lane]);
}

/// Counts over a run of random cases.
struct Agreement {
    std::int64_t fragments = 0;  ///< each compared on every set
    std::int64_t nan_fragments = 0;
    std::int64_t differing = 0;
    std::uint32_t stages_seen = 0;
    std::string first;  ///< the first difference, with the numbers that repeat it

    void add(const Agreement& other) {
        fragments += other.fragments, nan_fragments += other.nan_fragments, differing += other.differing;
        stages_seen |= other.stages_seen;
        if (first.empty()) first = other.first;
    }
};

constexpr int kBlocksPerCase = 8;

/// Shades blocks of one random case by scalar and by every set. NaNs must be in the same places as scalar's; their bits do not count.
Agreement compare_case(std::uint32_t number, const std::vector<Isa>& isas) {
    FloatMaker make(20240607 + number);
    Case c = make_case(make, false);
    if (make.below(3) == 0) shorten(make, c);
    const MaterialPlan& material = c.plan.materials[number % 16 == 15 ? 1 : 0];
    Agreement seen;
    seen.stages_seen = material.stages;
    for (int round = 0; round < kBlocksPerCase; ++round) {
        FragmentBlock input{};
        fill_block(make, input, round % 3 != 0);
        if (round % 4 == 1) roughen_vectors(make, input);
        const int count = round % 2 == 0 ? kBlockSize : 1 + static_cast<int>(make.below(kBlockSize));
        FragmentBlock want = input, want_alpha = input;
        shade_kernels(Isa::scalar).shade(c.plan, material, all_lights(c.plan), want, count);
        shade_kernels(Isa::scalar).alpha(material, want_alpha, count);
        seen.fragments += count;
        for (int lane = 0; lane < count; ++lane)
            seen.nan_fragments += std::isnan(want.red[lane]) || std::isnan(want.green[lane]) || std::isnan(want.blue[lane]);
        for (const Isa isa : isas) {
            FragmentBlock got = input, got_alpha = input;
            shade_kernels(isa).shade(c.plan, material, all_lights(c.plan), got, count);
            shade_kernels(isa).alpha(material, got_alpha, count);
            for (int lane = 0; lane < count; ++lane) {
                if (same_bits(want.red[lane], got.red[lane]) && same_bits(want.green[lane], got.green[lane]) &&
                    same_bits(want.blue[lane], got.blue[lane]) && same_bits(want.alpha[lane], got.alpha[lane]) &&
                    same_bits(want_alpha.alpha[lane], got_alpha.alpha[lane]) && same_keep(material, want, got, lane))
                    continue;
                ++seen.differing;
                if (!seen.first.empty()) continue;
                std::ostringstream text;
                text << isa_name(isa) << ", case " << number << ", block " << round << ", lane " << lane << ", stages " << material.stages
                     << ", lobe path " << static_cast<int>(material.lobe.path) << ", lights " << c.plan.lights.size() << ": want "
                     << want.red[lane] << " " << want.green[lane] << " " << want.blue[lane] << " " << want.alpha[lane] << ", got "
                     << got.red[lane] << " " << got.green[lane] << " " << got.blue[lane] << " " << got.alpha[lane] << "; alpha kernel "
                     << want_alpha.alpha[lane] << ", got " << got_alpha.alpha[lane];
                seen.first = text.str();
            }
        }
    }
    return seen;
}

Agreement compare_cases(int case_count) {
    const std::vector<Isa> isas = other_isas();
    Agreement all;
    std::mutex mutex;
    halflit::test::on_all_cores(case_count, [&](std::int64_t number) {
        const Agreement one = compare_case(static_cast<std::uint32_t>(number), isas);
        const std::lock_guard lock(mutex);
        all.add(one);
    });
    return all;
}

/// Checks that every fragment of `case_count` random cases agrees, that every stage occurred, and that the share of NaNs was as intended.
void check_cases(int case_count) {
    const Agreement all = compare_cases(case_count);
    INFO(all.fragments << " fragments, " << all.nan_fragments << " with NaN; " << all.first);
    CHECK(all.differing == 0);
    // All stages but those that only frames bring into a plan, and shadow catchers, which have a test of their own.
    CHECK(all.stages_seen == (((1u << kStageCount) - 1u) & ~(kStagePrelit | kStageEnvironment | kStageShadowCatcher)));
    CHECK(all.fragments > std::int64_t{case_count} * kBlocksPerCase * kBlockSize / 2);
    CHECK(all.nan_fragments > all.fragments / 1000);
    CHECK(all.nan_fragments < all.fragments / 2);
}

}  // namespace

TEST_CASE("kernels: shade and alpha give scalar's bits on every set, for all stages and any input", "[shading][kernels]") {
    if (other_isas().empty()) HALFLIT_SKIP("no set but scalar here");
    check_cases(400);
}

TEST_CASE("kernels: shade and alpha give scalar's bits on every set, for 10^6 fragments of any input", "[shading][kernels][slow]") {
    if (other_isas().empty()) HALFLIT_SKIP("no set but scalar here");
    check_cases(2700);
}

TEST_CASE("kernels: shade and alpha give scalar's bits on every set, for 10^8 fragments of any input", "[shading][kernels][deep]") {
    if (other_isas().empty()) HALFLIT_SKIP("no set but scalar here");
    check_cases(270000);
}

TEST_CASE("kernels: light alone gives scalar's bits on every set, and shade with its result agrees with plain shade",
          "[shading][kernels]") {
    FloatMaker make(55);
    int compared = 0;
    for (int round = 0; round < 200; ++round) {
        const Case c = make_case(make, true);
        const MaterialPlan& material = c.plan.materials[0];
        if ((material.stages & (kStageLights | kStageAmbient)) == 0) continue;
        const bool wild = round % 2 == 0;
        FragmentBlock input{};
        fill_block(make, input, wild);
        FragmentBlock want = input, direct = input;
        shade_kernels(Isa::scalar).light(c.plan, material, all_lights(c.plan), want, kBlockSize);
        for (const Isa isa : other_isas()) {
            FragmentBlock got = input;
            shade_kernels(isa).light(c.plan, material, all_lights(c.plan), got, kBlockSize);
            int different = 0;
            for (int row = kPosX; row <= kNormalZ; ++row)
                for (int lane = 0; lane < kBlockSize; ++lane) different += !same_bits(want.lane[row][lane], got.lane[row][lane]);
            INFO(isa_name(isa) << ", round " << round << ", stages " << material.stages);
            CHECK(different == 0);
        }
        if (wild || (material.stages & kStageSpecular) != 0) continue;
        // Without specular the model is affine in the base colour, so the two ways differ by rounding only.
        MaterialPlan prelit = material;
        prelit.stages |= kStagePrelit;
        shade_kernels(Isa::scalar).shade(c.plan, material, all_lights(c.plan), direct, kBlockSize);
        shade_kernels(Isa::scalar).shade(c.plan, prelit, all_lights(c.plan), want, kBlockSize);
        for (int lane = 0; lane < kBlockSize; ++lane, ++compared)
            if (std::fabs(want.red[lane] - direct.red[lane]) > 1e-6f * std::max(1.0f, std::fabs(direct.red[lane])))
                FAIL("round " << round << ", lane " << lane << ": " << want.red[lane] << " for " << direct.red[lane]);
    }
    CHECK(compared > 500);
}

TEST_CASE("kernels: a lane's value does not depend on its place or its neighbours", "[shading][kernels]") {
    FloatMaker make(99);
    for (int round = 0; round < 60; ++round) {
        const Case c = make_case(make, false);
        FragmentBlock block{};
        fill_block(make, block, true);
        for (const Isa isa : built_isas()) {
            if (!isa_available(isa)) continue;
            FragmentBlock straight = block, turned = block;
            for (int row = 0; row < kInputRows; ++row)
                for (int lane = 0; lane < kBlockSize; ++lane) turned.lane[row][lane] = block.lane[row][(lane * 37 + 11) % kBlockSize];
            shade_kernels(isa).shade(c.plan, c.plan.materials[0], all_lights(c.plan), straight, kBlockSize);
            shade_kernels(isa).shade(c.plan, c.plan.materials[0], all_lights(c.plan), turned, kBlockSize);
            int different = 0;
            for (int lane = 0; lane < kBlockSize; ++lane) {
                const int from = (lane * 37 + 11) % kBlockSize;
                different += !same_bits(turned.red[lane], straight.red[from]) || !same_bits(turned.green[lane], straight.green[from]) ||
                             !same_bits(turned.blue[lane], straight.blue[from]);
            }
            INFO(isa_name(isa) << ", round " << round);
            CHECK(different == 0);
        }
    }
}

TEST_CASE("kernels: shade's alpha of a blended material is the alpha kernel's", "[shading][kernels]") {
    FloatMaker make(4);
    int blended = 0;
    for (int round = 0; round < 200; ++round) {
        const Case c = make_case(make, false);
        if (c.materials[0].alpha_mode != AlphaMode::blend) continue;
        ++blended;
        FragmentBlock shaded{}, alpha{};
        fill_block(make, shaded, true);
        alpha = shaded;
        shade_kernels(Isa::scalar).shade(c.plan, c.plan.materials[0], all_lights(c.plan), shaded, kBlockSize);
        shade_kernels(Isa::scalar).alpha(c.plan.materials[0], alpha, kBlockSize);
        for (int lane = 0; lane < kBlockSize; ++lane)
            if (!same_bits(shaded.alpha[lane], alpha.alpha[lane])) FAIL("lane " << lane << ", round " << round);
    }
    CHECK(blended > 30);
}

TEST_CASE("kernels: sRGB encoding gives scalar's codes on every set", "[shading][kernels]") {
    if (other_isas().empty()) HALFLIT_SKIP("no set but scalar here");
    FloatMaker make(12);
    constexpr int kCount = 1 << 16;
    std::vector<float> channel[4];
    for (auto& values : channel)
        for (int i = 0; i < kCount; ++i) values.push_back(make.wild(-0.1f, 1.2f));
    for (const float exposure : {1.0f, 0.3f, 1e20f, kInf, kNan}) {
        std::vector<std::uint32_t> want(kCount), got(kCount);
        shade_kernels(Isa::scalar)
            .encode_srgb8(channel[0].data(), channel[1].data(), channel[2].data(), channel[3].data(), exposure, want.data(), kCount);
        for (const Isa isa : other_isas()) {
            shade_kernels(isa).encode_srgb8(channel[0].data(), channel[1].data(), channel[2].data(), channel[3].data(), exposure,
                                            got.data(), kCount);
            INFO(isa_name(isa) << ", exposure " << exposure);
            CHECK(got == want);
        }
    }
}
