#include "libcdem/contact/field/field_energy.hpp"

#include "libcdem/contact/acting.hpp"
#include "libcdem/contact/field/edge_in_tet.hpp"
#include "libcdem/contact/field/field_places.hpp"
#include "libcdem/contact/field/field_stiffness.hpp"
#include "libcdem/contact/places.hpp"
#include "libcdem/element/mesh_fields.hpp"

#include <algorithm>
#include <set>

namespace cdem::field {
namespace {

using V = Vec<double>;
constexpr int outward[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

V as_vec(const geom::Vec3& x) {
  return {x.x(), x.y(), x.z()};
}

// Of the faces of one tetrahedron in another: sum of integral phi^2 n dA, where phi has `values` at the nodes of the other.
V flux_of_square(const V (&faces_of)[4], const TetFrame<double>& in, const double (&values)[4]) {
  V sum = {0, 0, 0};
  for (const auto& face : outward) {
    double l[4][3];
    for (int i = 0; i < 3; ++i) {
      double at[4];
      barycentric(in, faces_of[face[i]], at);
      for (int k = 0; k < 4; ++k)
        l[k][i] = at[k];
    }
    const ClippedTriangle<double> c = clip_triangle(values, l);
    double p[3];
    for (int i = 0; i < 3; ++i)
      p[i] = values[0] * l[0][i] + values[1] * l[1][i] + values[2] * l[2][i] + values[3] * l[3][i];
    const double square = p[0] * (c.p - c.pu - c.pv) + p[1] * c.pu + p[2] * c.pv;
    const V n2 =
        cross(minus(faces_of[face[1]], faces_of[face[0]]), minus(faces_of[face[2]], faces_of[face[0]]));
    sum = {sum.x + square * n2.x, sum.y + square * n2.y, sum.z + square * n2.z};
  }
  return sum;
}

// m4, integral of phi over what the cell and the tetrahedron share, times V0/V.
double common(const FieldCell& cell, const V (&x)[4], const V (&y)[4]) {
  const TetFrame<double> own = tet_frame(x), other = tet_frame(y);
  const double phi[4] = {cell.phi[0], cell.phi[1], cell.phi[2], cell.phi[3]};
  double phi_at_other[4];
  for (int k = 0; k < 4; ++k) {
    double l[4];
    barycentric(own, y[k], l);
    phi_at_other[k] = phi[0] * l[0] + phi[1] * l[1] + phi[2] * l[2] + phi[3] * l[3];
  }
  const V a = flux_of_square(y, own, phi), b = flux_of_square(x, other, phi_at_other);
  const V g = potential_gradient(own, phi);
  return cell.volume6 / own.volume6 * (dot(g, a) + dot(g, b)) / (2 * dot(g, g));
}

double volume_energy(const Model& model, const State& state, int block, int other) {
  const Joint& joint = *contact_joint(model, block, other);
  const Block& body = model.blocks[other];
  geom::Box around;
  for (int n = body.node_begin; n < body.node_end; ++n)
    around.extend(place_of(model, state, n));
  double sum = 0;
  for (int c = model.field.cell_begin[block]; c < model.field.cell_begin[block + 1]; ++c) {
    const FieldCell& cell = model.field.cells[c];
    V x[4];
    geom::Box box;
    for (int k = 0; k < 4; ++k) {
      const geom::Vec3 at = field_place(model, state, cell.nodes[k]);
      box.extend(at);
      x[k] = as_vec(at);
    }
    if (apart(box, around))
      continue;
    double shared = 0;
    for (int t = body.tet_begin; t < body.tet_end; ++t) {
      V y[4];
      geom::Box of_tet;
      for (int k = 0; k < 4; ++k) {
        const geom::Vec3 at = place_of(model, state, model.tets[t][k]);
        of_tet.extend(at);
        y[k] = as_vec(at);
      }
      if (!apart(box, of_tet))
        shared += common(cell, x, y);
    }
    sum += cell_stiffness(model, joint, cell, other) * shared;
  }
  return sum;
}

double line_energy(const Model& model, const State& state, int source, int target) {
  const double k = edge_stiffness(model, *contact_joint(model, source, target), source, target);
  double sum = 0;
  for (std::size_t e = 0; e < model.surface.edges.size(); ++e) {
    const ContactEdge& edge = model.surface.edges[e];
    if (model.surface.triangles[edge.triangles[0]].block != source)
      continue;
    geom::Box line;
    for (const int n : edge.nodes)
      line.extend(place_of(model, state, n));
    for (int c = model.field.cell_begin[target]; c < model.field.cell_begin[target + 1]; ++c) {
      const FieldCell& cell = model.field.cells[c];
      V x[4];
      geom::Box box;
      for (int i = 0; i < 4; ++i) {
        const geom::Vec3 at = field_place(model, state, cell.nodes[i]);
        box.extend(at);
        x[i] = as_vec(at);
      }
      if (apart(line, box))
        continue;
      const TetFrame<double> tet = tet_frame(x);
      double l[4][2];
      for (int i = 0; i < 2; ++i) {
        double at[4];
        barycentric(tet, as_vec(place_of(model, state, edge.nodes[i])), at);
        for (int j = 0; j < 4; ++j)
          l[j][i] = at[j];
      }
      const double phi[4] = {cell.phi[0], cell.phi[1], cell.phi[2], cell.phi[3]};
      sum += 0.5 * k * model.field.edge_length[e] * clip_edge(phi, l).square;
    }
  }
  return sum;
}

} // namespace

double field_energy(const Model& model, const State& state, double lag) {
  const State then = moved_back(model, state, lag);
  std::set<std::pair<int, int>> pairs;
  double sum = 0;
  for (const Contact& c : state.contacts) {
    const auto [a, b] = blocks_of(model, c);
    pairs.insert(std::minmax(a, b));
    if (c.shear_stiffness > 0)
      sum += 0.5 * c.shear.squaredNorm() / c.shear_stiffness;
  }
  for (const auto& [a, b] : pairs)
    sum += volume_energy(model, then, a, b) + volume_energy(model, then, b, a) +
           line_energy(model, then, a, b) + line_energy(model, then, b, a);
  return sum;
}

} // namespace cdem::field
