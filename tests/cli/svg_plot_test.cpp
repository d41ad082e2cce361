#include "apps/lab/svg_plot.hpp"
#include "apps/lab/rich_text.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>
#include <regex>

using namespace halflit;
using namespace halflit::cli;

namespace {

/// Numbers of an attribute, in the order in which they are drawn.
std::vector<double> attribute(const std::string& svg, const std::string& element, const std::string& name) {
    std::vector<double> values;
    const std::regex form("<" + element + "[^>]* " + name + "=\"([-0-9.]+)\"");
    for (std::sregex_iterator it(svg.begin(), svg.end(), form), end; it != end; ++it) values.push_back(std::stod((*it)[1]));
    return values;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
    return found;
}

Plot scatter(std::vector<Vec2<double>> points) {
    Plot plot;
    plot.series = {{.name = "", .points = std::move(points), .mark = PlotSeries::Mark::dots}};
    return plot;
}

}  // namespace

TEST_CASE("plot: a linear axis keeps differences, a logarithmic one ratios", "[cli][plot]") {
    Plot plot = scatter({{1, 0}, {2, 1}, {3, 4}});
    plot.x = {.min = 0, .max = 4};
    std::vector<double> x = attribute(plot_svg(plot), "circle", "cx"), y = attribute(plot_svg(plot), "circle", "cy");
    REQUIRE(x.size() == 3);
    CHECK(x[1] - x[0] == Approx(x[0]).margin(0.02));  // 0 is the left edge
    CHECK(x[2] - x[1] == Approx(x[0]).margin(0.02));
    CHECK(y[0] - y[2] == Approx(4 * (y[0] - y[1])).margin(0.05));  // y points down

    plot = scatter({{1, 0.01}, {10, 1}, {1000, 100}});
    plot.x.log = plot.y.log = true;
    x = attribute(plot_svg(plot), "circle", "cx"), y = attribute(plot_svg(plot), "circle", "cy");
    REQUIRE(x.size() == 3);
    CHECK(x[0] == Approx(0).margin(0.01));
    CHECK(x[2] == Approx(3 * x[1]).margin(0.03));
    CHECK(y[0] - y[1] == Approx(y[1] - y[2]).margin(0.02));
}

TEST_CASE("plot: a value that is not finite is a gap, 0 leaves a logarithmic axis by its lower edge", "[cli][plot]") {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    Plot plot = scatter({{0, 1}, {1, 2}, {2, kNan}, {3, 1}, {4, 2}});
    plot.series[0].mark = PlotSeries::Mark::line_and_dots;
    const std::string gap = plot_svg(plot);
    CHECK(count(gap, "<circle") == 4);
    CHECK(count(gap, "M0.00") == 1);
    CHECK(std::regex_search(gap, std::regex("<path d=\"M[^M\"]*M[^M\"]*\"")));
    CHECK(count(gap, "nan") == 0);

    plot = scatter({{0, 1}, {1, 0}});
    plot.y = {.min = 0.1, .max = 1, .log = true};
    const std::vector<double> y = attribute(plot_svg(plot), "circle", "cy");
    REQUIRE(y.size() == 2);
    CHECK(y[0] == Approx(0).margin(0.01));
    CHECK(y[1] > plot.height);
}

TEST_CASE("plot: text is escaped, and nothing refers outside or by an id", "[cli][plot]") {
    Plot plot = scatter({{0, 0}, {1, 1}});
    plot.title = "a < b & \"c\"";
    plot.series[0].name = "<script>";
    plot.series[0].labels = {"1 > 0", ""};
    const std::string svg = plot_svg(plot);
    CHECK(count(svg, "a &lt; b &amp; &quot;c&quot;") == 2);  // one is shown, one is for screen readers
    CHECK(count(svg, "<script") == 0);
    CHECK(count(svg, "1 &gt; 0") == 1);
    CHECK(count(svg, " id=") == 0);
    CHECK(count(svg, "href") == 0);
    CHECK(count(svg, "http") == 2);  // the two namespaces
    CHECK(plots_csv(std::vector{plot}) == "plot,series,x,y\n\"a < b & \"\"c\"\"\",<script>,0,0\n\"a < b & \"\"c\"\"\",<script>,1,1\n");
}

TEST_CASE("rich text: raised and lowered parts in SVG, HTML and plain text", "[cli][plot]") {
    CHECK(rich_html("(f \u2212 f_{3})^{2} < 1") == "(f \u2212 f<sub>3</sub>)<sup>2</sup> &lt; 1");
    CHECK(rich_plain("(f \u2212 f_{3})^{2}, x^{1+a}, N\u00b7L") == "(f - f_3)^2, x^(1+a), N.L");
    CHECK(rich_svg("a & b", 10) == "a &amp; b");
    // What follows a raised part returns to the baseline: the shifts add up to 0.
    const std::string svg = rich_svg("x^{2}_{1} y", 10);
    const std::vector<double> shifts = attribute(svg, "tspan", "dy");
    REQUIRE(shifts.size() == 3);
    CHECK(shifts[0] < 0);
    CHECK(shifts[0] + shifts[1] > 0);
    CHECK(shifts[0] + shifts[1] + shifts[2] == Approx(0).margin(1e-9));
    CHECK(count(svg, "</tspan> <tspan") == 1);  // the space is between the elements
    CHECK(rich_plain("an open ^{brace") == "an open ^{brace");
}

TEST_CASE("plot: without data, or with one value, there is still an axis", "[cli][plot]") {
    for (const bool log : {false, true})
        for (const std::vector<Vec2<double>>& points : {std::vector<Vec2<double>>{}, std::vector<Vec2<double>>{{3, 3}}}) {
            Plot plot = scatter(points);
            plot.x.log = plot.y.log = log;
            const std::string svg = plot_svg(plot);
            INFO(svg);
            CHECK(count(svg, "nan") == 0);
            CHECK(count(svg, "inf") == 0);
            CHECK(attribute(svg, "line", "x1").size() > 4);
        }
}
