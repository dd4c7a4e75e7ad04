// Files of triangles as surfaces: STL here, DXF in read_dxf.cpp; then corners that coincide become one.
#include "libgeom/solid/read_surface.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/regular_file.hpp"
#include "libgeom/mesh/sound_surface.hpp"
#include "libgeom/query/welder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>

namespace geom {
namespace {

constexpr std::size_t header = 84,
                      record = 50; // bytes: title and count; a normal, three corners and two more

bool is_polygon_file(const std::string& ending) {
  return ending == ".obj" || ending == ".off" || ending == ".ply" || ending == ".ts";
}

} // namespace

FileTriangles stl_triangles(const std::string& bytes, const std::string& path) {
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
    return {std::move(corners), ""};
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
  return {std::move(corners), ""};
}

FileSurface read_surface(const std::string& path, double scale, std::size_t most, const Vec3& shift) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending != ".stl" && ending != ".dxf" && !is_polygon_file(ending))
    throw InputError("file", '"' + path + '"', "a name that ends in .stl, .dxf, .obj, .off, .ply or .ts");
  if (!std::filesystem::is_regular_file(path)) {
    std::string format = ending.substr(1);
    for (char& c : format)
      c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    throw InputError("file", '"' + path + '"', "an existing " + format + " file");
  }
  require_positive("scale", scale, "");
  require_finite("shift", shift);
  FileTriangles file = is_polygon_file(ending) ? polygon_triangles(path)
                       : ending == ".stl"      ? stl_triangles(read_regular(path), path)
                                               : dxf_triangles(read_regular(path), path);
  std::vector<Vec3>& corners = file.corners;
  if (corners.size() > 3 * most)
    throw InputError("file", '"' + path + '"', "one of at most " + std::to_string(most) + " triangles",
                     "it has " + std::to_string(corners.size() / 3) + "; make it coarser");
  Box box;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = scale * corners[i] + shift;
    if (!corners[i].allFinite())
      throw InputError("file", '"' + path + '"', "one of finite coordinates",
                       "triangle " + std::to_string(i / 3 + 1) + " has a corner at " + text(corners[i]));
    box.extend(corners[i]);
  }
  FileSurface result;
  result.note = std::move(file.note);
  Surface& surface = result.surface;
  // Cells of welding are counted in 64 bits.
  const double size = corners.empty() ? 0 : box.size().norm(),
               reach = corners.empty() ? 0 : box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  if (!(std::isfinite(size) && reach <= 1e9 * size))
    size > 0 ? throw InputError("file", '"' + path + '"',
                                "one whose size is at least 1e-9 of its distance from the origin")
             : void();
  if (size > 0) {
    Welder welder(same_corner * size);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
      const Triangle t{welder.number(corners[i], surface.points),
                       welder.number(corners[i + 1], surface.points),
                       welder.number(corners[i + 2], surface.points)};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) // others have shrunk to an edge
        surface.triangles.push_back(t);
    }
  }
  if (surface.triangles.empty())
    throw InputError("file", '"' + path + '"', "one with triangles",
                     "it has none" + (result.note.empty() ? "" : "; " + result.note));
  result.mended = mended_text(mend(surface, same_corner * size));
  if (surface.triangles.empty())
    throw InputError("file", '"' + path + '"', "one with triangles", "none of its triangles has an area");
  require_single(surface, "file \"" + path + "\"");
  require_uncrossed(surface, "file \"" + path + "\"", same_corner * size);
  return result;
}

} // namespace geom
