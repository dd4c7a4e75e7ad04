#include "libcdem/load/smooth_normals.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <map>
#include <set>

namespace cdem {
namespace {

constexpr double cos_smooth = 0.766; // 40 degrees

struct Frame {
  explicit Frame(const std::array<geom::Vec3, 3>& x) {
    along = (x[1] - x[0]).normalized();
    out = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
    across = out.cross(along);
  }
  geom::Vec3 along, across, out;
};

// The outer triangles of one block, joined at their edges.
class Surface {
public:
  Surface(const Model& model, int block) : model_(model) {
    each_boundary_triangle(model, block, [&](int index, const BoundaryTriangle& t) {
      Member member;
      for (int i = 0; i < 3; ++i) {
        member.x[i] = model.node_position[t.nodes[i]];
        member.vertex[i] =
            vertices_.try_emplace(key(member.x[i]), static_cast<int>(places_.size())).first->second;
        if (member.vertex[i] == static_cast<int>(places_.size()))
          places_.push_back(member.x[i]), around_.emplace_back();
        around_[member.vertex[i]].push_back(static_cast<int>(members_.size()));
      }
      member.out = Frame(member.x).out;
      index_[index] = static_cast<int>(members_.size());
      members_.push_back(member);
    });
  }

  CornerNormals normals(int boundary) const {
    const int t = index_.at(boundary);
    const Frame frame(members_[t].x);
    CornerNormals result;
    for (int i = 0; i < 3; ++i) {
      const geom::Vec3 n = normal(t, i);
      result[i] = {n.dot(frame.along), n.dot(frame.across), n.dot(frame.out)};
    }
    return result;
  }

private:
  struct Member {
    std::array<geom::Vec3, 3> x;
    std::array<int, 3> vertex{};
    geom::Vec3 out;
  };
  using Key = std::array<double, 3>;
  static Key key(const geom::Vec3& x) { return {x.x(), x.y(), x.z()}; }

  bool share_edge(int a, int b) const {
    int shared = 0;
    for (const int v : members_[a].vertex)
      shared += static_cast<int>(std::count(members_[b].vertex.begin(), members_[b].vertex.end(), v));
    return shared >= 2;
  }

  // Triangles around a vertex that can be reached from t without a sharp edge.
  void grow(int t, int vertex, std::set<int>& patch) const {
    std::vector<int> open{t};
    while (!open.empty()) {
      const int here = open.back();
      open.pop_back();
      if (!patch.insert(here).second)
        continue;
      for (const int other : around_[vertex])
        if (patch.count(other) == 0 && share_edge(here, other) &&
            members_[here].out.dot(members_[other].out) > cos_smooth)
          open.push_back(other);
    }
  }

  geom::Vec3 normal(int t, int corner) const {
    const Member& own = members_[t];
    const int vertex = own.vertex[corner];
    std::set<int> ring;
    grow(t, vertex, ring);
    const auto known = known_.find({vertex, *ring.begin()});
    return known != known_.end()
               ? known->second
               : known_.emplace(std::pair(vertex, *ring.begin()), normal_of(vertex, ring)).first->second;
  }

  geom::Vec3 normal_of(int vertex, const std::set<int>& ring) const {
    geom::Vec3 mean = geom::Vec3::Zero();
    for (const int member : ring)
      mean += members_[member].out;
    mean.normalize();
    if (std::all_of(ring.begin(), ring.end(), [&](int m) { return members_[m].out.dot(mean) > 1 - 1e-12; }))
      return mean;
    std::set<int> patch = ring;
    for (const int member : ring)
      for (const int v : members_[member].vertex)
        if (v != vertex) {
          std::set<int> further;
          grow(member, v, further);
          patch.insert(further.begin(), further.end());
        }
    std::set<int> points;
    for (const int member : patch)
      if (members_[member].out.dot(mean) > 0.5) // beyond 60 degrees the height is no function of the place
        points.insert(members_[member].vertex.begin(), members_[member].vertex.end());
    points.erase(vertex);
    return fitted(places_[vertex], mean, points);
  }

  // Height over the plane across `mean` as a x + b y + c x^2 + d x y + e y^2.
  geom::Vec3 fitted(const geom::Vec3& at, const geom::Vec3& mean, const std::set<int>& points) const {
    if (points.size() < 6)
      return mean;
    const geom::Vec3 across = mean.unitOrthogonal(), up = mean.cross(across);
    Eigen::MatrixXd a(points.size(), 5);
    Eigen::VectorXd height(points.size());
    double size = 0;
    for (const int p : points)
      size = std::max(size, (places_[p] - at).norm());
    int row = 0;
    for (const int p : points) {
      const geom::Vec3 d = (places_[p] - at) / size;
      const double x = d.dot(across), y = d.dot(up);
      a.row(row) << x, y, x * x, x * y, y * y;
      height[row++] = d.dot(mean);
    }
    const Eigen::VectorXd c = a.colPivHouseholderQr().solve(height);
    const geom::Vec3 normal = (mean - c[0] * across - c[1] * up).normalized();
    return normal.dot(mean) > cos_smooth ? normal : mean;
  }

  const Model& model_;
  std::map<Key, int> vertices_;
  std::vector<geom::Vec3> places_;
  std::vector<std::vector<int>> around_;
  std::vector<Member> members_;
  std::map<int, int> index_;                                // of MeshData::boundary
  mutable std::map<std::pair<int, int>, geom::Vec3> known_; // by vertex and the first triangle of its ring
};

} // namespace

std::vector<CornerNormals> smooth_normals(const Model& model, const std::vector<int>& faces) {
  const CornerNormals flat{geom::Vec3::UnitZ(), geom::Vec3::UnitZ(), geom::Vec3::UnitZ()};
  std::vector<CornerNormals> normals;
  std::map<int, Surface> surfaces;
  for (const int f : faces) {
    const OuterFace& face = model.outer_faces[f];
    normals.push_back(flat);
    if (face.boundary < 0 || model.blocks[face.block].convex())
      continue;
    const auto surface = surfaces.try_emplace(face.block, model, face.block).first;
    normals.back() = surface->second.normals(face.boundary);
  }
  return normals;
}

CornerNormals turned_with(const CornerNormals& normals, const std::array<geom::Vec3, 3>& x) {
  const Frame frame(x);
  CornerNormals result;
  for (int i = 0; i < 3; ++i)
    result[i] = normals[i].x() * frame.along + normals[i].y() * frame.across + normals[i].z() * frame.out;
  return result;
}

} // namespace cdem
