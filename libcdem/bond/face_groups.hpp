// Freed faces of cohesive bodies several side by side: their nodes, how they stand, and what they remember.
#pragma once

#include "libcdem/bond/cohesive_law.hpp"
#include "libcdem/bond/cracking_faces.hpp"
#include "libcdem/bond/sliding_faces.hpp"

#include <algorithm>
#include <cstddef>

namespace cdem {

// The faces that are computed together; lanes from `count` on repeat the last face, and what they give is dropped.
template <class V>
struct FaceGroup {
  int count = 0;
  int face[simd::width<V>], a[3][simd::width<V>], b[3][simd::width<V>]; // and its nodes' places
  V area, k; // m2, a third of a face, of which its springs act; Pa/m
};

template <class V>
CDEM_INLINE FaceGroup<V> face_group(const CohesiveChunk& chunk, const int* faces, int count) {
  FaceGroup<V> g;
  g.count = std::min(count, simd::width<V>);
  V kn, let_go;
  for (int lane = 0; lane < simd::width<V>; ++lane) {
    const int face = g.face[lane] = faces[std::min(lane, g.count - 1)];
    const FaceBatch& batch = chunk.batches[face / lanes];
    for (int corner = 0; corner < 3; ++corner) {
      g.a[corner][lane] = batch.place_a[corner][face % lanes];
      g.b[corner][lane] = batch.place_b[corner][face % lanes];
    }
    g.area[lane] = batch.area[face % lanes];
    kn[lane] = batch.kn[face % lanes];
    let_go[lane] = chunk.state[face / lanes].let_go[face % lanes];
  }
  g.k = kn / g.area;
  g.area *= 1.0 - let_go;
  return g;
}

// The faces of a group, with all that they remember, side by side. A face's numbers stand one behind the other
// (state/cohesive_face.hpp): they are read and written in runs as long as a vector, and turned over.
template <class V>
class FaceMemories {
  static constexpr int offset = offsetof(CohesiveFace, offset) / sizeof(double),
                       start = offsetof(CohesiveFace, start) / sizeof(double),
                       drawn = offsetof(CohesiveFace, drawn) / sizeof(double),
                       rest = offsetof(CohesiveFace, rest) / sizeof(double),
                       damage = offsetof(CohesiveFace, damage) / sizeof(double),
                       slip = offsetof(CohesiveFace, slip) / sizeof(double),
                       preload = offsetof(CohesiveFace, preload) / sizeof(double),
                       read = (preload + 7) / 8 * 8;
  static_assert(offsetof(CohesiveFace, plane) == 0 && offset < start && start < drawn && drawn < rest &&
                    rest < damage && damage < slip && slip < preload &&
                    read * sizeof(double) <= sizeof(CohesiveFace),
                "runs are read up to the preload and not beyond the face");

public:
  static constexpr int of_offsets = start; // as many numbers have the offsets, and those before them

  // Those before the preload, or as many as asked for, in whole runs.
  CDEM_INLINE FaceMemories(const CohesiveFace* faces, const FaceGroup<V>& g, int numbers = preload) : g_(g) {
    for (int first = 0; first < numbers; first += simd::width<V>) {
      V run[simd::width<V>];
      for (int lane = 0; lane < simd::width<V>; ++lane)
        run[lane] = simd::load_wide<V>(numbers_of(faces[g.face[lane]]) + first);
      simd::transpose(run);
      for (int i = 0; i < simd::width<V>; ++i)
        at_[first + i] = run[i];
    }
  }

  CDEM_INLINE Triple<V> offset_of(int point) const { return triple_at(offset + 3 * point); }
  CDEM_INLINE CohesivePoint<V> point(int p) const {
    return {triple_at(0),
            offset_of(p),
            triple_at(start + 3 * p),
            triple_at(rest + 3 * p),
            triple_at(slip + 3 * p),
            at_[damage + p],
            at_[drawn + p]};
  }

  CDEM_INLINE void advance(int p, const CohesiveResponse<V>& r) {
    at_[damage + p] = r.damage;
    at_[drawn + p] = r.drawn;
    at_[slip + 3 * p] = r.slip.x;
    at_[slip + 3 * p + 1] = r.slip.y;
    at_[slip + 3 * p + 2] = r.slip.z;
  }

