// Tractions and movements of joints between blocks: point by point, summed by joint set, and as a surface.
//
// Tractions are those of the springs: effective where there is water (load/water.hpp). The utilisation of a point is
// its traction over its strength: for a whole bond the larger value of tension and shear, for all others the shear over
// the strength at their pressure. It is 1 where the joint slides and 0 where its faces are apart.
#pragma once

#include "libcdem/model/selection.hpp"
#include "libcdem/results/snapshot.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct JointPoint {
  geom::Vec3 place = geom::Vec3::Zero(); // m, undeformed
  double area = 0;                       // m2
  BondMode mode = BondMode::intact;
  double normal = 0, shear = 0; // Pa, traction: normal tension positive, size of the shear
  double water = 0;             // Pa
  double utilisation = 0;       // traction over strength
  double opening = 0,
         slip = 0;    // m, relative displacement since the beginning: along the normal, size of the rest
  bool apart = false; // carries nothing
};

// Which interfaces: of these sets ("" where none is wanted; empty: all), with points in the selection.
struct JointChoice {
  std::vector<std::string> sets;
  Selection on;
};

struct JointSum {
  std::string set;                // "": interfaces of no set
  std::int64_t interfaces = 0;    // with points that count
  std::int64_t parted = 0;        // interfaces that are left to contact; they are in no other number
  double area = 0, open_area = 0; // m2: all points, those that are apart
  double broken_area = 0;         // m2
  double normal = 0, shear = 0;   // Pa, means over the area
  double water = 0;               // Pa, mean over the area
  double mean_utilisation = 0, largest_utilisation = 0; // mean over the area that is not apart
  double mean_slip = 0, largest_slip = 0, mean_opening = 0, largest_opening = 0; // m
};

JointPoint joint_point(const Model&, const State&, int point);

// By set in alphabetical order, then all interfaces of no set where they were chosen. Throws geom::InputError for a set that
// there is not, and where nothing is chosen.
std::vector<JointSum> joint_sums(const Model&, const State&, const JointChoice&);
// All the points chosen that springs still hold, with the sets they belong to.
std::vector<std::pair<std::string, JointPoint>> joint_points(const Model&, const State&, const JointChoice&);

// Their interfaces as triangles: Snapshot::bonds with the fields of a JointPoint and "set", the number of the set in the
// alphabetical order of all, from 1; 0: of no set.
Snapshot joint_surface(const Model&, const State&, const JointChoice&, const std::string& title);

} // namespace cdem
