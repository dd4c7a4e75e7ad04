// Colours of pictures, and the fields behind them.
#include "libcdem/vtk/colour_map.hpp"
#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libcdem/vtk/layout.hpp"
#include "libcdem/vtk/picture.hpp"
#include "libcdem/vtk/scene.hpp"
#include "libcdem/vtk/section.hpp"
#include "libgeom/core/error.hpp"
#include "tests/support/refusal.hpp"
#include "tests/vtk/bare_picture.hpp"
#include "tests/vtk/image.hpp"
#include "tests/vtk/sample.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>

using namespace cdem;
using namespace testing;
using Catch::Matchers::Contains;

TEST_CASE("cell values take the colours of the given range") {
  const TemporaryFolder folder;
  PictureOptions o = bare("level"); // 0, 1, 2
  o.range = {{0, 2}};
  render(three_blocks(), o, folder / "p.png");
  Image image = read_png(folder / "p.png");
  CHECK(std::abs(grey_at(image, 0.5 / 3) - 40) <= 1);
  CHECK(std::abs(grey_at(image, 1.5 / 3) - (40 + 245) / 2) <= 1);
  CHECK(std::abs(grey_at(image, 2.5 / 3) - 245) <= 1);
  o.range = {{0, 1}}; // 2 lies beyond and takes the last colour
  render(three_blocks(), o, folder / "p.png");
  image = read_png(folder / "p.png");
  CHECK(std::abs(grey_at(image, 1.5 / 3) - 245) <= 1);
  CHECK(std::abs(grey_at(image, 2.5 / 3) - 245) <= 1);
}

TEST_CASE("units have colours of their own, and the only block of a body is grey") {
  Snapshot s = three_blocks();
  SnapshotField unit{"unit", "", 1, {}, true};
  for (const double id : s.cell_fields[0].values)
    unit.values.push_back(id - 1); // 0: the ground
  s.cell_fields.push_back(unit);
  const FieldValues values = field_values(s, "unit");
  CHECK(values.id);
  const ColourScale scale = colour_scale(values.values, values.id, "auto", {});
  CHECK(scale.map == "categorical");
  for (std::size_t t = 0; t < s.surface.size(); ++t) {
    const Colour colour = scale(values.values[t]);
    const double number = unit.values[static_cast<std::size_t>(s.surface_tet[t])];
    const bool grey = colour[0] == colour[1] && colour[1] == colour[2];
    CHECK(grey == (number == 0));
    if (number > 0)
      CHECK(colour == id_colour(std::llround(number)));
  }
}

TEST_CASE("point values are interpolated along a face") {
  const TemporaryFolder folder;
  PictureOptions o = bare("rise"); // 0 to 3
  o.range = {{0, 3}};
  render(three_blocks(), o, folder / "p.png");
  const Image image = read_png(folder / "p.png");
  for (const double along : {0.1, 0.25, 0.5, 0.8}) {
    INFO(along);
    CHECK(std::abs(grey_at(image, along) - (40 + along * 205)) <= 2);
  }
}

TEST_CASE("a few far values do not take the colours of the others") {
  std::vector<double> values(1000);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<double>(i);
  values[3] = 1e6;
  const ColourScale scale = colour_scale(values, false, "auto", {});
  CHECK(scale.low >= 0);
  CHECK(scale.high <= 1000);
  CHECK(scale.high - scale.low >= 0.98 * 999);
  REQUIRE(scale.all); // they are told
  CHECK((*scale.all)[0] == 0);
  CHECK((*scale.all)[1] == 1e6);
  // A tail that belongs to the others, a range that is given and a handful of values keep all.
  values[3] = 2000;
  CHECK(colour_scale(values, false, "auto", {}).high == 2000);
  CHECK_FALSE(colour_scale(values, false, "auto", {}).all);
  values[3] = 1e6;
  CHECK(colour_scale(values, false, "auto", {{0, 1e6}}).high == 1e6);
  CHECK(colour_scale({0, 1, 2, 1e6}, false, "auto", {}).high == 1e6);
}

TEST_CASE("a legend has as many rows as keep it within the picture, and loses no word") {
  const TemporaryFolder folder;
  Snapshot s = three_blocks();
  PictureOptions o;
  o.edges = o.axes = false;
  o.size = {800, 0};
  const auto height = [&] {
    render(s, o, folder / "p.png");
    const Image image = read_png(folder / "p.png");
    const Image::Bounds b = image.bounds();
    CHECK(b.left > 0);
    CHECK(b.right < image.width - 1);
    return image.height;
  };
  const auto add = [&](const std::string& label) { o.polylines.push_back({{{0, 0, 0}, {3, 1, 0}}, label}); };
  add("one line");
  const int one = height();
  add("another line with a name of many words that tells what it is and where it is from");
  const int two = height();
  CHECK(two > one);
  add("and a third one, whose name alone is longer than the picture is wide, so that it is wrapped at a "
      "blank between words");
  CHECK(height() >= two + 2 * (two - one) - 4);
}