  // Writes the runs in which something advances.
  CDEM_INLINE void keep(CohesiveFace* faces) const {
    for (int first = 0; first < preload; first += simd::width<V>) {
      const auto meets = [&](int begin, int end) { return first < end && begin < first + simd::width<V>; };
      if (!meets(drawn, rest) && !meets(damage, preload))
        continue;
      V run[simd::width<V>];
      for (int i = 0; i < simd::width<V>; ++i)
        run[i] = at_[first + i];
      simd::transpose(run);
      for (int lane = 0; lane < g_.count; ++lane)
        simd::store_wide<V>(numbers_of(faces[g_.face[lane]]) + first, run[lane]);
    }
  }

private:
  template <class Face>
  CDEM_INLINE static auto numbers_of(Face& face) {
    return face.plane.data();
  }
  CDEM_INLINE Triple<V> triple_at(int i) const { return {at_[i], at_[i + 1], at_[i + 2]}; }

  const FaceGroup<V>& g_;
  V at_[read];
};

// Faces at one moment.
template <class V>
struct FacesNow {
  FramesOfFaces<V> frame;
  Triple<V> gap[3]; // m, at the points, in the axes of each face

  CDEM_INLINE Triple<V> in_space(const Triple<V>& v) const {
    return v.x * frame.along + v.y * frame.across + v.z * frame.normal;
  }
};

// Now, and as long ago as the last step lasted.
template <class V>
struct FacesNowAndBefore {
  FacesNow<V> now, before;
};

template <class V>
CDEM_INLINE FacesNow<V> faces_at(const Triple<V> (&x)[3], const Triple<V> (&d)[3]) {
  FacesNow<V> s;
  s.frame = frames_of_faces<V>(x, d);
  const V half = V{} + 0.5, sixth = V{} + 1.0 / 6;
  const Triple<V> common = sixth * (d[0] + d[1] + d[2]);
  for (int point = 0; point < 3; ++point) {
    const Triple<V> gap = common + half * d[point];
    s.gap[point] = {dot(gap, s.frame.along), dot(gap, s.frame.across), dot(gap, s.frame.normal)};
  }
  return s;
}

template <class V, bool with_before>
CDEM_INLINE FacesNowAndBefore<V> faces_now_and_before(const FaceGroup<V>& g, const FaceMotion& motion) {
  Triple<V> x[3], d[3];
  for (int corner = 0; corner < 3; ++corner) {
    x[corner] = simd::gather_wide<V>(motion.position, g.a[corner]);
    d[corner] = simd::gather_wide<V>(motion.displacement, g.b[corner]) -
                simd::gather_wide<V>(motion.displacement, g.a[corner]);
  }
  FacesNowAndBefore<V> s;
  s.now = faces_at<V>(x, d);
  if constexpr (with_before) {
    const V step = V{} + motion.step;
    for (int corner = 0; corner < 3; ++corner) {
      const Triple<V> va = simd::gather_wide<V>(motion.velocity, g.a[corner]),
                      vb = simd::gather_wide<V>(motion.velocity, g.b[corner]);
      x[corner] = x[corner] - step * va;
      d[corner] = d[corner] - step * (vb - va);
    }
    s.before = faces_at<V>(x, d);
  }
  return s;
}

// What the points of faces pull with (N, in space), shared out to their corners, face by face.
template <class V>
CDEM_INLINE void share_to_corners(const FaceGroup<V>& g, const Triple<V> (&pull)[3], Node* force) {
  const V half = V{} + 0.5, sixth = V{} + 1.0 / 6;
  const Triple<V> common = sixth * (pull[0] + pull[1] + pull[2]);
  Triple<V> at[3];
  for (int corner = 0; corner < 3; ++corner)
    at[corner] = common + half * pull[corner];
  for (int lane = 0; lane < g.count; ++lane)
    for (int corner = 0; corner < 3; ++corner) {
      const simd::Quad f = {at[corner].x[lane], at[corner].y[lane], at[corner].z[lane], 0};
      Node &a = force[g.a[corner][lane]], &b = force[g.b[corner][lane]];
      simd::store(a, simd::load(a) + f);
      simd::store(b, simd::load(b) - f);
    }
}

} // namespace cdem
