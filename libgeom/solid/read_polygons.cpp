// OBJ, OFF, PLY and GOCAD files as triangles, by CGAL in a child process: its readers trust the counts of a file.
#include "libgeom/child/bytes.hpp"
#include "libgeom/child/process.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/solid/read_surface.hpp"

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Simple_cartesian.h>

namespace geom {

FileTriangles polygon_triangles(const std::string& path) {
  const std::string bytes = run_in_child("reading " + path, limits_of_file(path), [&] {
    using Point = CGAL::Simple_cartesian<double>::Point_3;
    std::vector<Point> points;
    std::vector<std::vector<std::size_t>> polygons;
    if (!CGAL::IO::read_polygon_soup(path, points, polygons))
      throw InputError("file", '"' + path + '"', "a whole OBJ, OFF, PLY or GOCAD file",
                       "it is damaged, or not what its name says");
    std::vector<Vec3> corners;
    for (const auto& polygon : polygons)
      for (std::size_t i = 2; i < polygon.size(); ++i)
        for (const std::size_t corner : {polygon[0], polygon[i - 1], polygon[i]}) {
          if (corner >= points.size())
            throw InputError("file", '"' + path + '"', "a whole file",
                             "a face names corner " + std::to_string(corner + 1) + " of " +
                                 std::to_string(points.size()));
          const Point& x = points[corner];
          corners.emplace_back(x.x(), x.y(), x.z());
        }
    std::string out;
    pack(out, corners);
    return out;
  });
  FileTriangles file;
  Unpacker in(bytes);
  unpack(in, file.corners);
  in.end();
  return file;
}

} // namespace geom
