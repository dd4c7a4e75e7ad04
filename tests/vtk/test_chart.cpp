#include "libcdem/vtk/chart.hpp"
#include "libcdem/vtk/colour_map.hpp"
#include "libcdem/vtk/film.hpp"
#include "libgeom/core/error.hpp"
#include "tests/vtk/image.hpp"
#include "tests/vtk/sample.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
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

// Bytes of this process that no file holds.
double anonymous_memory() {
  std::ifstream status("/proc/self/status");
  double kilobytes = 0;
  for (std::string word; status >> word;)
    if (word == "RssAnon:" && status >> kilobytes)
      break;
  return 1024 * kilobytes;
}

} // namespace

TEST_CASE("a chart gives its frame buffers back, and the next one has the same bytes") {
  const TemporaryFolder folder;
  ChartOptions o;
  o.size = {1600, 1200};
  const auto draw = [&] {
    chart({{"", {0, 1, 2}, {0, 1, 0.5}}}, o, folder / "c.png");
    return read_png(folder / "c.png").bytes;
  };
  const double before = anonymous_memory();
  const auto first = draw();
  CHECK(anonymous_memory() - before < 150e6); // the frame buffers alone take 480 MB
  CHECK(draw() == first);
}

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

TEST_CASE("marks of a chart are upright lines at their places, with their names") {
  const TemporaryFolder folder;
  ChartOptions o;
  const auto drawn = [&](const std::vector<ChartMark>& marks) {
    o.marks = marks;
    chart({{"", {0, 1, 2}, {0, 0.5, 0}}}, o, folder / "c.png");
    return read_png(folder / "c.png");
  };
  const std::array<int, 3> grey = {115, 115, 115};
  const auto upright = [&](const Image& image) { // columns of the picture with a line
    std::vector<int> columns;
    for (int x = 0; x < image.width; ++x) {
      int along = 0;
      for (int y = 0; y < image.height; ++y)
        along += std::abs(image.at(x, y)[0] - grey[0]) < 40 && image.at(x, y)[0] == image.at(x, y)[2] ? 1 : 0;
      if (along > image.height / 2)
        columns.push_back(x);
    }
    return columns;
  };
  const std::size_t frame = upright(drawn({})).size();
  CHECK(upright(drawn({{0.5, "1 relax"}})).size() > frame);
  CHECK(upright(drawn({{7, "outside"}})).size() == frame);
  // Two that stand together share the place of one, and their names a line.
  CHECK(drawn({{0.5, "1 relax, 2 run"}}).bytes == drawn({{0.5, "1 relax"}, {0.5, "2 run"}}).bytes);
  CHECK(drawn({{0.5, "1 relax"}}).bytes != drawn({{0.5, "2 run"}}).bytes);
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

TEST_CASE(
    "charts and pictures are vector graphics in .svg and .pdf, with the size that they are printed in") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& file) {
    std::ifstream in(folder / file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  };
  ChartOptions o;
  o.size = {600, 450};
  o.title = "\u03c3_{yy} \u2212 a chart";
  o.x_label = "time (s)";
  o.dpi = 150;
  const std::vector<Series> line{{"a", {0, 1, 2}, {0, 1, 4}}};
  chart(line, o, folder / "c.svg");
  chart(line, o, folder / "c.pdf");
  chart(line, o, folder / "c.png");
  const std::string svg = read("c.svg");
  CHECK_THAT(svg, Contains("width=\"101.6mm\" height=\"76.2mm\" viewBox=\"0 0 600 450\""));
  CHECK_THAT(svg, Contains("<polygon") && Contains("<path") && !Contains("<image") && Contains("</svg>"));
  CHECK_THAT(read("c.pdf").substr(0, 5), Contains("%PDF-"));
  CHECK_THAT(read("c.pdf"), Contains("MediaBox [ 0 0 288 216 ]") && !Contains("/Subtype /Image"));
  // pHYs: pixels in a metre, twice, and the unit.
  CHECK_THAT(read("c.png"), Contains(std::string("pHYs\0\0\x17\x12\0\0\x17\x12\1", 13)));
  CHECK_THROWS_WITH(chart(line, o, folder / "c.jpg"), Contains(".png, .svg or .pdf"));
  o.dpi = 5;
  CHECK_THROWS_WITH(chart(line, o, folder / "c.svg"), Contains("dpi"));

  PictureOptions p;
  p.size = {320, 240};
  p.title = "a picture";
  render(sample::plate(), p, folder / "p.svg");
  render(sample::plate(), p, folder / "p.pdf");
  CHECK_THAT(read("p.svg"),
             Contains("<image") && Contains("data:image/png;base64,iVBOR") && Contains("<path"));
  CHECK_THAT(read("p.pdf"), Contains("/Subtype /Image"));
}

