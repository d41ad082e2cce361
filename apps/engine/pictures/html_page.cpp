#include "apps/engine/pictures/html_page.hpp"

#include "apps/engine/basics/base64.hpp"
#include "apps/engine/basics/printable.hpp"
#include "apps/engine/basics/xml_text.hpp"
#include "halflit/image.hpp"

#include <fmt/format.h>

namespace halflit::engine {
namespace {

constexpr const char* kPageHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{0}: {1}</title>
<style>
body {{ max-width: 66rem; margin: 2rem auto; padding: 0 1rem; font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff }}
h2 {{ margin: 0 0 .25rem; font-size: 1.2rem; overflow-wrap: anywhere }}
p {{ margin: .25rem 0 }}
.pictures {{ display: grid; grid-template-columns: repeat(3, 1fr); gap: .75rem; margin-top: .75rem }}
figure {{ margin: 0; min-width: 0 }}
figcaption {{ font-size: 14px; color: #444 }}
img {{ display: block; width: 100%; height: auto; border: 1px solid #ddd;
  background: repeating-conic-gradient(#ccc 0 25%, #fff 0 50%) 0 0/16px 16px }}
table {{ border-collapse: collapse; font-size: 14px }}
th, td {{ padding: .15rem .75rem .15rem 0; text-align: left; border-bottom: 1px solid #e4e4e4; overflow-wrap: anywhere }}
{2}</style>
</head>
<body>
<h1>{1}</h1>
)";

}  // namespace

std::string page_head(const std::string& program, const std::string& title, const std::string& style) {
    return fmt::format(kPageHead, page_text(program), page_text(title), style);
}

std::string page_text(const std::string& text) { return xml_escaped(printable(text)); }

Result<std::string> embedded_figure(const Image& picture, const std::string& caption) {
    const auto png = encode_image(picture, OutputFormat::png);
    if (!png) return tl::unexpected(png.error());
    return fmt::format("<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
                       page_text(caption), base64(*png));
}

}  // namespace halflit::engine