TEST_CASE("an unknown field names the nearest right ones") {
  const TemporaryFolder folder;
  const Snapshot s = sample::plate();
  const auto message = [&](const std::string& field) {
    PictureOptions o;
    o.field = field;
    return testing::refusal([&] { render(s, o, folder / "p.png"); });
  };
  CHECK_THAT(message("displacment.x"),
             Contains("colour = \"displacment.x\"") && Contains("did you mean displacement.x"));
  CHECK_THAT(message("stress"), Contains("stress.xx"));
  CHECK_THAT(message("stress.x"), Contains("stress.xx"));
  CHECK_THAT(message("block_id.x"), Contains("block_id"));
  CHECK_THAT(message("temperature"),
             Contains("one of") && Contains("displacement.magnitude") && Contains("von_mises"));
  CHECK(folder.names().empty());
}

TEST_CASE("von Mises stress comes from the stress when the result has none of its own") {
  // Uniaxial stress s has von Mises stress |s|; a hydrostatic one has none; pure shear t has sqrt(3) t.
  Snapshot s = three_blocks();
  SnapshotField stress{"stress", "Pa", 6, {}, false};
  for (const double id : s.cell_fields[0].values)
    for (int c = 0; c < 6; ++c)
      stress.values.push_back(id == 1 ? (c == 1 ? -5 : 0) : id == 2 ? (c < 3 ? 7 : 0) : (c == 4 ? 2 : 0));
  s.cell_fields.push_back(stress);
  const FieldValues v = field_values(s, "von_mises");
  CHECK(v.unit == "Pa");
  for (std::size_t i = 0; i < s.surface.size(); ++i) {
    const double id = s.cell_fields[0].values[static_cast<std::size_t>(s.surface_tet[i])];
    CHECK(v.values[i] == Approx(id == 1 ? 5. : id == 2 ? 0. : 2 * std::sqrt(3.)).margin(1e-14));
  }
}

TEST_CASE("colours of numbers are those of the colour bar, at most a fifth darker where a face looks aside") {
  const TemporaryFolder folder;
  Snapshot s = three_blocks();
  for (double& level : s.cell_fields.back().values)
    level = 1;
  PictureOptions o = bare("level");
  o.range = {{0, 2}};
  o.view = GENERATE("iso", "front", "top");
  render(s, o, folder / "p.png");
  const Image image = read_png(folder / "p.png");
  const int middle = (40 + 245) / 2;
  std::map<int, int> greys; // how many pixels of each
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      ++greys[image.at(x, y)[0]];
  int inside = 0, other = 0, faces = 0;
  for (const auto& [grey, count] : greys) {
    inside += grey >= 0.8 * middle - 1 && grey <= middle + 1 ? count : 0;
    other += grey < 0.8 * middle - 1 || grey > 1.03 * middle ? (grey < middle ? count : 0)
                                                             : 0; // the rim is mixed with white
    faces += count > 1000 && grey < 250 ? 1 : 0;
  }
  CHECK(inside > 5000);
  CHECK(other == 0);
  CHECK(faces == (o.view == "iso" ? 3 : 1)); // each side of a block is told from the others
}

TEST_CASE("joints that are square to the picture are lines in the colour of their value") {
  Snapshot all = sample::blocks(sample::grid(2, 1, 2, 1), 0.2);
  sample::add_interface(all, {1, 0}, {1, 1}, 0.2, BondMode::broken_shear, 4);
  all.bonds.triangle_fields.push_back(
      {"slip", "m", 1, std::vector<double>(all.bonds.triangles.size(), 1), false});
  all.outline = all.block_edges;
  const Snapshot joints = joints_of(all);
  PictureOptions options = bare("slip");
  options.size = {1600, 1200};
  options.colour_map = "blue_white_red";
  options.range = {-1, 1};
  options.broken_bonds = false;
  const TemporaryFolder folder;
  const std::string file = folder / "joints.png";
  render(joints, options, file);
  const Image image = read_png(file);
  // From the bottom of the body to its top, at least two pixels wide.
  CHECK(image.count(bytes(map_colour("blue_white_red", 1)), 2) >
        2 * (image.bounds().top - image.bounds().bottom - 4));
}
