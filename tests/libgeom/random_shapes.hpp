// Random convex blocks and planes for the tests of laws that hold for any of them.
#pragma once

#include "libgeom/core/random.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <cmath>

namespace testing {

struct Draws {
  std::uint64_t seed, id, next = 0;
  double uniform(double low, double high) { return low + (high - low) * geom::uniform(seed, id, next++); }
  geom::Vec3 direction() {
    const double z = uniform(-1, 1), angle = uniform(0, 6.283185307179586), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  geom::Vec3 point(const geom::Box& box) {
    return {uniform(box.min.x(), box.max.x()), uniform(box.min.y(), box.max.y()),
            uniform(box.min.z(), box.max.z())};
  }
};

// A box of random proportions with up to `cuts` corners or edges taken off.
inline geom::Polyhedron random_block(Draws& draws, int cuts = 6) {
  geom::Polyhedron p =
      geom::make_box({0, 0, 0}, {draws.uniform(0.3, 1), draws.uniform(0.3, 1), draws.uniform(0.3, 1)});
  for (int i = 0; i < cuts; ++i) {
    const geom::Cut halves =
        geom::cut(p, geom::Plane::through(draws.point(geom::bounding_box(p)), draws.direction()));
    if (halves.above && halves.below) {
      const bool keep_above = geom::mass_properties(halves.above->shape).volume >
                              geom::mass_properties(halves.below->shape).volume;
      p = keep_above ? halves.above->shape : halves.below->shape;
    }
  }
  return p;
}

// Magnitude of the summed area vectors of all faces: zero for a closed surface.
inline double closure(const geom::Polyhedron& p) {
  geom::Vec3 sum = geom::Vec3::Zero();
  for (std::size_t f = 0; f < p.faces.size(); ++f)
    sum += geom::face_area(p, static_cast<int>(f)) * geom::face_normal(p, static_cast<int>(f));
  return sum.norm();
}

inline double surface_area(const geom::Polyhedron& p) {
  double sum = 0;
  for (std::size_t f = 0; f < p.faces.size(); ++f)
    sum += geom::face_area(p, static_cast<int>(f));
  return sum;
}

inline long euler(const geom::Polyhedron& p) {
  return static_cast<long>(p.vertices.size()) - static_cast<long>(geom::edges(p).size()) +
         static_cast<long>(p.faces.size());
}

} // namespace testing
