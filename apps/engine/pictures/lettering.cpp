#include "apps/engine/pictures/lettering.hpp"

#include "apps/io/files/text.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

// Only the outlines and measures of stb_truetype are used, which are whole numbers. Canvas fills them.
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

namespace halflit::engine {
namespace {

constexpr std::uint8_t kFontFile[] = {
#include "dejavu_sans.inc"
};
constexpr double kUnitsPerEm = 2048;  // of this font
constexpr int kCapHeight = 1493;      // of "H", in these units
constexpr std::string_view kEllipsis = "\u2026";

const stbtt_fontinfo& font() {
    static const stbtt_fontinfo info = [] {
        stbtt_fontinfo made{};
        stbtt_InitFont(&made, kFontFile, 0);
        return made;
    }();
    return info;
}

struct Letter {
    int glyph;
    int begin, end;      ///< of the pen, font units from the start of the text
    std::size_t offset;  ///< of its first byte
};

/// The character at an offset; U+FFFF, which no font has, for a byte that is not UTF-8. Moves the offset behind it.
int next_character(std::string_view text, std::size_t& offset) {
    const int bytes = io::utf8_sequence(text, offset);
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (bytes == 0) return ++offset, 0xffff;
    int code = bytes == 1 ? byte(offset) : byte(offset) & (0x7f >> bytes);
    for (int i = 1; i < bytes; ++i) code = code << 6 | (byte(offset + static_cast<std::size_t>(i)) & 0x3f);
    offset += static_cast<std::size_t>(bytes);
    return code;
}

std::vector<Letter> letters_of(std::string_view text) {
    std::vector<Letter> letters;
    for (std::size_t offset = 0; offset < text.size();) {
        Letter letter{0, letters.empty() ? 0 : letters.back().end, 0, offset};
        letter.glyph = stbtt_FindGlyphIndex(&font(), next_character(text, offset));
        if (!letters.empty()) letter.begin += stbtt_GetGlyphKernAdvance(&font(), letters.back().glyph, letter.glyph);
        int advance = 0;
        stbtt_GetGlyphHMetrics(&font(), letter.glyph, &advance, nullptr);
        letter.end = letter.begin + advance;
        letters.push_back(letter);
    }
    return letters;
}

/// The outline of a glyph whose pen starts at (x, 0) in font units, in pixels from the start of its line.
std::vector<Contour> outline_of(int glyph, int x, double scale) {
    stbtt_vertex* found = nullptr;
    const int count = stbtt_GetGlyphShape(&font(), glyph, &found);
    const auto free_it = [](stbtt_vertex* v) { stbtt_FreeShape(&font(), v); };
    const std::unique_ptr<stbtt_vertex, decltype(free_it)> vertices(found, free_it);
    const auto place = [&](double px, double py) { return Point{on_canvas_grid((px + x) * scale), on_canvas_grid(-py * scale)}; };
    std::vector<Contour> contours;
    Point pen{};  // font units
    for (int i = 0; i < count; ++i) {
        const stbtt_vertex& v = found[i];
        const Point to{static_cast<double>(v.x), static_cast<double>(v.y)}, control{static_cast<double>(v.cx), static_cast<double>(v.cy)};
        if (v.type == STBTT_vmove || contours.empty()) contours.emplace_back();
        if (v.type == STBTT_vcurve) {
            // A chord of one n-th of the parabola is at most |p0 - 2 p1 + p2| / (4 n^2) off; 1/30 pixel does not show.
            const Point bend = pen - control * 2.0 + to;
            const double off = (std::abs(bend.x) + std::abs(bend.y)) * scale / 4;
            int pieces = 1;
            while (pieces < 32 && off > pieces * pieces / 30.0) ++pieces;
            for (int k = 1; k < pieces; ++k) {
                const double t = static_cast<double>(k) / pieces, s = 1 - t;
                contours.back().push_back(
                    place(s * s * pen.x + 2 * s * t * control.x + t * t * to.x, s * s * pen.y + 2 * s * t * control.y + t * t * to.y));
            }
        }
        contours.back().push_back(place(to.x, to.y));
        pen = to;
    }
    return contours;
}

/// Number of letters from `first` on that have room on a line.
std::size_t letters_on_line(std::string_view text, const std::vector<Letter>& letters, std::size_t first, double units) {
    const auto character = [&](std::size_t i) { return text[letters[i].offset]; };
    std::size_t end = first + 1, after_space = 0, after_mark = 0;
    for (; end < letters.size() && (letters[end].end - letters[first].begin <= units || character(end) == ' '); ++end) {
        if (character(end) == ' ') after_space = end + 1;
        if (std::string_view("-_/.:,").find(character(end)) != std::string_view::npos) after_mark = end + 1;
    }
    if (end == letters.size()) return end - first;
    if (after_space > 0) return after_space - first;
    return (2 * (after_mark - std::min(after_mark, first)) >= end - first ? after_mark : end) - first;
}

}  // namespace

double width_of_text(std::string_view text, double size) {
    const std::vector<Letter> letters = letters_of(text);
    return letters.empty() ? 0.0 : letters.back().end * (size / kUnitsPerEm);
}

double cap_height(double size) { return kCapHeight * (size / kUnitsPerEm); }

std::string cut_to_width(std::string_view text, double size, double width, Cut cut) {
    const std::vector<Letter> letters = letters_of(text);
    const double units = width / size * kUnitsPerEm;
    if (letters.empty() || letters.back().end <= units) return std::string(text);
    const double room = units - letters_of(kEllipsis).back().end, room_of_head = cut == Cut::end ? room : room / 2;
    std::size_t head = 0, tail = letters.size();  // letters before, and the first one after, what is cut
    while (head < letters.size() && letters[head].end <= room_of_head) ++head;
    const double room_of_tail = room - (head > 0 ? letters[head - 1].end : 0);
    while (cut == Cut::middle && tail > head && letters.back().end - letters[tail - 1].begin <= room_of_tail) --tail;
    for (;; head > 0 ? --head : ++tail) {  // the ellipsis is kerned too
        const std::size_t begin_of_tail = tail < letters.size() ? letters[tail].offset : text.size();
        std::string shown = std::string(text.substr(0, head < letters.size() ? letters[head].offset : text.size()));
        shown.append(kEllipsis).append(text.substr(begin_of_tail));
        if (letters_of(shown).back().end <= units) return shown;
        if (head == 0 && tail >= letters.size()) return {};
    }
}

std::vector<std::string> wrapped_lines(std::string_view text, double size, double width, std::size_t most, Cut cut) {
    const std::vector<Letter> letters = letters_of(text);
    std::vector<std::string> lines;
    for (std::size_t first = 0; first < letters.size() && lines.size() < most;) {
        const std::size_t end = first + letters_on_line(text, letters, first, width / size * kUnitsPerEm);
        const std::size_t begin = letters[first].offset;
        if (lines.size() + 1 == most && end < letters.size()) {
            lines.push_back(cut_to_width(text.substr(begin), size, width, cut));
            break;
        }
        std::string_view line = text.substr(begin, (end < letters.size() ? letters[end].offset : text.size()) - begin);
        while (end < letters.size() && line.ends_with(' ')) line.remove_suffix(1);
        lines.emplace_back(line);
        first = end;
    }
    return lines;
}

void draw_text(Canvas& canvas, Point at, std::string_view text, const LetterStyle& style) {
    const std::vector<Letter> letters = letters_of(text);
    if (letters.empty() || !(style.size > 0.0 && style.size <= 1000.0)) return;
    const double scale = style.size / kUnitsPerEm, width = letters.back().end * scale;
    const double before = style.align == Align::left ? 0.0 : style.align == Align::middle ? width / 2 : width;
    const Point pen{std::floor(at.x - before + 0.5), std::floor(at.y + 0.5)};
    for (const Letter& letter : letters) {
        if (!(pen.x + letter.begin * scale <= canvas.image().width + style.size && pen.x + letter.end * scale >= -style.size)) continue;
        std::vector<Contour> contours = outline_of(letter.glyph, letter.begin, scale);
        for (Contour& contour : contours)
            for (Point& p : contour) p = p + pen;
        canvas.fill(contours, style.color);
    }
}

}  // namespace halflit::engine
