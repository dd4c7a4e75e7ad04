#include "libcdem/vtk/colour_map.hpp"
#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libcdem/vtk/layout.hpp"
#include "libcdem/vtk/picture.hpp"
#include "libcdem/vtk/scene.hpp"
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

TEST_CASE("a picture has the asked size and is not blank") {
  const TemporaryFolder folder;
  Snapshot s = sample::plate();
  for (const std::string field :
       {"", "displacement.x", "displacement.magnitude", "stress.yy", "von_mises", "block_id"})
    for (const char* view : {"front", "iso"}) {
      INFO(field << " " << view);
      PictureOptions o;
      o.field = field;
      o.view = view;
      o.title = "a title";
      o.size = {320, 240};
      render(s, o, folder / "p.png");
      const Image image = read_png(folder / "p.png");
      CHECK(image.width == 320);
      CHECK(image.height == 240);
      CHECK(image.ink() > 320 * 240 / 8);
    }
  CHECK(folder.names() == std::vector<std::string>{"p.png"});
}

TEST_CASE("a free height is as high as the body needs") {
  const TemporaryFolder folder;
  PictureOptions o = bare("");
  o.size = {400, 0};
  render(three_blocks(), o, folder / "p.png");
  const Image image = read_png(folder / "p.png");
  const Image::Bounds b = image.bounds();
  CHECK(image.width == 400);
  CHECK(image.height < 200); // the body is three times as wide as high
  CHECK((b.right - b.left) / double(b.top - b.bottom) == Approx(3).epsilon(0.02));
  CHECK(b.right - b.left > 360);
}

TEST_CASE("the same picture twice gives the same pixels") {
  const TemporaryFolder folder;
  PictureOptions o;
  o.field = "displacement.x";
  o.size = {400, 300};
  const Snapshot s = sample::plate();
  render(s, o, folder / "a.png");
  render(three_blocks(), bare("level"), folder / "other.png");
  render(s, o, folder / "b.png");
  CHECK(read_png(folder / "a.png").bytes == read_png(folder / "b.png").bytes);
}

TEST_CASE("broken interfaces are seen from the front of a plate one block thick") {
  const TemporaryFolder folder;
  PictureOptions o = bare("");
  const auto pixels = [&](const Snapshot& s, const Colour& colour) {
    render(s, o, folder / "p.png");
    return read_png(folder / "p.png").count(bytes(colour), 2);
  };
  Snapshot s = three_blocks();
  CHECK(pixels(s, tension_colour) == 0);
  sample::add_interface(s, {1, 0}, {1, 1}, 0.2, BondMode::broken_tension, 2);
  CHECK(pixels(s, tension_colour) > 100); // an upright line over the body's height of 120 pixels
  CHECK(pixels(s, shear_colour) == 0);
  sample::add_interface(s, {2, 0}, {2, 1}, 0.2, BondMode::broken_shear, 1);
  CHECK(pixels(s, shear_colour) > 100);
  o.broken_bonds = false;
  CHECK(pixels(s, tension_colour) == 0);
  o.broken_bonds = true;
  Snapshot whole = three_blocks();
  sample::add_interface(whole, {1, 0}, {1, 1}, 0.2, BondMode::intact, 1);
  sample::add_interface(whole, {2, 0}, {2, 1}, 0.2, BondMode::contact, 1);
  CHECK(pixels(whole, tension_colour) == 0);
  CHECK(pixels(whole, shear_colour) == 0);
}