TEST_CASE("a vector page draws what the picture of it shows") {
  if (std::system("command -v pdftoppm rsvg-convert >/dev/null 2>&1") != 0) {
    WARN("poppler-utils or librsvg2-bin is missing: the pages are not compared");
    return;
  }
  const TemporaryFolder folder;
  ChartOptions o;
  o.size = {1600, 1200};
  o.dpi = 72;
  o.title = "\u03c3_{yy} \u2212 a chart";
  o.y_label = "turned (Pa)";
  const std::vector<Series> line{{"a", {0, 1, 2}, {0, 1, 4}, false, "both"}};
  for (const char* file : {"c.png", "c.svg", "c.pdf"})
    chart(line, o, folder / file);
  const std::string commands =
      "cd '" + (folder / "") +
      "' && pdftoppm -r 72 -png -singlefile c.pdf pdf && rsvg-convert -w 1600 -h 1200 c.svg -o "
      "svg.png";
  REQUIRE(std::system(commands.c_str()) == 0);
  const Image truth = read_png(folder / "c.png");
  for (const char* file : {"pdf.png", "svg.png"}) {
    INFO(file);
    const Image drawn = read_png(folder / file);
    REQUIRE(drawn.width == truth.width);
    REQUIRE(drawn.height == truth.height);
    double apart = 0, blank = 0; // mean over all pixels, of 255; of an empty page
    for (int y = 0; y < truth.height; ++y)
      for (int x = 0; x < truth.width; ++x)
        for (int c = 0; c < 3; ++c) {
          apart += std::abs(static_cast<double>(truth.at(x, y)[c]) - drawn.at(x, y)[c]);
          blank += 255 - truth.at(x, y)[c];
        }
    CHECK(apart < 0.2 * blank); // edges fall half a pixel off; 0.08 and 0.11 where all is right
  }
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
  // What players are told: ffprobe is the judge.
  const auto probed = [&](const std::string& file) {
    const std::string said = folder / "said";
    const std::string command = "ffprobe -v error -count_frames -select_streams v -show_entries "
                                "stream=codec_name,width,height,r_frame_rate,nb_read_frames -of csv=p=0 '" +
                                (folder / file) + "' >'" + said + "' 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
    std::ifstream answer(said);
    std::string line;
    std::getline(answer, line);
    std::remove(said.c_str());
    return line;
  };
  if (std::system("command -v ffprobe ffmpeg >/dev/null 2>&1") == 0) {
    CHECK(probed("film.ogv") == "theora,320,240,10/1,3");
    write_film(frames, 10, folder / "film.mp4");
    CHECK(probed("film.mp4") == "h264,320,240,10/1,3");
  } else {
    WARN("ffmpeg is not installed: films are not tried");
    CHECK_THROWS_WITH(write_film(frames, 10, folder / "film.mp4"), Contains("ffmpeg"));
  }
  CHECK_THROWS_WITH(write_film(frames, 10, folder / "film.avi"), Contains(".ogv"));

  CHECK_THROWS_WITH(write_film({}, 10, folder / "none.ogv"), Contains("at least one"));
  CHECK_THROWS_WITH(write_film({folder / "missing.png"}, 10, folder / "none.ogv"), Contains("missing.png"));
  CHECK_THROWS_WITH(write_film(frames, 0, folder / "none.ogv"), Contains("frames_per_second"));
  o.size = {400, 300};
  render(s, o, folder / "large.png");
  frames.push_back(folder / "large.png");
  CHECK_THROWS_WITH(write_film(frames, 10, folder / "none.ogv"), Contains("320 x 240"));
  CHECK_FALSE(std::ifstream(folder / "none.ogv").good());
}
