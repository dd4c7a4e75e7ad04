#include "libcdem/vtk/chart.hpp"
#include "libcdem/vtk/colour_map.hpp"
#include "libcdem/vtk/film.hpp"
#include "libgeom/core/error.hpp"
#include "tests/vtk/image.hpp"
#include "tests/vtk/sample.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>
#include <limits>

using namespace cdem;
using Catch::Matchers::Contains;

namespace {

std::array<int, 3> line_colour(std::size_t i) {
  const Colour c = palette_colour(i);
  return {static_cast<int>(std::lround(255 * c[0])), static_cast<int>(std::lround(255 * c[1])),
          static_cast<int>(std::lround(255 * c[2]))};
}

} // namespace

TEST_CASE("a chart has the asked size and shows every series on both axes") {
  const TemporaryFolder folder;
  std::vector<double> step, force, broken;
  for (int i = 0; i <= 1000; ++i) {
    step.push_back(10. * i);
    force.push_back(std::pow(10., -i / 200.));
    broken.push_back(i < 500 ? 0 : 0.2 * (i - 500));
  }
  ChartOptions o;
  o.title = "relaxation";
  o.x_label = "step";
  o.y_label = "unbalanced force";
  o.right_label = "broken bonds";
  o.log_y = true;
  o.size = {640, 480};
  for (const char* legend : {"auto", "top_left", "top_right", "bottom_left", "bottom_right", "none"}) {
    INFO(legend);
    o.legend = legend;
    chart({{"unbalanced force", step, force}, {"broken bonds", step, broken, true}}, o, folder / "c.png");
    const Image image = read_png(folder / "c.png");
    CHECK(image.width == 640);
    CHECK(image.height == 480);
    CHECK(image.count(line_colour(0), 3) > 100);
    CHECK(image.count(line_colour(1), 3) > 100);
  }
  CHECK(folder.names() == std::vector<std::string>{"c.png"});
}

TEST_CASE("a straight line in a chart is straight, on a linear and on a log axis") {
  // y = x on linear axes and y = 10^x on a log axis cover the same pixels: the diagonal of the plot.
  const TemporaryFolder folder;
  const std::vector<double> x = {0, 1, 2, 3}, power = {1, 10, 100, 1000};
  ChartOptions o;
  o.size = {640, 480};
  o.legend = "none";
  const auto diagonal = [&](const std::vector<double>& y) {
    chart({{"", x, y}}, o, folder / "c.png");
    const Image image = read_png(folder / "c.png");
    // First and last pixel of the line's colour, and how far the middle of each row is from the line between
    // them.
    std::vector<std::array<double, 2>> middles;
    for (int row = 0; row < image.height; ++row) {
      double sum = 0;
      int count = 0;
      for (int column = 0; column < image.width; ++column)
        if (image.at(column, row) == line_colour(0)) {
          sum += column;
          ++count;
        }
      if (count > 0)
        middles.push_back({sum / count, double(row)});
    }
    REQUIRE(middles.size() > 200);
    const auto a = middles[3], b = middles[middles.size() - 4]; // less the cut ends
    double worst = 0;
    for (std::size_t i = 3; i + 3 < middles.size(); ++i)
      worst = std::max(
          worst, std::abs(middles[i][0] - a[0] - (b[0] - a[0]) * (middles[i][1] - a[1]) / (b[1] - a[1])));
    return worst;
  };
  o.y_range = {{0, 3}};
  CHECK(diagonal(x) < 1.5);
  o.y_range = {{1, 1000}};
  o.log_y = true;
  CHECK(diagonal(power) < 1.5);
  o.log_y = false;
  o.y_range = {{0, 1000}};
  CHECK(diagonal(power) > 20); // and the same numbers on a linear axis are far from straight
}

TEST_CASE("numbers that cannot be shown leave a gap and nothing else") {
  const TemporaryFolder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ChartOptions o;
  o.size = {640, 480};
  o.log_y = true;
  chart({{"a", {0, 1, 2, 3, 4}, {1, nan, 0, 10, 100}}, {"none at all", {0, 1}, {0, -1}, true}}, o,
        folder / "c.png");
  CHECK(read_png(folder / "c.png").count(line_colour(0), 3) > 50);
}

TEST_CASE("series and options of a chart that cannot be used are refused") {
  const TemporaryFolder folder;
  ChartOptions o;
  const std::string file = folder / "c.png";
  CHECK_THROWS_WITH(chart({}, o, file), Contains("series = none"));
  CHECK_THROWS_WITH(chart({{"a", {1, 2}, {1}}}, o, file), Contains("series \"a\" = 2 x and 1 y"));
  CHECK_THROWS_WITH(chart({{"a", {1}, {1}, false, "dots"}}, o, file), Contains("style = \"dots\""));
  CHECK_THROWS_WITH(chart({{"a", {1}, {1}}}, o, folder / "none/c.png"), Contains("there is no folder"));
  o.legend = "left";
  CHECK_THROWS_WITH(chart({{"a", {1}, {1}}}, o, file), Contains("legend = \"left\""));
  o.legend = "auto";
  o.log_x = true;
  o.x_range = {{0, 1}};
  CHECK_THROWS_WITH(chart({{"a", {1}, {1}}}, o, file), Contains("x_range") && Contains("> 0"));
  CHECK(folder.names().empty());
}

TEST_CASE("pictures become a film") {
  const TemporaryFolder folder;
  PictureOptions o;
  o.size = {320, 240};
  const Snapshot s = sample::plate();
  std::vector<std::string> frames;
  for (const double scale : {0., 20., 40.}) {
    o.deformation = scale;
    frames.push_back(folder / ("f" + std::to_string(frames.size()) + ".png"));
    render(s, o, frames.back());
  }
  write_film(frames, 10, folder / "film.ogv");
  std::ifstream in(folder / "film.ogv", std::ios::binary);
  std::string head(4, ' ');
  in.read(head.data(), 4);
  CHECK(head == "OggS"); // every Ogg page starts so

  CHECK_THROWS_WITH(write_film({}, 10, folder / "none.ogv"), Contains("at least one"));
  CHECK_THROWS_WITH(write_film({folder / "missing.png"}, 10, folder / "none.ogv"), Contains("missing.png"));
  CHECK_THROWS_WITH(write_film(frames, 0, folder / "none.ogv"), Contains("frames_per_second"));
  o.size = {400, 300};
  render(s, o, folder / "large.png");
  frames.push_back(folder / "large.png");
  CHECK_THROWS_WITH(write_film(frames, 10, folder / "none.ogv"), Contains("320 x 240"));
  CHECK_FALSE(std::ifstream(folder / "none.ogv").good());
}
