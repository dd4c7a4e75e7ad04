// The rotation of an interface (bond/interface_frame.hpp), written for one interface and for several side by side.
#pragma once

#include "libcdem/parallel/triple.hpp"

namespace cdem {

// One side where it is now: the edges of its three nodes and the parts of the direction `along` in them.
template <class T>
struct TurnedSide {
  Triple<T> e1, e2;
  T along1, along2;
};

// Three axes that are fixed in the undeformed interface, at right angles.
template <class T>
struct Axes {
  Triple<T> normal, along, third;
};

template <class T>
struct Rotation {
  Triple<T> x, y, z; // columns
};

template <class T>
CDEM_INLINE Triple<T> turned(const Rotation<T>& r, const Triple<T>& v) {
  return v.x * r.x + v.y * r.y + v.z * r.z;
}

template <class T>
CDEM_INLINE Triple<T> turned_back(const Rotation<T>& r, const Triple<T>& v) {
  return {dot(r.x, v), dot(r.y, v), dot(r.z, v)};
}

template <class T>
CDEM_INLINE Rotation<T> rotation_of(const TurnedSide<T>& a, const TurnedSide<T>& b,
                                    const Axes<T>& undeformed) {
  const Triple<T> n = unit(unit(cross(a.e1, a.e2)) - unit(cross(b.e1, b.e2)));
  const Triple<T> both = a.along1 * a.e1 + a.along2 * a.e2 + b.along1 * b.e1 + b.along2 * b.e2;
  const Triple<T> t = unit(both - dot(both, n) * n);
  const Triple<T> m = cross(n, t);
  const Axes<T>& u = undeformed;
  return {u.normal.x * n + u.along.x * t + u.third.x * m, u.normal.y * n + u.along.y * t + u.third.y * m,
          u.normal.z * n + u.along.z * t + u.third.z * m};
}

} // namespace cdem
