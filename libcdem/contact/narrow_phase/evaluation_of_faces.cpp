// Flat faces of convex blocks that lie on each other: what presses on which, and the areas of contacts (geometry/face_cover.hpp).
#include "libcdem/contact/narrow_phase/evaluation.hpp"

#include "libcdem/contact/geometry/positions.hpp"

namespace cdem {

Evaluation::TwoFaces& Evaluation::two_faces(int f, int g) {
  const std::pair<int, int> faces = std::minmax(f, g);
  TwoFaces& known = two_faces_[static_cast<std::size_t>(f + g) % two_faces_.size()];
  if (known.faces != faces)
    known = {faces, std::nullopt, std::nullopt};
  return known;
}

const FaceCover& Evaluation::cover(int f, int g) {
  TwoFaces& two = two_faces(f, g);
  if (!two.cover)
    two.cover = cover_of(model_, state_, work_.faces.all[two.faces.first], work_.faces.all[two.faces.second]);
  return *two.cover;
}

double Evaluation::size_of(const std::pair<int, int>& two) const {
  return std::sqrt(std::min(work_.faces.all[two.first].usual_area, work_.faces.all[two.second].usual_area));
}

bool Evaluation::are_flat(int one, int other) {
  return work_.faces.of_triangle[one] >= 0 && work_.faces.of_triangle[other] >= 0 &&
         lie_on_each_other(facet(one).normal, facet(other).normal);
}

bool Evaluation::is_step(int one, int other, double depth) const {
  return depth > drawn_in * std::min(surface_.triangles[one].height, surface_.triangles[other].height);
}

std::optional<Nearest> Evaluation::pressed_by(int source, const geom::Vec3& spring, const Nearest& found) {
  const int f = work_.faces.of_triangle[source], next = work_.faces.of_triangle[found.target];
  if (f < 0 || next < 0)
    return found;
  const geom::Vec3 own = facet(source).normal;
  if (lie_on_each_other(own, facet(found.target).normal))
    return found;
  const auto lies_on_it = [&](int beside) {
    return are_flat(work_.faces.all[beside].triangles[0], found.target) && cover(beside, next).flat;
  };
  const std::vector<int>& around = work_.faces.all[f].beside;
  if (std::any_of(around.begin(), around.end(), lies_on_it))
    return std::nullopt;
  for (const int g : work_.faces.all[next].beside)
    if (are_flat(source, work_.faces.all[g].triangles[0]) && cover(f, g).covers(spring)) {
      Nearest on;
      for (const int t : work_.faces.all[g].triangles)
        if (const Nearest here = nearest_of(t, spring, facet(t).x, facet(t).normal);
            on.target < 0 || here.distance2 < on.distance2)
          on = here;
      if (on.height < 0)
        return on;
    }
  return found;
}

// Areas are looked at anew where faces pass the next line of a grid over them: wherever they have been before, it is the same. The
// grid is finer for those that change fast, as near an outline.
const std::array<double, 2>& Evaluation::nearing(int f, int g) {
  constexpr std::array cells{1e-3, 1e-4}; // over the size of the smaller face
  constexpr double origin = 0.37;         // in cells: where blocks are laid no line passes
  TwoFaces& two = two_faces(f, g);
  if (two.nearing)
    return *two.nearing;
  const FlatFace &one = work_.faces.all[two.faces.first], &other = work_.faces.all[two.faces.second];
  const double size = size_of(two.faces);
  const geom::Vec3 normal = facet(other.triangles[0]).normal;
  const auto past = [&](double ago) { // where two places of one face are over the other, in sizes
    const auto place = [&](const FlatFace& face, std::size_t half) -> geom::Vec3 {
      const int node = face.outline[half * face.outline.size() / 2];
      return place_of(model_, state_, node) - ago * velocity_of(state_, node);
    };
    const geom::Vec3 from = place(other, 0), e1 = (place(other, 1) - from).normalized(),
                     e2 = normal.cross(e1), a = place(one, 0) - from, b = place(one, 1) - from;
    return Eigen::Array4d(a.dot(e1), a.dot(e2), b.dot(e1), b.dot(e2)) / size;
  };
  const Eigen::Array4d now = past(0), before = past(work_.step);
  const double slid = (now - before).abs().maxCoeff();
  const auto in_grid = [&](double cell) {
    const bool passes = ((now / cell + origin).floor() != (before / cell + origin).floor()).any();
    return passes ? slid / std::max(1.5 * cell, slid) : 0;
  };
  two.nearing = {in_grid(cells[0]), in_grid(cells[1])};
  return *two.nearing;
}

Evaluation::OnFace Evaluation::on_face(int f, int g, const geom::Vec3& place, double of, const Contact* old,
                                       bool of_spring) {
  constexpr double least_part = 1e-3, fast = 10; // area changes over a size, in areas
  OnFace on;
  if (old) {
    const double widens = old->widening.norm() * size_of({f, g});
    on.nearing = work_.step > 0 ? nearing(f, g)[widens > fast * old->area] : 0;
    if (on.nearing == 0)
      return on;
  }
  const FaceCover& cover = this->cover(f, g);
  if (!cover.flat)
    return on;
  if (!cover.weighed)
    weigh(*two_faces(f, g).cover, work_.faces.all[std::min(f, g)], work_.faces.all[std::max(f, g)]);
  const double part = of_spring ? cover.part_of_spring(place, work_.faces.all[f]) : 1;
  on.area = of * std::max(least_part, part * cover.weight(place));
  return on;
}

} // namespace cdem