TEST_CASE("a crack inside a block is hidden by it, and shows through when the block is thin as glass") {
  const TemporaryFolder folder;
  Snapshot s = sample::blocks(sample::grid(1, 1, 1, 1), 1);
  // Half way along x, from x = 0.3 to 0.7 in the plane y = 0.5, not up to the faces of the cube.
  BondSnapshot& bonds = s.bonds;
  bonds.points = {{0.3, 0.5, 0.3}, {0.7, 0.5, 0.3}, {0.7, 0.5, 0.7}, {0.3, 0.5, 0.7}};
  bonds.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto mode = static_cast<double>(static_cast<int>(BondMode::broken_tension));
  bonds.triangle_fields = {{"interface_id", "", 1, {1, 1}, true}, {"mode", "", 1, {mode, mode}, true}};
  bonds.point_fields = {{"mode", "", 1, {mode, mode, mode, mode}, true},
                        {"displacement", "m", 3, std::vector<double>(12, 0.0), false}};
  PictureOptions o = bare("");
  o.view = "top";
  o.up = "y";
  const auto reddish = [&](double opacity) { // pixels whose red is well above their green
    o.opacity = opacity;
    render(s, o, folder / "p.png");
    const Image image = read_png(folder / "p.png");
    int count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        count += image.at(x, y)[0] - image.at(x, y)[1] > 40;
    return count;
  };
  CHECK(reddish(1) == 0);
  CHECK(reddish(0.4) > 500);
  o.opacity = 0;
  CHECK_THROWS_WITH(render(s, o, folder / "p.png"), Contains("opacity = 0: must be in (0, 1]"));
}

TEST_CASE("deformation moves the picture by the scaled displacement") {
  const TemporaryFolder folder;
  Snapshot s = sample::blocks(sample::grid(1, 1, 1, 1), 0.1);
  SnapshotField u{"displacement", "m", 3, {}, false};
  for (const geom::Vec3& x : s.points)
    for (const double v : {1e-3 * x.x(), 0., 0.}) // stretched along x
      u.values.push_back(v);
  s.point_fields.push_back(u);
  PictureOptions o = bare("");
  o.deformation = 1000; // twice as wide as high
  render(s, o, folder / "p.png");
  const Image::Bounds b = read_png(folder / "p.png").bounds();
  CHECK((b.right - b.left) / double(b.top - b.bottom) == Approx(2).epsilon(0.02));
}

TEST_CASE("views look where they say") {
  using geom::Vec3;
  const auto check = [](const char* name, const char* up_axis, const Vec3& toward, const Vec3& right) {
    INFO(name << " " << up_axis);
    const View view = View::named(name, up_axis);
    CHECK((view.toward - toward).norm() < 1e-15);
    CHECK((view.right - right).norm() < 1e-15);
    CHECK((view.up - toward.cross(right)).norm() < 1e-15);
  };
  check("front", "y", {0, 0, 1}, {1, 0, 0});
  check("back", "y", {0, 0, -1}, {-1, 0, 0});
  check("left", "y", {-1, 0, 0}, {0, 0, 1});
  check("right", "y", {1, 0, 0}, {0, 0, -1});
  check("top", "y", {0, 1, 0}, {1, 0, 0});
  check("bottom", "y", {0, -1, 0}, {1, 0, 0});
  check("front", "z", {0, -1, 0}, {1, 0, 0});
  check("left", "z", {-1, 0, 0}, {0, -1, 0});
  check("top", "z", {0, 0, 1}, {1, 0, 0});
  CHECK(View::named("iso", "y").up.y() > 0.5);
  CHECK(View::named("iso", "z").up.z() > 0.5);
}

TEST_CASE("an isometric view looks at the face of a slope, and at a cube as ever") {
  using geom::Vec3;
  const auto same = [](const View& a, const View& b) {
    return (a.toward - b.toward).norm() + (a.right - b.right).norm() + (a.up - b.up).norm() < 1e-12;
  };
  const Snapshot cube = sample::blocks(sample::grid(1, 1, 1, 1), 1);
  for (const char* up : {"y", "z"})
    CHECK(same(View::iso(up, cube.points, cube.surface), View::named("iso", up)));
  // A wedge that rises along +x, then along each other direction: its face looks back, and so does the viewer.
  const std::vector<geom::Triangle> face{{0, 1, 2}, {0, 2, 3}};
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Eigen::AngleAxisd turn(quarter * M_PI / 2, Vec3::UnitZ());
    std::vector<Vec3> points{{0, -1, 0}, {0, 1, 0}, {2, 1, 1}, {2, -1, 1}};
    for (Vec3& x : points)
      x = turn * x;
    std::vector<geom::Triangle> surface;
    for (const auto& t : face) // outward: upwards
      surface.push_back({t[1], t[0], t[2]});
    const View view = View::iso("z", points, surface);
    const Vec3 rise = turn * Vec3::UnitX();
    CHECK(view.toward.dot(rise) < 0);
    CHECK(view.toward.z() > 0);
    CHECK(view.toward.dot(view.right.cross(view.up)) == Approx(1));
  }
}

