// Fragments of one pixel that show one smooth surface are shaded as one. Triangles that share corners share what is interpolated between
// them, so that one of them, at the middle of the pixel, stands for the others.
#include "raster/passes/picture_tile.hpp"

#include <algorithm>
#include <utility>

namespace halflit::raster {
namespace {

/// Decides which triangles that a pixel shows are parts of one smooth surface there.
class Surfaces {
public:
    Surfaces(const ViewGeometry& geometry, const VertexRecords& records, SurfacePairs& known)
        : geometry_(geometry), records_(records), known_(known) {}

    [[nodiscard]] bool are_one(std::uint32_t a, std::uint32_t b, int x_px, int y_px) const {
        // Neighbouring pixels show the same pairs again.
        if (a > b) std::swap(a, b);
        SurfacePairs::Pair& pair = known_.of(a, b);
        if (pair.a != a || pair.b != b) pair = find(a, b);
        if (pair.kind != SurfacePairs::Kind::near_corner) return pair.kind == SurfacePairs::Kind::one;
        constexpr int kPixel = 256;  // ScreenVertex has eight bits after the point
        const auto dx = static_cast<unsigned>(pair.x - (x_px - 1) * kPixel), dy = static_cast<unsigned>(pair.y - (y_px - 1) * kPixel);
        return dx <= 2u * kPixel && dy <= 2u * kPixel;
    }

private:
    /// Two triangles are one surface if they have an edge of their mesh in common, or one corner that is not farther than a pixel, and are
    /// large or have normals that are alike at these corners.
    [[nodiscard]] SurfacePairs::Pair find(std::uint32_t a, std::uint32_t b) const {
        SurfacePairs::Pair pair{a, b, SurfacePairs::Kind::apart, 0, 0};
        const TriangleRecord &of_a = geometry_.record(a), &of_b = geometry_.record(b);
        if (!geometry_.draw_of(of_a).few_vertices || of_a.draw_and_bits != of_b.draw_and_bits) return pair;
        unsigned common = 0, common_of_b = 0;  // bit k: corner k is one of the other triangle's
        for (unsigned k = 0; k < 3; ++k)
            for (unsigned l = 0; l < 3; ++l) {
                const auto same =
                    static_cast<unsigned>(geometry_.corner_of_draw(of_a.vertex[k]) == geometry_.corner_of_draw(of_b.vertex[l]));
                common |= same << k, common_of_b |= same << l;
            }
        if (common == 0) return pair;
        const std::size_t chunk_a = geometry_.chunk_of(a), chunk_b = geometry_.chunk_of(b);
        if (chunk_a != chunk_b)  // corners that clipping made are numbered by chunk
            for (unsigned k = 0; k < 3; ++k) {
                if (of_a.vertex[k] & kClipVertex) common &= ~(1u << k);
                if (of_b.vertex[k] & kClipVertex) common_of_b &= ~(1u << k);
            }
        if (common == 0) return pair;
        const SurfacePairs::Shape first = shape_of(a, of_a, chunk_a), second = shape_of(b, of_b, chunk_b);
        if (!(first.large && second.large) && ((first.unlike & edges_at(common)) | (second.unlike & edges_at(common_of_b))) != 0)
            return pair;
        pair.kind = SurfacePairs::Kind::one;
        if (common == 1 || common == 2 || common == 4) {
            const ScreenVertex& at = vertex_of(geometry_.source(chunk_a), of_a.vertex[common >> 1]);
            pair.kind = SurfacePairs::Kind::near_corner, pair.x = at.x, pair.y = at.y;
        }
        return pair;
    }

    /// Edges that end at some of these corners; edge k goes from corner k to the next one.
    [[nodiscard]] static unsigned edges_at(unsigned corners) { return (corners | corners >> 1 | corners << 2) & 7u; }

