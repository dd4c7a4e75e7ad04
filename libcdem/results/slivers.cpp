#include "libcdem/results/slivers.hpp"

#include "libcdem/integrate/row_sums.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdem {
namespace {

constexpr double part_of_median = 1.0 / 3, least_gain = 2;
constexpr double infinite = std::numeric_limits<double>::infinity();

struct TetShape {
  double height = 0, longest = 0; // m
};

TetShape tet_shape(const Model& model, const geom::Tet& tet) {
  const auto x = [&](int i) -> const geom::Vec3& { return model.node_position[tet[i]]; };
  const double volume6 = std::abs((x(1) - x(0)).dot((x(2) - x(0)).cross(x(3) - x(0))));
  TetShape shape;
  double area2 = 0; // twice the largest
  for (int i = 0; i < 4; ++i) {
    const geom::Vec3 &a = x((i + 1) % 4), &b = x((i + 2) % 4), &c = x((i + 3) % 4);
    area2 = std::max(area2, (b - a).cross(c - a).norm());
    for (int j = 0; j < i; ++j)
      shape.longest = std::max(shape.longest, (x(i) - x(j)).norm());
  }
  shape.height = volume6 / area2;
  return shape;
}

std::vector<double> node_steps(const Model& model) { // s
  const std::vector<double> sums = all_row_sums(model);
  std::vector<double> steps(sums.size(), infinite);
  for (const Block& block : model.blocks)
    if (block.rigid < 0)
      for (int i = block.node_begin; i < block.node_end; ++i) {
        const double frequency2 = sums[i] / model.node_mass[i];
        steps[i] = stable_time_step(frequency2, block.meshed ? damping_of(model, i) * frequency2 : 0);
      }
  return steps;
}

// What may be a sliver: a convex block, or a tetrahedron of a mesh.
struct Candidate {
  int block = 0, tet = -1; // -1: all of the block
  double measure = 0;      // s or m, small for a sliver
};

double least_step(const std::vector<double>& steps, int begin, int end) {
  return *std::min_element(steps.begin() + begin, steps.begin() + end);
}

double step_of(const Model& model, const std::vector<double>& steps, const Candidate& c) {
  if (c.tet < 0)
    return least_step(steps, model.blocks[c.block].node_begin, model.blocks[c.block].node_end);
  double least = infinite;
  for (const int node : model.tets[c.tet])
    least = std::min(least, steps[node]);
  return least;
}

std::vector<Candidate> candidates_of(const Model& model, const std::vector<double>& steps, int body,
                                     bool elements) {
  std::vector<Candidate> all;
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    const Block& block = model.blocks[b];
    if (block.body != body || block.rigid >= 0 || block.convex() == elements)
      continue;
    if (!elements)
      all.push_back({b, -1, least_step(steps, block.node_begin, block.node_end)});
    else
      for (int tet = block.tet_begin; tet < block.tet_end; ++tet)
        all.push_back({b, tet, tet_shape(model, model.tets[tet]).height});
  }
  return all;
}

// Keeps those that are slivers; marks the nodes they touch.
std::vector<Candidate> slivers_among(const Model& model, std::vector<Candidate> all,
                                     std::vector<char>& touched) {
  const auto smaller = [](const Candidate& a, const Candidate& b) { return a.measure < b.measure; };
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end(), smaller);
  const double limit = part_of_median * middle->measure;
  all.erase(std::remove_if(all.begin(), all.end(), [&](const Candidate& c) { return c.measure >= limit; }),
            all.end());
  for (const Candidate& c : all) {
    const Block& block = model.blocks[c.block];
    if (c.tet < 0)
      std::fill(touched.begin() + block.node_begin, touched.begin() + block.node_end, 1);
    else
      for (const int node : model.tets[c.tet])
        touched[node] = 1;
  }
  return all;
}

void describe_worst(const Model& model, const Candidate& worst, Slivers& s) {
  const Block& block = model.blocks[worst.block];
  const auto centre = [&](const geom::Tet& t) -> geom::Vec3 {
    const auto& x = model.node_position;
    return (x[t[0]] + x[t[1]] + x[t[2]] + x[t[3]]) / 4;
  };
  if (worst.tet >= 0) {
    const TetShape shape = tet_shape(model, model.tets[worst.tet]);
    int first = worst.block; // of the body
    while (first > 0 && model.blocks[first - 1].body == block.body)
      --first;
    s.worst = worst.tet - model.blocks[first].tet_begin + 1;
    s.place = centre(model.tets[worst.tet]);
    s.height_over_size = shape.height / shape.longest;
    return;
  }
  double height = infinite;
  for (int tet = block.tet_begin; tet < block.tet_end; ++tet)
    height = std::min(height, tet_shape(model, model.tets[tet]).height);
  s.worst = block.id;
  s.place = block.mass.centroid;
  s.height_over_size = height / block.size;
}

} // namespace

std::vector<Slivers> find_slivers(const Model& model) {
  const std::vector<double> steps = node_steps(model);
  std::vector<char> touched(steps.size(), 0);
  std::vector<Slivers> found;
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body)
    for (const bool elements : {false, true}) {
      const std::vector<Candidate> all = candidates_of(model, steps, body, elements);
      if (all.empty())
        continue;
      const std::vector<Candidate> slivers = slivers_among(model, all, touched);
      if (slivers.empty())
        continue;
      Slivers s;
      s.body = model.bodies[body].name;
      s.elements = elements;
      s.cut = std::any_of(all.begin(), all.end(), [&](const Candidate& c) {
        const auto& faces = model.blocks[c.block].shape.faces;
        return std::any_of(faces.begin(), faces.end(),
                           [](const geom::PolyhedronFace& face) { return !face.cut.empty() || face.glued; });
      });
      s.count = static_cast<std::int64_t>(slivers.size());
      s.of = static_cast<std::int64_t>(all.size());
      const Candidate* worst = &slivers.front();
      s.step = infinite;
      for (const Candidate& c : slivers) {
        s.step = std::min(s.step, step_of(model, steps, c));
        worst = c.measure < worst->measure ? &c : worst;
      }
      describe_worst(model, *worst, s);
      found.push_back(s);
    }
  double others = infinite;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (!touched[i])
      others = std::min(others, steps[i]);
  for (Slivers& s : found)
    s.other_step = others;
  found.erase(std::remove_if(found.begin(), found.end(),
                             [&](const Slivers& s) { return least_gain * s.step > others; }),
              found.end());
  return found;
}

} // namespace cdem
