// Tests of the certificate on parts that are wrong somewhere.
#include "sh/vec3d.hpp"
#include "tests/look/certified.hpp"
#include "tests/support/bracket.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <sstream>
#include <string>

using namespace halflit;
using namespace halflit::engine;
using namespace halflit::test;

namespace {

constexpr int kWidth = 320, kHeight = 256, kLeast = 4;

enum class Defect { hole, no_chamfer, flipped_face, body_inside, step, no_rib, shifted_hole };
constexpr const char* kDefectNames[] = {"hole", "no chamfer", "flipped face", "body inside", "step", "no rib", "shifted hole"};

/// A sound bracket and a wrong one.
struct Pair {
    Mesh sound, wrong;
    std::vector<std::size_t> triangles;  ///< of the wrong one that are the defect; none where something is missing
    std::vector<std::size_t> missing;    ///< of the sound one that the wrong one lacks
};

Pair make_pair(Defect defect, Random& random) {
    BracketPlan plan = random_bracket(random), wrong_plan = plan;
    if (defect == Defect::no_chamfer) wrong_plan.chamfer = 0;
    if (defect == Defect::body_inside) wrong_plan.body_inside = true;
    if (defect == Defect::step) wrong_plan.step = 0.1;
    if (defect == Defect::no_rib) wrong_plan.rib = false;
    if (defect == Defect::shifted_hole) {
        wrong_plan.shift.resize(static_cast<std::size_t>(plan.holes));
        const auto hole = static_cast<std::size_t>(random.index(plan.holes));
        const double side = random.chance(0.5) ? 1 : -1;
        wrong_plan.shift[hole] = side * random.real(0.3, 3);
    }
    const Bracket sound = make_bracket(plan), wrong = make_bracket(wrong_plan);
    Pair pair{sound.mesh, wrong.mesh, {}, {}};
    const auto all = [](FeatureRange range, std::vector<std::size_t>& to) {
        for (std::size_t i = range.first; i < range.last; ++i) to.push_back(i);
    };
    const auto some = static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(sound.mesh.indices.size() / 3) - 1));
    switch (defect) {
        case Defect::hole:
            pair.missing = {some};
            pair.wrong = without_triangles(pair.wrong, pair.missing);
            break;
        case Defect::flipped_face:
            std::swap(pair.wrong.indices[3 * some], pair.wrong.indices[3 * some + 1]);
            generate_flat_normals(pair.wrong);
            pair.triangles = {some};
            break;
        case Defect::no_chamfer:
            all(sound.chamfer, pair.missing);
            break;
        case Defect::body_inside:
            all(wrong.body, pair.triangles);
            break;
        case Defect::step:
            all(wrong.step, pair.triangles);
            break;
        case Defect::no_rib:
            all(sound.rib, pair.missing);
            break;
        case Defect::shifted_hole:
            for (std::size_t i = wrong.holes.first; i < wrong.holes.last; ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    if (wrong.mesh.positions[3 * i + k] != sound.mesh.positions[3 * i + k]) {
                        pair.triangles.push_back(i);
                        break;
                    }
            break;
    }
    return pair;
}

Scene scene_of(const Mesh& mesh) {
    Scene scene;
    scene.meshes = {mesh};
    scene.instances.resize(1);
    return scene;
}

ViewShot shot_of(RenderJob& job, const Camera& camera) {
    Renderer renderer;
    auto shot = draw_shot(job, renderer, "view", camera, {.depth = true, .normal = true});
    REQUIRE(shot);
    return std::move(*shot);
}

/// Pixels at which two pictures of one camera show surfaces of other places or directions.
std::int64_t other_surfaces(const ViewShot& a, const ViewShot& b) {
    std::int64_t count = 0;
    for (std::size_t i = 0; i < a.depth.size(); ++i) {
        if (a.instance[i] == 0 && b.instance[i] == 0) continue;
        bool differs = (a.instance[i] == 0) != (b.instance[i] == 0) || std::abs(a.depth[i] - b.depth[i]) > 1e-3f;
        for (std::size_t k = 0; k < 3; ++k) differs = differs || std::abs(a.normal[3 * i + k] - b.normal[3 * i + k]) > 1e-3f;
        count += differs ? 1 : 0;
    }
    return count;
}