    /// Normals are alike within 25.7 degrees. Where those of two triangles are not like those of the corners that they have in common, each
    /// one's own light is needed: of 90, 45, 26, 14 and 8 degrees it is the widest that adds no more than one part in a hundred to the
    /// error of a dense model.
    [[nodiscard]] SurfacePairs::Shape shape_of(std::uint32_t id, const TriangleRecord& triangle, std::size_t chunk) const {
        SurfacePairs::Shape& shape = known_.of(id);
        if (shape.triangle == id) return shape;
        shape = {id};
        const ScreenVertex* at[3];
        for (int k = 0; k < 3; ++k) at[k] = &vertex_of(geometry_.source(chunk), triangle.vertex[k]);
        constexpr std::int64_t kPixel = 256, kTwiceTheArea = 2 * 32 * kPixel * kPixel;
        const std::int64_t ux = at[1]->x - at[0]->x, uy = at[1]->y - at[0]->y, vx = at[2]->x - at[0]->x, vy = at[2]->y - at[0]->y;
        shape.large = ux * vy - uy * vx >= kTwiceTheArea;
        const std::size_t draw = triangle.draw();
        if (records_.stride(draw) <= shading::kNormalX + 2) return shape;  // no light, no normals
        constexpr float kLeastCosineSquared = 0.8125f;
        const auto product = [](const float* m, const float* n) { return (m[0] * n[0] + m[1] * n[1]) + m[2] * n[2]; };
        const float* normal[3];
        float length[3];
        for (int k = 0; k < 3; ++k) {
            normal[k] = records_.of_corner(chunk, draw, triangle.vertex[k]) + shading::kNormalX;
            length[k] = product(normal[k], normal[k]);
        }
        for (unsigned k = 0; k < 3; ++k) {
            const unsigned next = k == 2 ? 0 : k + 1;
            const float cosine = product(normal[k], normal[next]);
            const bool alike = (cosine > 0.0f) & (cosine * cosine >= kLeastCosineSquared * (length[k] * length[next]));
            shape.unlike |= static_cast<unsigned>(!alike) << k;
        }
        return shape;
    }

    const ViewGeometry& geometry_;
    const VertexRecords& records_;
    SurfacePairs& known_;
};

/// True if the first set has more samples.
bool has_more(std::int32_t samples, std::int32_t than) {
    const auto count = [](std::int32_t set) {  // std::popcount is a call where the instruction is not at hand
        auto n = static_cast<unsigned>(set);
        n = (n & 0x5555u) + (n >> 1 & 0x5555u);
        n = (n & 0x3333u) + (n >> 2 & 0x3333u);
        n = (n & 0x0f0fu) + (n >> 4 & 0x0f0fu);
        return (n & 0xffu) + (n >> 8);
    };
    return count(samples) > count(than);
}

/// Joins the fragments of one pixel, at most kMaxSamples: the first of each surface gets all of its samples, and the others none. True if
/// there are such.
bool join_pixel(const Surfaces& surfaces, std::uint32_t* id, std::int32_t* samples, int count, int x_px, int y_px) {
    if (count == 2) {
        if (!surfaces.are_one(id[0], id[1], x_px, y_px)) return false;
        if (has_more(samples[1], samples[0])) id[0] = id[1];
        samples[0] |= std::exchange(samples[1], 0);
        return true;
    }
    int surface[kMaxSamples];  // the first fragment of the surface that a fragment shows
    for (int i = 0; i < count; ++i) surface[i] = i;
    bool any = false;
    for (int i = 1; i < count; ++i)
        for (int j = 0; j < i; ++j) {
            if (surface[i] == surface[j] || !surfaces.are_one(id[i], id[j], x_px, y_px)) continue;
            const int from = std::max(surface[i], surface[j]), to = std::min(surface[i], surface[j]);
            std::replace(surface, surface + count, from, to);
            any = true;
        }
    if (!any) return false;
    for (int i = 0; i < count; ++i) {
        if (surface[i] != i) continue;
        std::int32_t most = samples[i];  // the triangle of the most samples is shaded
        for (int j = i + 1; j < count; ++j) {
            if (surface[j] != i) continue;
            if (has_more(samples[j], most)) most = samples[j], id[i] = id[j];
            samples[i] |= std::exchange(samples[j], 0);
        }
    }
    return true;
}

}  // namespace

void PictureTile::join(PixelFragments& row, int y_px) const {
    const Surfaces surfaces(pass_.view.geometry, pass_.view.records, scratch_.pairs);
    // Pixels of several fragments. Loops over all fragments have no branches, as most of them would be mispredicted.
    int begin[kPixelsARow + 1], pixels = 0;
    row.x_px[row.count] = row.x_px[row.count - 1] + 1;
    for (int i = 0, before = row.x_px[0] - 1; i < row.count; ++i) {
        begin[pixels] = i;
        const int x_px = row.x_px[i];
        pixels += static_cast<int>(x_px != before) & static_cast<int>(row.x_px[i + 1] == x_px);
        before = x_px;
    }
    bool any = false;
    for (int p = 0; p < pixels; ++p) {
        const int first = begin[p], x_px = row.x_px[first];
        int end = first + 2;
        while (row.x_px[end] == x_px) ++end;
        any |= join_pixel(surfaces, row.id + first, row.samples + first, end - first, x_px, y_px);
    }
    if (!any) return;
    keep_fragments(row, [&](int i) { return row.samples[i] != 0; });
}

}  // namespace halflit::raster
