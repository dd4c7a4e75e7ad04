// Contact points of two solids that touch or are near each other: corner on face, face on corner, edge across edge.
//
// Only corners and edges that stand out (the surface is convex across the edge) can touch first. Where a corner is over
// a face, or two edges cross, the gap is signed: negative as far as one solid is inside the other. A corner inside came
// through the nearest face that it points against: of two cubes side by side on a plane the corners that enter each
// other's sides are level with each other's lower faces.
#pragma once

#include "libgeom/mesh/triangle_distance.hpp"
#include "libgeom/placement/pile.hpp"

#include <cstdint>
#include <utility>

namespace geom {

struct Features {
  struct Face {
    TrianglePoints points;
    Vec3 normal; // outward unit vector
    Box box;
  };
  struct Edge {
    Vec3 from, to;
    std::array<Vec3, 2> normals; // of the faces that meet there
    Box box;
  };
  std::vector<Vec3> corners; // of such edges
  std::vector<Vec3> outward; // of each corner: sum of the normals of these edges' faces
  std::vector<Edge> edges;
  std::vector<Face> faces;
  Box box;
};

Features features_of(const Surface&); // closed, or a part of one: its rim stands out
Features moved(const Features&, const Pose&);

struct Touch {
  Vec3 point;                 // m, on the first
  Vec3 normal;                // out of the second
  double gap = 0;             // m; negative inside
  std::uint64_t features = 0; // tells which two, as long as both solids are the same
};

// The pairs of features nearer than `reach` to each other.
class NearFeatures {
public:
  NearFeatures() = default;
  NearFeatures(const Features& first, const Features& second, double reach);

  // Adds the contact points with a clearance below `reach`, of the same two bodies at their present positions.
  void touches(const Features& first, const Features& second, double reach, std::vector<Touch>&) const;
  bool empty() const { return corner_face_.empty() && face_corner_.empty() && edge_edge_.empty(); }

private:
  std::vector<std::pair<int, int>> corner_face_, face_corner_, edge_edge_;
};

} // namespace geom