TEST_CASE("an isometric view looks at the steps of a stepped slope, whose back is as high") {
  using geom::Vec3;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Eigen::AngleAxisd turn(quarter * M_PI / 2, Vec3::UnitZ());
    std::vector<Vec3> points;
    std::vector<geom::Triangle> surface;
    const auto side = [&](const std::array<Vec3, 4>& corners) { // counter-clockwise seen from outside
      const int first = static_cast<int>(points.size());
      for (const Vec3& x : corners)
        points.push_back(turn * x);
      surface.push_back({first, first + 1, first + 2});
      surface.push_back({first, first + 2, first + 3});
    };
    for (int i = 0; i < 5; ++i) { // columns that rise along x
      const double x = i, z = i + 1;
      side({Vec3(x, 0, z), {x + 1, 0, z}, {x + 1, 4, z}, {x, 4, z}});
      side({Vec3(x, 4, 0), {x, 0, 0}, {x, 0, z}, {x, 4, z}});
      side({Vec3(x + 1, 0, 0), {x + 1, 4, 0}, {x + 1, 4, z}, {x + 1, 0, z}});
      side({Vec3(x, 0, 0), {x + 1, 0, 0}, {x + 1, 0, z}, {x, 0, z}});
      side({Vec3(x + 1, 4, 0), {x, 4, 0}, {x, 4, z}, {x + 1, 4, z}});
    }
    const View view = View::iso("z", points, surface);
    CHECK(view.toward.dot(turn * Vec3::UnitX()) < 0);
    CHECK(view.toward.z() > 0);
  }
}

