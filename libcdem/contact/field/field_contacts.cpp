#include "libcdem/contact/field/field_contacts.hpp"

#include "libcdem/contact/acting.hpp"
#include "libcdem/contact/field/edge_in_tet.hpp"
#include "libcdem/contact/field/field_places.hpp"
#include "libcdem/contact/field/field_stiffness.hpp"
#include "libcdem/contact/places.hpp"
#include "libcdem/parallel/simd.hpp"

#include <cmath>

namespace cdem::field {
namespace {

using simd::Oct;

// Of the usual height: the deepest that a contact may get.
constexpr double depth_ratio = 0.25;

// Eight sources each with a cell; an edge is a triangle whose third corner is its first.
struct Batch {
  int source[3][lanes];
  int cell[4][lanes];
  double phi[4][lanes];  // m
  double volume6[lanes]; // m3, undeformed
  // What comes of it.
  double gap[lanes]; // m, at most the distance of source and cell; 0: they may touch
  double volume_ratio[lanes];
  double weight[3][lanes]; // m: integrals of phi times the shape functions; of an edge the first two
  double part[lanes], deepest[lanes];
  double arm[4][lanes];       // m: the same of the cell's nodes
  double direction[3][lanes]; // n2, m2; of an edge grad phi
};

CDEM_INLINE Vec<Oct> places(const Node* place, const int (&nodes)[lanes]) {
  const simd::Vec v = simd::gather(place, nodes);
  return {v.x, v.y, v.z};
}

// Each face's plane of the cell, and that of the triangle, may part the two.
CDEM_INLINE Oct gap_of(const TetFrame<Oct>& tet, const Oct (&l)[4][3]) {
  Oct gap = constant<Oct>(0);
  const Vec<Oct>(&g)[3] = tet.gradient;
  const Vec<Oct> g0 = {-(g[0].x + g[1].x + g[2].x), -(g[0].y + g[1].y + g[2].y), -(g[0].z + g[1].z + g[2].z)};
  for (int k = 0; k < 4; ++k) {
    const Oct nearest = larger(l[k][0], larger(l[k][1], l[k][2]));
    const Vec<Oct>& gk = k == 0 ? g0 : g[k - 1];
    const Oct steep2 = dot(gk, gk);
    // Squared: roots lane by lane cost more than they are worth here.
    const Oct distance2 = nearest < 0.0 ? nearest * nearest / steep2 : constant<Oct>(0);
    gap = larger(gap, distance2);
  }
  return gap;
}

CDEM_INLINE bool any(const Oct& positive) {
  bool some = false;
  for (int i = 0; i < lanes; ++i)
    some = some || positive[i] == 0;
  return some;
}

CDEM_KERNEL void evaluate(const Node* place, Batch& b, bool edge) {
  Vec<Oct> x[4], q[3];
  for (int k = 0; k < 4; ++k)
    x[k] = places(place, b.cell[k]);
  for (int i = 0; i < 3; ++i)
    q[i] = places(place, b.source[i]);
  const TetFrame<Oct> tet = tet_frame(x);
  Oct l[4][3], values[4];
  for (int i = 0; i < 3; ++i) {
    Oct at[4];
    barycentric(tet, q[i], at);
    for (int k = 0; k < 4; ++k)
      l[k][i] = at[k];
  }
  for (int k = 0; k < 4; ++k)
    values[k] = simd::load(b.phi[k]);
  const Oct gap2 = gap_of(tet, l);
  simd::store(b.gap, gap2);
  if (!any(gap2)) {
    for (int i = 0; i < lanes; ++i)
      b.part[i] = 0;
    return;
  }
  const Oct volume6 = simd::load(b.volume6);
  simd::store(b.volume_ratio, volume6 / tet.volume6);
  Oct w[3], part, deepest;
  Vec<Oct> direction;
  if (edge) {
    Oct ends[4][2];
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < 2; ++i)
        ends[k][i] = l[k][i];
    const ClippedEdge<Oct> c = clip_edge(values, ends);
    w[0] = c.i - c.it;
    w[1] = c.it;
    w[2] = constant<Oct>(0);
    part = c.length;
    deepest = c.deepest;
    direction = potential_gradient(tet, values);
  } else {
    const ClippedTriangle<Oct> c = clip_triangle(values, l);
    w[0] = c.p - c.pu - c.pv;
    w[1] = c.pu;
    w[2] = c.pv;
    part = c.area;
    deepest = c.deepest;
    direction = cross(minus(q[1], q[0]), minus(q[2], q[0]));
  }
  for (int i = 0; i < 3; ++i)
    simd::store(b.weight[i], w[i]);
  simd::store(b.part, part);
  simd::store(b.deepest, deepest);
  for (int k = 0; k < 4; ++k)
    simd::store(b.arm[k], l[k][0] * w[0] + l[k][1] * w[1] + l[k][2] * w[2]);
  simd::store(b.direction[0], direction.x);
  simd::store(b.direction[1], direction.y);
  simd::store(b.direction[2], direction.z);
}

// What one cell makes of a row's source.
struct Press {
  ContactForce force;
  double depth = 0; // m
};

// The frame of a triangle, column by column.
geom::Mat3 frame_of(const Model& model, const State& state, int triangle) {
  const Corners x = corners_of(model, state, model.surface.triangles[triangle].nodes);
  geom::Mat3 frame;
  frame.col(0) = (x[1] - x[0]).normalized();
  frame.col(2) = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

class Rows {
public:
  Rows(const Model& model, const State& state, ContactWork& work, ContactChunk& out)
      : model_(model), state_(state), work_(work), out_(out) {}

  void begin(const FieldRow& row);
  void add(const FieldRow&, int cell, const Batch&, int lane);
  void end(const FieldRow&);
  bool asleep(const FieldRow& row) { // its blocks have not gone far enough
    return row.wake > travelled(row);
  }
  double travelled(const FieldRow& row) const {
    return work_.travelled[row.block] + work_.travelled[source_block(row)];
  }
  int source_triangle(const FieldRow& row) const {
    return row.kind == Contact::edge ? model_.surface.edges[row.source].triangles[0] : row.source;
  }
  int source_block(const FieldRow& row) const { return model_.surface.triangles[source_triangle(row)].block; }
  std::array<int, 3> source_nodes(const FieldRow& row) const {
    if (row.kind == Contact::spring)
      return model_.surface.triangles[row.source].nodes;
    const std::array<int, 2>& n = model_.surface.edges[row.source].nodes;
    return {n[0], n[1], n[0]};
  }

private:
  const Model& model_;
  const State& state_;
  ContactWork& work_;
  ContactChunk& out_;
  const Joint* joint_ = nullptr;
  std::vector<Press> pressed_;
};

void Rows::begin(const FieldRow& row) {
  joint_ = contact_joint(model_, source_block(row), row.block);
  pressed_.clear();
}

void Rows::add(const FieldRow& row, int index, const Batch& b, int lane) {
  const double sum = b.weight[0][lane] + b.weight[1][lane] + b.weight[2][lane];
  if (!(sum > 0) || !(b.part[lane] > 0))
    return;
  const FieldCell& cell = model_.field.cells[index];
  const geom::Vec3 direction(b.direction[0][lane], b.direction[1][lane], b.direction[2][lane]);
  const int own = source_block(row);
  Press p;
  ContactForce& f = p.force;
  f.source_block = own;
  f.target_block = row.block;
  f.arms.source = source_nodes(row);
  f.arms.target = cell.nodes;
  for (int i = 0; i < 3; ++i)
    f.arms.on_source[i] = b.weight[i][lane] / sum;
  for (int k = 0; k < 4; ++k)
    f.arms.normal[k] = f.arms.shear[k] = b.arm[k][lane] / sum;
  if (row.kind == Contact::edge) {
    const double k = edge_stiffness(model_, *joint_, own, row.block) * model_.field.edge_length[row.source];
    f.normal = -k * sum * direction;
    f.stiffness = k * b.part[lane] * direction.squaredNorm();
  } else {
    const double s = cell_stiffness(model_, *joint_, cell, own) * b.volume_ratio[lane];
    f.normal = -s * sum * direction;
    f.stiffness = s * b.part[lane] * direction.norm() * cell.slope;
  }
  p.depth = b.deepest[lane] / cell.slope;
  pressed_.push_back(p);
}

void Rows::end(const FieldRow& row) {
  Contact now(row.kind, row.kind == Contact::edge ? model_.surface.edges[row.source].id() : 3 * row.source);
  now.piece = row.block;
  now.target = model_.surface.block_begin[row.block] * (row.kind == Contact::edge ? 3 : 1);
  if (pressed_.empty())
    return;
  geom::Vec3 sum = geom::Vec3::Zero();
  double pressing = 0, stiffness = 0;
  for (const Press& p : pressed_) {
    sum += p.force.normal;
    pressing += p.force.normal.norm();
    stiffness += p.force.stiffness;
    now.depth = std::max(now.depth, p.depth);
  }
  now.normal = pressing > 0 && sum.norm() > 0 ? geom::Vec3(sum.normalized()) : geom::Vec3::UnitX();
  const int own = source_block(row);
  const double limit = sum.norm() * std::min(std::tan(joint_->friction_angle), work_.most_friction);
  now.shear_stiffness = stiffness * shear_ratio(model_, *joint_, own, row.block);
  const auto old = std::lower_bound(state_.contacts.begin(), state_.contacts.end(), now,
                                    [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  const geom::Mat3 frame = frame_of(model_, state_, source_triangle(row));
  const auto tangential = [&](const geom::Vec3& v) { return geom::Vec3(v - v.dot(now.normal) * now.normal); };
  geom::Vec3 shear = geom::Vec3::Zero();
  double stored = 0; // J, before the step
  if (old != state_.contacts.end() && key(*old) == key(now) && old->shear_stiffness > 0) {
    stored = 0.5 * old->shear.squaredNorm() / old->shear_stiffness;
    shear = tangential(frame * old->shear) * std::min(1.0, now.shear_stiffness / old->shear_stiffness);
  }
  double friction = 0;
  // Looked at again where nothing has moved, not a bit of it may change.
  const bool unmoved = work_.step == 0 && stored > 0 && old->normal == now.normal &&
                       old->shear_stiffness == now.shear_stiffness;
  if (unmoved)
    now.shear = old->shear;
  else if (limit > 0 || stored > 0) {
    geom::Vec3 slid = geom::Vec3::Zero();
    if (work_.step > 0)
      for (const Press& p : pressed_)
        slid += work_.step * p.force.normal.norm() / pressing * [&] {
          geom::Vec3 v = geom::Vec3::Zero();
          const ContactArms& arms = p.force.arms;
          for (int i = 0; i < 3; ++i)
            v += arms.on_source[i] * velocity_of(state_, arms.source[i]);
          for (int k = 0; k < 4; ++k)
            v -= arms.shear[k] * field_velocity(model_, state_, arms.target[k]);
          return v;
        }();
    slid = tangential(slid);
    const geom::Vec3 before = shear;
    shear -= now.shear_stiffness * slid;
    if (const double trial = shear.norm(); trial > limit)
      shear *= limit / trial;
    const double left = now.shear_stiffness > 0 ? 0.5 * shear.squaredNorm() / now.shear_stiffness : 0;
    friction = -0.5 * (before + shear).dot(slid) + stored - left;
    now.shear = frame.transpose() * shear;
  }
  shear = frame * now.shear;
  for (Press& p : pressed_) {
    p.force.shear = p.force.normal.norm() / pressing * shear;
    out_.forces.push_back(p.force);
  }
  out_.forces.back().friction = friction;
  const double usual = std::min(model_.surface.usual_height[own], model_.surface.usual_height[row.block]);
  ContactSums& sums = out_.sums;
  sums.depth = std::max(sums.depth, now.depth);
  sums.depth_over_height = std::max(sums.depth_over_height, now.depth / usual);
  if (const double part = now.depth / (depth_ratio * usual); part > sums.deepest) {
    sums.deepest = part;
    sums.deepest_source = source_triangle(row);
    sums.deepest_target = model_.surface.block_begin[row.block];
  }
  out_.contacts.push_back(now);
}

// A pair to look at; eight of several rows stand in a batch.
struct Awake {
  std::int64_t row = 0;
  std::uint32_t candidate = 0;
};

} // namespace

void find_field_places(const Model& model, const State& state, ContactWork& work, int threads) {
  const std::size_t n = model.node_position.size();
  work.field_place.resize(n + model.field.means.size());
  for_chunks(static_cast<std::int64_t>(work.field_near.size()), threads, [&](std::int64_t b) {
    if (!work.field_near[b])
      return;
    for (int i = model.blocks[b].node_begin; i < model.blocks[b].node_end; ++i)
      work.field_place[i] = node(place_of(model, state, i));
    for (int m = model.field.mean_begin[b]; m < model.field.mean_begin[b + 1]; ++m) {
      const MeanNode& mean = model.field.means[m];
      geom::Vec3 x = geom::Vec3::Zero();
      for (int k = 0; k < mean.count; ++k)
        x += vec(work.field_place[mean.of[k]]);
      work.field_place[n + m] = node(x / mean.count);
    }
  });
}

void field_contacts(const Model& model, const State& state, ContactWork& work, std::int64_t begin,
                    std::int64_t end, ContactChunk& out) {
  thread_local std::vector<Awake> awake;
  thread_local std::vector<Batch> batches;
  Rows rows(model, state, work, out);
  awake.clear();
  std::size_t count = 0;
  // Row by row; edges and triangles do not share a batch.
  const auto evaluate_from = [&](std::size_t first) {
    for (std::size_t i = first; i < awake.size(); i += lanes, ++count) {
      if (count == batches.size())
        batches.emplace_back();
      Batch& b = batches[count];
      for (int lane = 0; lane < lanes; ++lane) {
        const Awake& at = awake[std::min(i + lane, awake.size() - 1)];
        const FieldCell& cell = model.field.cells[work.field_candidates[at.candidate].cell];
        const std::array<int, 3> source = rows.source_nodes(work.field_rows[at.row]);
        for (int k = 0; k < 3; ++k)
          b.source[k][lane] = source[k];
        for (int k = 0; k < 4; ++k) {
          b.cell[k][lane] = cell.nodes[k];
          b.phi[k][lane] = cell.phi[k];
        }
        b.volume6[lane] = cell.volume6;
      }
      evaluate(work.field_place.data(), b, work.field_rows[awake[first].row].kind == Contact::edge);
    }
  };
  const auto finish = [&] {
    if (awake.empty())
      return;
    count = 0;
    evaluate_from(0);
    for (std::size_t i = 0; i < awake.size();) {
      FieldRow& row = work.field_rows[awake[i].row];
      const std::int64_t index = awake[i].row;
      const double travelled = rows.travelled(row);
      rows.begin(row);
      for (; i < awake.size() && awake[i].row == index; ++i) {
        const Batch& b = batches[i / lanes];
        const int lane = static_cast<int>(i % lanes);
        FieldCandidate& candidate = work.field_candidates[awake[i].candidate];
        candidate.wake = b.gap[lane] > 0 ? rounded_down(travelled + std::sqrt(b.gap[lane]) * (1 - 1e-9)) : 0;
        rows.add(row, candidate.cell, b, lane);
      }
      row.wake = std::numeric_limits<float>::infinity();
      for (std::uint32_t c = row.begin; c < row.begin + row.count; ++c)
        row.wake = std::min(row.wake, work.field_candidates[c].wake);
      rows.end(row);
    }
    awake.clear();
  };
  for (std::int64_t r = begin; r < end; ++r) {
    const FieldRow& row = work.field_rows[r];
    if (r > begin && row.kind != work.field_rows[r - 1].kind)
      finish();
    if (rows.asleep(row))
      continue;
    const double travelled = rows.travelled(row);
    for (std::uint32_t c = row.begin; c < row.begin + row.count; ++c)
      if (work.field_candidates[c].wake <= travelled)
        awake.push_back({r, c});
  }
  finish();
}

} // namespace cdem::field
