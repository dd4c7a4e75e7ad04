// A face of a cohesive body without strength, whose springs act for the last time: it separates, parts, or leaves; and one that
// has parted and comes back.
#pragma once

#include "libcdem/bond/cracking_faces.hpp"
#include "libcdem/bond/freed_face.hpp"
#include "libcdem/bond/leaving_faces.hpp"

namespace cdem {

class EndOfFace {
public:
  EndOfFace(const CohesiveChunk&, int face);

  bool gone() const { return is_gone(now_, size()); }

  // It has opened: what it still stores, J, is let go of, less the half step of work that its pull (N, at its points) would have
  // done. From now on it is a contact on its own plane, which closes where its sides stand now, or at a gap of zero if they
  // are further apart. Returns what breaking takes, J.
  double separate(const std::array<geom::Vec3, 3>& pull);

  void part();      // nothing is between its sides any more
  void come_back(); // they are a contact again, as after separate

  // Contacts around it may begin; its springs let go by and by. Returns what is lost, J.
  double leave();

private:
  double size() const { return std::sqrt(3 * of_.batch.area[of_.lane]); } // m
  FaceFrame before() const;                                               // a step ago

  const CohesiveChunk& chunk_;
  Joint room_;
  FreedFace of_;
  FaceFrame now_;
};

} // namespace cdem
