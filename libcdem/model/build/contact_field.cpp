#include "libcdem/model/build/contact_field.hpp"

#include "libcdem/contact/field/surface_distance.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace cdem {
namespace {

// Of the usual height of a tetrahedron at the surface: how deep contacts may get. Cells that begin deeper take no part.
constexpr double deepest_ratio = 0.25;
// w, of the height, of an edge of a right angle.
constexpr double edge_width = 0.1;

struct Cell {
  std::array<int, 4> nodes{};
  int tet = 0; // of the model, that it is part of
};

double volume6(const std::array<geom::Vec3, 4>& x) {
  return (x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0]));
}

double slope(const std::array<geom::Vec3, 4>& x, const std::array<double, 4>& phi) {
  geom::Mat3 edges;
  geom::Vec3 rise;
  for (int k = 0; k < 3; ++k) {
    edges.row(k) = (x[k + 1] - x[0]).transpose();
    rise[k] = phi[k + 1] - phi[0];
  }
  return (edges.inverse() * rise).norm();
}

// The cells of one block.
class Cells {
public:
  Cells(const Model& model, int block, int first_mean) : model_(model), first_mean_(first_mean) {
    const Block& b = model.blocks[block];
    const ContactSurface& s = model.surface;
    std::vector<field::SurfaceDistance::Corners> corners;
    for (int t = s.block_begin[block]; t < s.block_begin[block + 1]; ++t) {
      const ContactTriangle& triangle = s.triangles[t];
      if (triangle.face >= 0)
        continue;
      faces_.insert(sorted(triangle.nodes));
      for (int i = 0; i < 3; ++i) {
        on_surface_.insert(triangle.nodes[i]);
        edges_.insert(std::minmax(triangle.nodes[i], triangle.nodes[(i + 1) % 3]));
      }
      corners.push_back({model.node_position[triangle.nodes[0]], model.node_position[triangle.nodes[1]],
                         model.node_position[triangle.nodes[2]]});
    }
    for (int t = b.tet_begin; t < b.tet_end; ++t)
      cells.push_back({{model.tets[t][0], model.tets[t][1], model.tets[t][2], model.tets[t][3]}, t});
    split<2>();
    split<3>();
    split<4>();
    const field::SurfaceDistance distance(std::move(corners));
    for (const Cell& cell : cells)
      for (const int node : cell.nodes)
        if (phi_.count(node) == 0)
          phi_[node] = surface(node) ? 0 : distance(place(node));
  }

  geom::Vec3 place(int node) const {
    const int n = static_cast<int>(model_.node_position.size());
    return node < n ? model_.node_position[node] : mean_place_[node - n - first_mean_];
  }
  double phi(int node) const { return phi_.at(node); }
  bool surface(int node) const { return on_surface_.count(node) > 0; }

  std::vector<Cell> cells;
  std::vector<MeanNode> means;

private:
  template <std::size_t Size>
  static std::array<int, Size> sorted(std::array<int, Size> nodes) {
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }
  bool outside(const std::array<int, 2>& edge) const { return edges_.count({edge[0], edge[1]}) > 0; }
  bool outside(const std::array<int, 3>& face) const { return faces_.count(face) > 0; }
  static bool outside(const std::array<int, 4>&) { return false; }

  // visit(sorted nodes) for every choice of Size of a cell's nodes that all lie on the surface but not in it.
  template <std::size_t Size, class Visit>
  void each_dead(const Cell& cell, const Visit& visit) const {
    for (int chosen = 0; chosen < 16; ++chosen) {
      std::array<int, Size> nodes{};
      std::size_t count = 0;
      bool all = true;
      for (int k = 0; k < 4; ++k)
        if ((chosen >> k & 1) != 0) {
          all = all && count < Size && surface(cell.nodes[k]);
          if (count < Size)
            nodes[count] = cell.nodes[k];
          ++count;
        }
      if (all && count == Size && !outside(sorted(nodes)))
        visit(sorted(nodes));
    }
  }

  // Every dead edge (Size 2), face (3) or cell (4) gets a node in its midst; the cells around it are split there.
  template <std::size_t Size>
  void split() {
    std::map<std::array<int, Size>, int> mean_of;
    for (std::size_t i = 0; i < cells.size();) {
      std::array<int, Size> dead{};
      bool found = false;
      each_dead<Size>(cells[i], [&](const std::array<int, Size>& nodes) {
        // The smallest first, so that cells on both sides of a face split it alike.
        if (!found || nodes < dead)
          dead = nodes;
        found = true;
      });
      if (!found) {
        ++i;
        continue;
      }
      const auto [at, fresh] = mean_of.try_emplace(dead, 0);
      if (fresh)
        at->second = add_mean(dead);
      const Cell whole = cells[i];
      bool first = true;
      for (const int node : dead) {
        Cell part = whole;
        *std::find(part.nodes.begin(), part.nodes.end(), node) = at->second;
        if (first)
          cells[i] = part;
        else
          cells.push_back(part);
        first = false;
      }
    }
  }

