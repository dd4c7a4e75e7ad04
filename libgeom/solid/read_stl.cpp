#include "libgeom/solid/read_stl.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace geom {
namespace {

constexpr std::size_t header = 84,
                      record = 50; // bytes: title and count; a normal, three corners and two more

// Three corners for each triangle, in a row.
std::vector<Vec3> corners_of(const std::string& bytes, const std::string& path) {
  std::vector<Vec3> corners;
  std::uint32_t count = 0;
  if (bytes.size() >= header)
    std::memcpy(&count, bytes.data() + 80, sizeof count);
  if (bytes.size() >= header && bytes.size() == header + record * count) {
    for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(count); ++i) {
      float x[3];
      std::memcpy(x, bytes.data() + header + record * (i / 3) + 12 + 12 * (i % 3), sizeof x);
      corners.emplace_back(x[0], x[1], x[2]);
    }
    return corners;
  }
  if (bytes.compare(0, 5, "solid") != 0)
    throw InputError("file", '"' + path + '"', "an STL file", "it is neither a text nor a whole binary one");
  std::istringstream words(bytes);
  std::string word;
  while (words >> word) {
    if (word != "vertex")
      continue;
    Vec3 x;
    for (int i = 0; i < 3; ++i) { // strtod, unlike >>, reads "nan"
      words >> word;
      x[i] = words ? std::strtod(word.c_str(), nullptr) : std::nan("");
    }
    corners.push_back(x);
  }
  if (corners.size() % 3 != 0)
    throw InputError("file", '"' + path + '"', "a whole STL file", "its last triangle lacks a corner");
  return corners;
}

// Gives corners nearer than the tolerance one number, in the order they are met.
class Welder {
public:
  explicit Welder(double tolerance) : tolerance_(tolerance) {}

  int number(const Vec3& x, std::vector<Vec3>& vertices) {
    const Cell home = cell(x);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k) {
          const auto at = cells_.find({home[0] + i, home[1] + j, home[2] + k});
          if (at == cells_.end())
            continue;
          for (const int v : at->second)
            if ((vertices[v] - x).norm() <= tolerance_)
              return v;
        }
    vertices.push_back(x);
    const int added = static_cast<int>(vertices.size()) - 1;
    cells_[home].push_back(added);
    return added;
  }

private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell(const Vec3& x) const {
    return {static_cast<std::int64_t>(std::floor(x[0] / tolerance_)),
            static_cast<std::int64_t>(std::floor(x[1] / tolerance_)),
            static_cast<std::int64_t>(std::floor(x[2] / tolerance_))};
  }
  double tolerance_;
  std::map<Cell, std::vector<int>> cells_;
};

// One closed, orientable surface: each edge is run through once each way, and all triangles hang together.
void require_closed(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                    const std::string& path) {
  std::map<std::array<int, 2>, int> owner; // triangle by directed edge
  const auto near = [&](int a, int b) { return " near " + text(Vec3(0.5 * (vertices[a] + vertices[b]))); };
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      if (!owner.emplace(std::array<int, 2>{a, b}, static_cast<int>(t)).second)
        throw InputError("file", '"' + path + '"', "one closed surface",
                         "triangles overlap or point different ways" + near(a, b));
    }
  std::size_t open = 0;
  std::array<int, 2> first{};
  for (const auto& [edge, triangle] : owner)
    if (owner.count({edge[1], edge[0]}) == 0 && open++ == 0)
      first = edge;
  if (open > 0)
    throw InputError("file", '"' + path + '"', "one closed surface",
                     "it is open: " + std::to_string(open) +
                         (open == 1 ? " edge belongs to one triangle only,"
                                    : " edges belong to one triangle only, the first") +
                         near(first[0], first[1]));
  std::vector<char> reached(triangles.size(), 0);
  std::vector<int> stack{0};
  reached[0] = 1;
  std::size_t together = 1;
  while (!stack.empty()) {
    const Triangle t = triangles[stack.back()];
    stack.pop_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const int other = owner.at({t[(i + 1) % 3], t[i]});
      if (!reached[other]) {
        reached[other] = 1;
        ++together;
        stack.push_back(other);
      }
    }
  }
  if (together != triangles.size())
    throw InputError("file", '"' + path + '"', "one closed surface",
                     "it holds several; save each as a file of its own");
}

} // namespace

FacetedSurface read_stl(const std::string& path, double scale) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError("file", '"' + path + '"', "an existing STL file");
  require_positive("scale", scale, "");
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  std::vector<Vec3> corners = corners_of(bytes.str(), path);
  if (corners.size() > 3 * max_stl_triangles)
    throw InputError("file", '"' + path + '"',
                     "an STL of at most " + std::to_string(max_stl_triangles) + " triangles",
                     "it has " + std::to_string(corners.size() / 3) + "; make it coarser");
  Box box;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] *= scale;
    if (!corners[i].allFinite())
      throw InputError("file", '"' + path + '"', "an STL of finite coordinates",
                       "triangle " + std::to_string(i / 3 + 1) + " has a corner at " + text(corners[i]));
    box.extend(corners[i]);
  }
  FacetedSurface surface;
  std::vector<Triangle> triangles;
  if (!corners.empty() && box.size().norm() > 0) {
    Welder welder(1e-6 * box.size().norm());
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
      const Triangle t{welder.number(corners[i], surface.vertices),
                       welder.number(corners[i + 1], surface.vertices),
                       welder.number(corners[i + 2], surface.vertices)};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) // others have shrunk to an edge
        triangles.push_back(t);
    }
  }
  if (triangles.size() < 4)
    throw InputError("file", '"' + path + '"', "one closed surface",
                     "it has " + std::to_string(triangles.size()) +
                         (triangles.size() == 1 ? " triangle" : " triangles"));
  require_closed(surface.vertices, triangles, path);
  double volume = 0;
  for (const Triangle& t : triangles)
    volume += (surface.vertices[t[0]] - box.min)
                  .dot((surface.vertices[t[1]] - box.min).cross(surface.vertices[t[2]] - box.min)) /
              6;
  for (const Triangle& t : triangles)
    surface.faces.push_back(
        {volume > 0 ? std::vector<int>{t[0], t[1], t[2]} : std::vector<int>{t[0], t[2], t[1]}});
  return surface;
}

} // namespace geom
