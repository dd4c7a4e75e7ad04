// Faces that blocks share: broad phase over the blocks' boxes, then every pair of faces that look at each
// other in one plane is clipped to its common polygon.
#include "libgeom/assembly/assembly.hpp"
#include "libgeom/query/box_pairs.hpp"
#include "libgeom/query/clip_polygon.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

namespace geom {
namespace {

struct FaceData {
  Vec3 normal, centre;
  double area = 0;
  Box box;
};

// Faces of all blocks that are asked for, one after the other; data of others stays empty.
struct FaceTable {
  std::vector<FaceData> faces;
  std::vector<std::size_t> first; // place of a block's face 0

  FaceTable(const std::vector<Polyhedron>& blocks, const std::vector<char>& needed, double tolerance) {
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      first.push_back(faces.size());
      if (!needed[b])
        continue;
      const Polyhedron& block = blocks[b];
      for (const PolyhedronFace& face : block.faces) {
        FaceData data;
        const Vec3& origin = block.vertices[face.loop[0]];
        Vec3 twice = Vec3::Zero();
        for (std::size_t i = 1; i + 1 < face.loop.size(); ++i)
          twice += (block.vertices[face.loop[i]] - origin).cross(block.vertices[face.loop[i + 1]] - origin);
        Vec3 sum = Vec3::Zero();
        for (int v : face.loop) {
          data.box.extend(block.vertices[v]);
          sum += block.vertices[v] - origin;
        }
        data.area = 0.5 * twice.norm();
        data.normal = twice.normalized();
        data.centre = origin + sum / static_cast<double>(face.loop.size());
        data.box.min.array() -= tolerance;
        data.box.max.array() += tolerance;
        faces.push_back(data);
      }
    }
  }
};

class Matcher {
public:
  Matcher(const std::vector<Polyhedron>& blocks, const FaceTable& table, double tolerance)
      : blocks_(blocks), table_(table), tolerance_(tolerance) {}

  bool shared(int block_a, int face_a, int block_b, int face_b) {
    const FaceData &a = table_.faces[table_.first[block_a] + face_a],
                   &b = table_.faces[table_.first[block_b] + face_b];
    if (a.normal.dot(b.normal) > -0.9 || !touch(a.box, b.box))
      return false;
    // The larger face fixes the plane: a narrow one knows its own normal only to the rounding over its width.
    const bool a_larger = a.area >= b.area;
    const FaceData& large = a_larger ? a : b;
    const std::vector<Vec3>&large_x = blocks_[a_larger ? block_a : block_b].vertices,
          &small_x = blocks_[a_larger ? block_b : block_a].vertices;
    const std::vector<int>&large_loop =
              blocks_[a_larger ? block_a : block_b].faces[a_larger ? face_a : face_b].loop,
          &small_loop = blocks_[a_larger ? block_b : block_a].faces[a_larger ? face_b : face_a].loop;
    for (int v : small_loop)
      if (std::abs(large.normal.dot(small_x[v] - large.centre)) > tolerance_)
        return false;

    const Vec3 e1 = large.normal.unitOrthogonal(), e2 = large.normal.cross(e1);
    const auto flat = [&](const Vec3& x) {
      return Point(e1.dot(x - large.centre), e2.dot(x - large.centre));
    };
    polygon_.clear();
    for (int v : small_loop)
      polygon_.push_back(flat(small_x[v]));
    Point start = flat(large_x[large_loop.back()]);
    for (int v : large_loop) {
      const Point end = flat(large_x[v]);
      clip(polygon_, start, end, scratch_);
      if (polygon_.size() < 3)
        return false;
      start = end;
    }
    return wider_than(tolerance_, polygon_);
  }

private:
  const std::vector<Polyhedron>& blocks_;
  const FaceTable& table_;
  double tolerance_;
  Polygon polygon_, scratch_;
};

} // namespace

std::vector<SharedFace> shared_faces(const std::vector<Polyhedron>& blocks, const std::vector<char>& changed,
                                     double tolerance) {
  assert(changed.empty() || changed.size() == blocks.size());
  std::vector<Box> boxes;
  double largest = 0;
  for (const Polyhedron& block : blocks) {
    boxes.push_back(bounding_box(block));
    largest =
        std::max({largest, boxes.back().min.cwiseAbs().maxCoeff(), boxes.back().max.cwiseAbs().maxCoeff()});
  }
  // Far from the origin the coordinates themselves are rounded to more than the tolerance asked for.
  tolerance = std::max(tolerance, 16 * std::numeric_limits<double>::epsilon() * largest);
  for (Box& box : boxes) {
    box.min.array() -= tolerance;
    box.max.array() += tolerance;
  }
  const auto pairs = touching_pairs(boxes, changed);
  std::vector<char> needed(blocks.size(), 0);
  for (const auto& [a, b] : pairs)
    needed[a] = needed[b] = 1;
  const FaceTable table(blocks, needed, tolerance);

  Matcher matcher(blocks, table, tolerance);
  std::vector<SharedFace> result;
  std::vector<int> near_b;
  for (const auto& [a, b] : pairs) {
    near_b.clear();
    for (int fb = 0; fb < static_cast<int>(blocks[b].faces.size()); ++fb)
      if (touch(table.faces[table.first[b] + fb].box, boxes[a]))
        near_b.push_back(fb);
    for (int fa = 0; fa < static_cast<int>(blocks[a].faces.size()); ++fa)
      if (touch(table.faces[table.first[a] + fa].box, boxes[b]))
        for (int fb : near_b)
          if (matcher.shared(a, fa, b, fb))
            result.push_back({a, fa, b, fb});
  }
  std::sort(result.begin(), result.end(), [](const SharedFace& x, const SharedFace& y) {
    return std::tie(x.block_a, x.face_a, x.block_b, x.face_b) <
           std::tie(y.block_a, y.face_a, y.block_b, y.face_b);
  });
  return result;
}

std::vector<SharedFace> shared_faces(const std::vector<Polyhedron>& blocks, double tolerance) {
  return shared_faces(blocks, {}, tolerance);
}

} // namespace geom