  template <std::size_t Size>
  int add_mean(const std::array<int, Size>& nodes) {
    MeanNode mean;
    mean.count = static_cast<int>(Size);
    geom::Vec3 x = geom::Vec3::Zero();
    for (std::size_t k = 0; k < Size; ++k) {
      mean.of[k] = nodes[k];
      x += place(nodes[k]) / static_cast<double>(Size);
    }
    means.push_back(mean);
    mean_place_.push_back(x);
    return static_cast<int>(model_.node_position.size() + means.size()) - 1 + first_mean_;
  }

  const Model& model_;
  int first_mean_;
  std::set<int> on_surface_;
  std::set<std::pair<int, int>> edges_;
  std::set<std::array<int, 3>> faces_;
  std::vector<geom::Vec3> mean_place_;
  std::map<int, double> phi_;
};

void add_cells(Model& model, int block, ContactField& field) {
  const ContactSurface& s = model.surface;
  const double youngs = model.bodies[model.blocks[block].body].material.youngs_modulus;
  const double usual = s.usual_height[block];
  field.compliance.push_back(usual / youngs);
  if (usual == 0)
    return;
  std::map<int, double> of_tet; // compliance of those with an outer triangle, of several the stiffest
  for (int t = s.block_begin[block]; t < s.block_begin[block + 1]; ++t) {
    const auto [at, fresh] = of_tet.try_emplace(s.triangles[t].tet, s.triangles[t].compliance);
    if (!fresh)
      at->second = std::min(at->second, s.triangles[t].compliance);
  }
  const Cells found(model, block, static_cast<int>(field.means.size()));
  field.means.insert(field.means.end(), found.means.begin(), found.means.end());
  for (const Cell& from : found.cells) {
    FieldCell cell;
    std::array<geom::Vec3, 4> x;
    bool at_surface = false;
    for (int k = 0; k < 4; ++k) {
      cell.nodes[k] = from.nodes[k];
      cell.phi[k] = found.phi(from.nodes[k]);
      x[k] = found.place(from.nodes[k]);
      at_surface = at_surface || found.surface(from.nodes[k]);
    }
    if (*std::min_element(cell.phi.begin(), cell.phi.end()) > deepest_ratio * usual)
      continue;
    cell.volume6 = volume6(x);
    cell.slope = at_surface ? slope(x, cell.phi) : 1;
    const auto known = of_tet.find(from.tet);
    cell.compliance = known == of_tet.end() ? usual / youngs : known->second;
    field.cells.push_back(cell);
  }
}

double edge_length(const Model& model, const ContactEdge& edge) {
  const auto normal = [&](int t) {
    const geom::Triangle& n = model.surface.triangles[t].nodes;
    const auto& x = model.node_position;
    return geom::Vec3((x[n[1]] - x[n[0]]).cross(x[n[2]] - x[n[0]]).normalized());
  };
  const double length = (model.node_position[edge.nodes[1]] - model.node_position[edge.nodes[0]]).norm();
  const double height = model.surface.usual_height[model.surface.triangles[edge.triangles[0]].block];
  // 1 at a right angle, 0 where the surface does not turn: the facets of a curved surface are no sharp edges.
  const double sharp = 1 - normal(edge.triangles[0]).dot(normal(edge.triangles[1]));
  return edge_width * height * length * sharp;
}

} // namespace

void build_field(Model& model) {
  model.field = {};
  if (model.surface.method != ContactMethod::field || model.surface.empty())
    return;
  ContactField& field = model.field;
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    field.mean_begin.push_back(static_cast<int>(field.means.size()));
    field.cell_begin.push_back(static_cast<int>(field.cells.size()));
    add_cells(model, b, field);
  }
  field.mean_begin.push_back(static_cast<int>(field.means.size()));
  field.cell_begin.push_back(static_cast<int>(field.cells.size()));
  for (const ContactEdge& edge : model.surface.edges)
    field.edge_length.push_back(edge_length(model, edge));
}

void require_field_can(const Model& model) {
  if (model.surface.method != ContactMethod::field)
    return;
  std::vector<int> blocks(model.bodies.size(), 0);
  for (const Block& block : model.blocks)
    ++blocks[block.body];
  const auto refuse = [](const std::string& body, const std::string& why) {
    throw geom::InputError("contact_method", "\"field\"",
                           "\"semi_springs\" with the body \"" + body + "\": " + why,
                           "leave contact_method out");
  };
  for (const Block& block : model.blocks) {
    const Body& body = model.bodies[block.body];
    const Bonding& bonding = body.bonding;
    if (!block.meshed || block.convex())
      continue;
    if (bonding.everywhere || bonding.between_regions || !bonding.regions.empty())
      refuse(body.name, "its mesh may break, and the field has no surfaces inside a mesh yet");
    if (block.rigid < 0 && blocks[block.body] == 1 && model.surface.joint.count({block.body, block.body}) > 0)
      refuse(body.name, "it is to touch itself, and the field acts between blocks only");
  }
}

} // namespace cdem
