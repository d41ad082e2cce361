#include "bench/peer/labelled_mesh.hpp"

#include <array>

namespace halflit::peer {
namespace {

constexpr std::uint32_t kNone = ~0u;
constexpr std::uint8_t kLabels[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};

class Copies {
public:
    Copies(LabelledMesh& out, std::size_t vertices) : out_(out), first_(vertices, kNone) {}

    /// A copy of the vertex with this label; for a last corner one that is no triangle's last corner yet. kNone: there is none.
    [[nodiscard]] std::uint32_t find(std::uint32_t vertex, std::uint8_t label, bool is_last) const {
        for (std::uint32_t copy = first_[vertex]; copy != kNone; copy = next_[copy])
            if (out_.label[copy] == label && (!is_last || out_.code[copy] == 0)) return copy;
        return kNone;
    }
    std::uint32_t find_or_add(std::uint32_t vertex, std::uint8_t label, bool is_last) {
        const std::uint32_t found = find(vertex, label, is_last);
        if (found != kNone) return found;
        const auto added = static_cast<std::uint32_t>(out_.source.size());
        out_.source.push_back(vertex), out_.label.push_back(label), out_.code.push_back(0);
        next_.push_back(first_[vertex]);
        return first_[vertex] = added;
    }

private:
    LabelledMesh& out_;
    std::vector<std::uint32_t> first_, next_;  // lists of the copies, by the vertex
};

}  // namespace

LabelledMesh label_corners(const Mesh& mesh) {
    LabelledMesh out;
    Copies copies(out, mesh.positions.size());
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const auto corner = [&](std::size_t c) { return mesh.indices[3 * t + c % 3]; };
        int least = 4;
        std::size_t turn = 0;
        const std::uint8_t* labels = kLabels[0];
        for (std::size_t last = 0; last < 3; ++last)
            for (const auto& tried : kLabels) {
                int missing = 0;
                for (std::size_t c = 0; c < 3; ++c) missing += copies.find(corner(c), tried[c], c == last) == kNone;
                if (missing < least) least = missing, turn = last + 1, labels = tried;
            }
        for (std::size_t c = turn; c < turn + 3; ++c) out.indices.push_back(copies.find_or_add(corner(c), labels[c % 3], c == turn + 2));
        out.code[out.indices.back()] = static_cast<std::uint32_t>(16 * (t + 1)) + 4u * labels[2] + labels[1];
    }
    return out;
}

}  // namespace halflit::peer
