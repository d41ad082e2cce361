#include "apps/halflit/report/line_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_easy_font.h>
#pragma GCC diagnostic pop

namespace halflit::cli {
namespace {

std::string plain(std::string text) {
    for (char& c : text)
        if (c < 32 || c > 126) c = '?';
    return text;
}

}  // namespace

std::vector<TextBar> text_bars(const std::string& text) {
    constexpr std::size_t kVertexBytes = 16, kQuadBytes = 4 * kVertexBytes, kMostQuads = 16;  // of a letter
    std::string line = plain(text);
    std::vector<char> vertices(kQuadBytes * kMostQuads * (line.size() + 1));
    const int quads = stb_easy_font_print(0, 0, line.data(), nullptr, vertices.data(), static_cast<int>(vertices.size()));
    std::vector<TextBar> bars;
    for (int q = 0; q < quads; ++q) {
        float low[2], high[2];
        const char* quad = vertices.data() + kQuadBytes * static_cast<std::size_t>(q);
        std::memcpy(low, quad, sizeof low);
        std::memcpy(high, quad + 2 * kVertexBytes, sizeof high);
        const auto x = static_cast<int>(low[0]), y = static_cast<int>(low[1]);
        bars.push_back({x, y, static_cast<int>(high[0]) - x, static_cast<int>(high[1]) - y});
    }
    return bars;
}

int text_width(const std::string& text) {
    std::string line = plain(text);
    return stb_easy_font_width(line.data());
}

std::string cut_to_width(std::string text, int width) {
    if (text_width(text) <= width) return text;
    while (!text.empty() && text_width(text + "..") > width) text.pop_back();
    return text + "..";
}

std::vector<std::string> wrapped_lines(const std::string& text, int width) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        std::size_t end = begin + 1;
        while (end < text.size() && text_width(text.substr(begin, end + 1 - begin)) <= width) ++end;
        const std::size_t space = end < text.size() ? text.rfind(' ', end) : std::string::npos;
        if (space != std::string::npos && space > begin) end = space;
        lines.push_back(text.substr(begin, end - begin));
        begin = end < text.size() && text[end] == ' ' ? end + 1 : end;
    }
    return lines;
}

}  // namespace halflit::cli