TEST_CASE("a camera of one's own shows a place where the pinhole formula puts it") {
  // A cube of 2 cm about (0.3, 0.2, 0) seen from 2 m: the frame is the picture less 32 / 1600 of its width
  // all round.
  Snapshot s = sample::blocks(sample::grid(0.02, 0.02, 1, 1), 0.02);
  for (geom::Vec3& x : s.points)
    x += geom::Vec3(0.29, 0.19, -0.01);
  const TemporaryFolder folder;
  for (const bool perspective : {true, false}) {
    INFO(perspective);
    PictureOptions o = bare("");
    o.size = {800, 600};
    o.camera = Camera{{0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 30, perspective};
    render(s, o, folder / "p.png");
    const Image::Bounds b = read_png(folder / "p.png").bounds();
    const double frame_height = 600 - 2 * 16;
    const double per_metre = frame_height / (2 * 2 * std::tan(15 * M_PI / 180)); // pixels, at 2 m
    const double near = perspective ? 2 / 1.99 : 1;                              // the front face is nearer
    CHECK(b.left == Approx(400 + 0.29 * per_metre * (perspective ? 2 / 2.01 : 1)).margin(1.5));
    CHECK(b.right + 1 == Approx(400 + 0.31 * per_metre * near).margin(1.5));
    CHECK(b.bottom == Approx(300 + 0.19 * per_metre * (perspective ? 2 / 2.01 : 1)).margin(1.5));
    CHECK(b.top + 1 == Approx(300 + 0.21 * per_metre * near).margin(1.5));
  }
}

TEST_CASE("markers lie where their place is drawn") {
  const TemporaryFolder folder;
  PictureOptions o = bare("");
  o.size = {800, 600};
  const Colour violet = {0.5, 0, 1};
  o.markers.push_back({{3, 1, 0.2}, "", violet, 20}); // the upper right corner
  o.markers.push_back({{1.5, 0.5, 0.2}, "", {0, 0, 1}, 20});
  render(three_blocks(), o, folder / "p.png");
  const Image image = read_png(folder / "p.png");
  const Image::Bounds b = image.bounds();
  CHECK(image.at((b.left + b.right) / 2, (b.bottom + b.top) / 2) == std::array<int, 3>{0, 0, 255});
  CHECK(image.at(b.right - 5, b.top - 5) == bytes(violet));
}

TEST_CASE("title, body, bar, legend and axes never overlap and stay inside the picture") {
  const auto apart = [](const Rect& a, const Rect& b) {
    return a.right() <= b.left || b.right() <= a.left || a.top() <= b.bottom || b.top() <= a.bottom;
  };
  int checked = 0;
  for (const std::array<int, 2>& size :
       {std::array<int, 2>{1600, 1200}, {1600, 0}, {1200, 1600}, {1920, 1080}, {800, 600}})
    for (const double aspect : {0.1, 0.4, 1., 1.5, 4.1, 12.})
      for (int parts = 0; parts < 16; ++parts) {
        LayoutInput in;
        in.size = size;
        in.aspect = aspect;
        in.pixel = std::min(size[0] / 1600., size[1] > 0 ? size[1] / 1200. : 1e9);
        in.title = parts & 1;
        in.bar = parts & 2;
        in.legend_rows = parts & 4 ? 2 : 0;
        in.scale_bar = parts & 1;
        in.bar_column = 260 * in.pixel;
        if (parts & 8)
          in.axes = {130 * in.pixel, 130 * in.pixel};
        const Layout out = arrange(in);
        INFO(size[0] << " x " << size[1] << ", aspect " << aspect << ", parts " << parts);
        const double font = label_font * in.pixel;
        std::vector<Rect> rects = {out.body};
        if (in.bar) {
          Rect r = out.bar; // with its labels and title
          const double below = out.bar_vertical ? 0.4 * font : 20 * in.pixel + font;
          r = out.bar_vertical ? Rect{r.left, r.bottom - below, in.bar_column - 44 * in.pixel,
                                      r.height + below + 1.5 * font}
                               : Rect{r.left, r.bottom - below, r.width, r.height + below + 1.5 * font};
          rects.push_back(r);
        }
        if (in.title)
          rects.push_back({out.body.left, out.title_middle - 0.5 * title_font * in.pixel, out.body.width,
                           title_font * in.pixel});
        if (in.legend_rows > 0)
          rects.push_back({out.legend_left, out.legend_middle - 0.5 * font - legend_row * in.pixel,
                           std::max(0., out.body.right() - out.legend_left), font + legend_row * in.pixel});
        if (parts & 8)
          rects.push_back({out.axes_corner[0], out.axes_corner[1], in.axes[0], in.axes[1]});
        const Rect page{0, 0, double(out.size[0]), double(out.size[1])};
        for (std::size_t i = 0; i < rects.size(); ++i) {
          CHECK(rects[i].left >= 0);
          CHECK(rects[i].bottom >= 0);
          CHECK(rects[i].right() <= page.right());
          CHECK(rects[i].top() <= page.top());
          for (std::size_t j = 0; j < i; ++j) {
            INFO(i << " and " << j);
            CHECK(apart(rects[i], rects[j]));
            ++checked;
          }
        }
      }
  CHECK(checked > 1000);
}

TEST_CASE("options that cannot be used are refused before anything is drawn") {
  const TemporaryFolder folder;
  const Snapshot s = three_blocks();
  const auto refused = [&](PictureOptions o, const std::string& file, const std::string& reason) {
    CHECK_THROWS_AS(render(s, o, folder / file), geom::InputError);
    CHECK_THROWS_WITH(render(s, o, folder / file), Contains(reason) && !Contains("\n"));
  };
  PictureOptions o = bare("");
  CHECK_THROWS_AS(render(s, o, folder / "none/p.png"), FileError);
  refused(o, "p.jpg", "ending in .png");
  o.view = "side";
  refused(o, "p.png", "front, back");
  o = bare("");
  o.up = "x";
  refused(o, "p.png", "up = \"x\"");
  o = bare("");
  o.size = {10, 10};
  refused(o, "p.png", "between 64 and 8000");
  o = bare("");
  o.deformation = 10; // there is no displacement
  refused(o, "p.png", "no displacement");
  o.deformation = std::numeric_limits<double>::quiet_NaN();
  refused(o, "p.png", "deformation");
  o = bare("level");
  o.range = {{1, 0}};
  refused(o, "p.png", "range");
  o = bare("");
  o.camera = Camera{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}};
  refused(o, "p.png", "camera.position");
  o.camera = Camera{{0, 1, 0}, {0, 0, 0}, {0, 1, 0}};
  refused(o, "p.png", "camera.up");
  o = bare("");
  CHECK_THROWS_WITH(render(Snapshot{}, o, folder / "p.png"), Contains("no faces"));
  CHECK(folder.names().empty());
}

