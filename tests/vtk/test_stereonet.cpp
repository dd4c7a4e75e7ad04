#include "libcdem/vtk/colour_map.hpp"
#include "libcdem/vtk/stereonet.hpp"
#include "libgeom/core/error.hpp"
#include "tests/vtk/image.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace cdem;
using Catch::Matchers::Contains;

namespace {

constexpr double deg = M_PI / 180;
constexpr Colour red = {1, 0, 0}, blue = {0, 0, 1};

// Middle of all pixels of a colour left of the legend.
std::array<double, 3> middle(const Image& image, const Colour& colour, int right) {
  double x = 0, y = 0;
  int count = 0;
  for (int i = 0; i < right; ++i)
    for (int j = 0; j < image.height; ++j) {
      const auto c = image.at(i, j);
      if (c[0] == 255 * colour[0] && c[1] == 255 * colour[1] && c[2] == 255 * colour[2]) {
        x += i;
        y += j;
        ++count;
      }
    }
  return {x / count, y / count, static_cast<double>(count)};
}

} // namespace

TEST_CASE("a stereonet has its poles where they belong, north up and east right") {
  const TemporaryFolder folder;
  StereonetOptions options;
  options.size = {800, 600};
  const auto pole = [&](double dip, double direction) {
    stereonet({{"a", {{dip * deg, direction * deg}}, red}}, {}, options, folder / "net.png");
    const Image image = read_png(folder / "net.png");
    return middle(image, red, 560);
  };
  const auto centre = pole(0, 0), west = pole(90, 90), north = pole(90, 180), inner = pole(60, 225);
  const double radius = centre[0] - west[0];
  CHECK(radius > 180);
  CHECK(west[1] == Approx(centre[1]).margin(1));
  CHECK(north[0] == Approx(centre[0]).margin(1));
  CHECK(north[1] - centre[1] == Approx(radius).margin(1.5));
  CHECK(inner[0] - centre[0] == Approx(0.5 * radius).margin(1.5));
  CHECK(inner[1] - centre[1] == Approx(0.5 * radius).margin(1.5));
  CHECK(centre[2] > 20);
}

TEST_CASE("a great circle bulges towards the dip") {
  const TemporaryFolder folder;
  StereonetOptions options;
  options.size = {800, 600};
  options.title = "a face";
  stereonet({{"centre", {{0, 0}}, red}}, {{"face", {45 * deg, 90 * deg}, false, blue}}, options,
            folder / "net.png");
  const Image image = read_png(folder / "net.png");
  const auto centre = middle(image, red, 560), face = middle(image, blue, 560);
  CHECK(face[0] > centre[0] + 20);
  CHECK(face[1] == Approx(centre[1]).margin(2));
  CHECK(face[2] > 500);
}

TEST_CASE("two dozen lines or sets have colours of their own") {
  for (std::size_t i = 0; i < 24; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Colour a = palette_colour(i), b = palette_colour(j);
      CHECK(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) > 0.1);
    }
}

TEST_CASE("a plane of the name of a set shares its colour and its row of the legend, another does not") {
  const TemporaryFolder folder;
  StereonetOptions options;
  options.size = {800, 600};
  const auto rows = [&](const StereonetPlane& plane, const Colour& colour) { // of the legend, in this colour
    stereonet({{"J1", {{0, 0}}, red}}, {plane}, options, folder / "net.png");
    const Image image = read_png(folder / "net.png");
    int count = 0;
    bool before = false;
    for (int j = 0; j < image.height; ++j) {
      bool here = false;
      for (int i = 560; i < image.width; ++i) {
        const auto c = image.at(i, j);
        bool same = true;
        for (std::size_t k = 0; k < 3; ++k)
          same = same && c[k] == static_cast<int>(std::lround(255 * colour[k]));
        here = here || same;
      }
      count += here && !before ? 1 : 0;
      before = here;
    }
    return count;
  };
  const geom::Orientation plane{30 * deg, 7 * deg};
  CHECK(rows({"J1", plane}, red) == 1);
  CHECK(rows({"J1", plane}, palette_colour(1)) == 0);
  CHECK(rows({"J1", plane, false, blue}, blue) == 1); // a colour of its own: a row of its own
  CHECK(rows({"face", plane}, red) == 1);
  CHECK(rows({"face", plane}, palette_colour(1)) == 1);
  CHECK(rows({"face", plane, false, red}, red) == 2);
}

TEST_CASE("a stereonet without anything in it, or in an odd file, is refused") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(stereonet({}, {}, {}, folder / "net.png"), Contains("poles or planes"));
  CHECK_THROWS_WITH(stereonet({{"a", {{0, 0}}, red}}, {}, {}, folder / "net.bmp"), Contains(".png"));
}