enum class Verdict { visible, named, neither };

struct Row {
    int count = 0, visible = 0, named = 0, neither = 0;
    int pictures = 0, same_pictures = 0;  ///< that show the defect, and those that are the same without it
};

/// A defect is visible if a certified picture of the wrong part has at least kLeast pixels at which it shows a surface that the sound part
/// does not have there. It is named if the certificate lists all of its triangles as not seen. Where something is missing, there is no
/// triangle to list: it is named if the sound part's certificate lists those that are missing.
Verdict judge(const Pair& pair, Row& row) {
    Certified one = certified(scene_of(pair.wrong), kWidth, kHeight, kLeast);
    RenderJob sound = scene_job(scene_of(pair.sound), kWidth, kHeight);
    const Certificate& certificate = one.certificate;
    bool visible = false;
    // Pictures that the certificate gives for the defect's triangles; all pictures where something is missing.
    std::vector<std::size_t> views;
    for (std::size_t v = 0; v < certificate.shots.size(); ++v) {
        const bool shows = pair.triangles.empty() || std::any_of(pair.triangles.begin(), pair.triangles.end(), [&](std::size_t i) {
                               const TriangleView& triangle = certificate.triangles[i];
                               return triangle.status == TriangleStatus::seen && triangle.view == static_cast<int>(v);
                           });
        if (shows) views.push_back(v);
    }
    for (const std::size_t v : views) {
        const Camera& camera = certificate.shots[v].camera;
        const ViewShot wrong = shot_of(one.job, camera), right = shot_of(sound, camera);
        const std::int64_t other = other_surfaces(wrong, right);
        if (other < kLeast && pair.triangles.empty()) continue;
        ++row.pictures;
        row.same_pictures += wrong.picture.rgba8 == right.picture.rgba8 ? 1 : 0;
        visible = visible || other >= kLeast;
        if (visible) break;
    }
    if (visible) return Verdict::visible;
    const auto is_listed = [&](std::size_t i) {
        const TriangleStatus status = certificate.triangles[i].status;
        return status == TriangleStatus::hidden || status == TriangleStatus::less || status == TriangleStatus::unknown;
    };
    if (!pair.triangles.empty())
        return std::all_of(pair.triangles.begin(), pair.triangles.end(), is_listed) ? Verdict::named : Verdict::neither;
    const Certified whole = certified(scene_of(pair.sound), kWidth, kHeight, kLeast);
    const bool listed = std::all_of(pair.missing.begin(), pair.missing.end(),
                                    [&](std::size_t i) { return whole.certificate.triangles[i].status != TriangleStatus::seen; });
    return listed ? Verdict::named : Verdict::neither;
}

void check_defects(int of_each) {
    std::ostringstream table;
    for (int kind = 0; kind < 7; ++kind) {
        Row row;
        for (int i = 0; i < of_each; ++i) {
            const std::uint64_t seed = static_cast<std::uint64_t>(1000 * kind + i);
            Random random(seed);
            const Verdict verdict = judge(make_pair(static_cast<Defect>(kind), random), row);
            ++row.count;
            ++(verdict == Verdict::visible ? row.visible : verdict == Verdict::named ? row.named : row.neither);
            INFO(kDefectNames[kind] << ", seed " << seed);
            CHECK(verdict != Verdict::neither);
        }
        table << kDefectNames[kind] << ": " << row.count << " defects, " << row.visible << " visible, " << row.named << " named, "
              << row.neither << " neither; " << row.pictures << " pictures compared, " << row.same_pictures << " the same\n";
        INFO(table.str());
        CHECK(row.same_pictures == 0);
        CHECK(row.pictures + row.named >= row.count);
    }
    if (of_each > 10) std::cout << table.str();
}

}  // namespace

TEST_CASE("certificate: a defect of each kind is visible in a certified picture, or named as not seen", "[look]") { check_defects(2); }

TEST_CASE("certificate: five hundred defects are visible or named", "[look][deep]") { check_defects(72); }
