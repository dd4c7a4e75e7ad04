// The flat faces of convex blocks, for the area in which two of them cover each other (geometry/face_cover.hpp).
#pragma once

#include "libcdem/model/contact_surface.hpp"

#include <limits>

namespace cdem {

struct FlatFace {
  std::vector<int> outline;   // nodes, counter-clockwise seen from outside
  std::vector<int> triangles; // of the surface
  double usual_area = 0;      // m2, mean of its triangles, undeformed
  double least_height =
      std::numeric_limits<double>::infinity(); // m, of its triangles in the plane, undeformed
  struct Edge {
    std::array<int, 2> nodes{};
    std::array<bool, 2> ends{}; // whether the face ends at the node
    double area = 0;            // m2, mean of the two triangles there, undeformed
  };
  std::vector<Edge> edges; // semi-edges along its outline
  std::vector<int> beside; // faces of the block beyond them
};

struct FlatFaces {
  std::vector<FlatFace> all;    // by block
  std::vector<int> of_triangle; // -1: of a mesh
};

} // namespace cdem