TEST_CASE("pictures fitted to one box show the same place at the same pixel, whatever is drawn") {
  const TemporaryFolder folder;
  Snapshot s = three_blocks();
  PictureOptions o = bare("");
  o.fit = geom::Box{{-2, -2, -2}, {6, 6, 2}};
  o.markers = {{{1, 1, 0}, "", {1, 0, 0}, 20}};
  const auto seen_at = [&](const Snapshot& drawn, const char* name) {
    render(drawn, o, folder / name);
    const Image image = read_png(folder / name);
    double x_sum = 0, y_sum = 0, n = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (const auto c = image.at(x, y); c[0] > 200 && c[1] < 60 && c[2] < 60) {
          x_sum += x;
          y_sum += y;
          ++n;
        }
    REQUIRE(n > 10);
    return std::array<double, 2>{x_sum / n, y_sum / n};
  };
  const auto before = seen_at(s, "a.png");
  for (geom::Vec3& x : s.points) // all of it has flown off a little
    x += geom::Vec3(1.5, 2.5, 0);
  CHECK(seen_at(s, "b.png") == before);
  o.fit = geom::Box{{1, 0, 0}, {0, 1, 1}};
  CHECK_THROWS_WITH(render(s, o, folder / "c.png"), Contains("fit.max"));
}

TEST_CASE("lines end at the frame of the body: margin, colour bar and legend stay free") {
  const TemporaryFolder folder;
  PictureOptions o = bare("");
  o.fit = geom::Box{{-2, -2, -2}, {6, 6, 2}};
  for (const geom::Vec3& way : {geom::Vec3(1, 0, 0), geom::Vec3(0, 1, 0), geom::Vec3(1, 1, 0)}) {
    Polyline line;
    line.points = {geom::Vec3(2, 2, 0) - 50 * way, geom::Vec3(2, 2, 0), geom::Vec3(2, 2, 0) + 50 * way};
    line.colour = {1, 0, 0};
    line.width = 10;
    o.polylines = {line};
    render(three_blocks(), o, folder / "a.png");
    const Image image = read_png(folder / "a.png");
    int seen = 0, at_edge = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (const auto c = image.at(x, y); c[0] > 200 && c[1] < 60 && c[2] < 60) {
          ++seen;
          at_edge += x < 5 || y < 5 || x >= image.width - 5 || y >= image.height - 5 ? 1 : 0;
        }
    CHECK(seen > 100);
    CHECK(at_edge == 0);
  }
}

TEST_CASE("edges that their own block hides leave no trace") {
  const TemporaryFolder folder;
  const Snapshot s = sample::blocks(sample::grid(1, 1, 1, 1), 1);
  PictureOptions o = bare("");
  o.edges = true;
  o.view = "iso";
  o.size = {800, 600};
  render(s, o, folder / "all.png");
  Snapshot seen =
      s; // without the three edges at the corner that looks away: it has no face towards the viewer
  const View iso = View::named("iso", "y");
  const auto depth = [&](int p) { return iso.toward.dot(s.points[p]); };
  int farthest = s.block_edges[0][0];
  for (const auto& e : s.block_edges)
    for (const int p : e)
      if (depth(p) < depth(farthest))
        farthest = p;
  seen.block_edges.clear();
  for (const auto& e : s.block_edges)
    if (e[0] != farthest && e[1] != farthest)
      seen.block_edges.push_back(e);
  REQUIRE(seen.block_edges.size() + 3 == s.block_edges.size());
  render(seen, o, folder / "seen.png");
  CHECK(read_png(folder / "all.png").bytes == read_png(folder / "seen.png").bytes);
}
