// Lays the units of an armour layer one after another, each at rest. Then all of them come to rest together, and units
// with too few supports are repositioned (repositioning.cpp).
//
// A unit is tried in many attitudes: some in which it stands on the bare slope by itself, some that fit into the
// pattern, any others. In each it is lowered along the normal of the slope as near to its place as it comes down to the
// ground between the units there. The attitudes nearest to the target come to rest (placement/rest.hpp). At first they
// have almost no friction and are held within `play` of the target along the contour, so that they slide against the
// units below; then friction alone acts. The best position is taken: at rest, on the ground, against the two units
// below, with three supports or more, near the target, and in another attitude than its neighbours.
#pragma once

#include "libgeom/placement/armour_layer.hpp"
#include "libgeom/placement/lattice.hpp"
#include "libgeom/placement/lowering.hpp"
#include "libgeom/placement/rest.hpp"

namespace geom {

class Laying {
public:
  // Walls along the slope, facing each other.
  struct Between {
    double low = 0, high = 0; // m along the contour
  };
  // Rows of the frame: along the contour, up the slope, out of it. `lower`: units of the layers below, which stay where
  // they are and have the first numbers. poll is called now and then; it may throw.
  Laying(const Pile&, const Ground&, const Mat3& frame, double gap, const LayerOptions&, const Spacing&,
         std::optional<Between> walls, const std::vector<Pose>& lower, std::function<void()> poll);
  int lower_units() const { return lower_units_; }

  struct Site {
    int unit = 0;
    Vec3 place = Vec3::Zero(); // in the slope's axes, one row over the units below; z means nothing
    double wanted = 0;         // m up the slope, for the density
    std::vector<int> below;    // the units it is to lean on
    int end = 0;               // -1, 1: nothing is below it on that side, it may go there as far as the wall
  };
  // Throws InputError where there is no ground. `before`: a layer with another spacing; where a unit comes to lie no worse in
  // the attitude it had there, no other is tried.
  void lay(const Site&, const Laying* before = nullptr);

  // How all units came to rest together.
  struct Rested {
    bool still = false;        // all of them at rest, and clear of each other
    std::vector<int> leaning;  // units on which fewer than three things press
    std::vector<int> put_back; // would have gone too far, and stay as they were laid
  };
  // Units from number `held` on come to rest once more, all together: those above press on those below. If they are not
  // clear of each other then, they are where they were.
  void rest_together(int held);
  // After that: each unit with fewer than three supports is repositioned and rests together with the units about it. Then
  // all rest together again. So until no such unit is left, or so many times. left: told how many there are.
  void reposition_unsupported(int held, const std::function<void(int)>& left);
  const Rested& rested() const { return rested_; }

  const Pose& pose(int unit) const { return laid_[unit].pose; }
  // In the slope's axes, of the centroid.
  Vec3 place(int unit) const { return frame_ * laid_[unit].pose.translation; }

private:
  struct Laid {
    Pose pose;
    double cost = 0;
    Features features;
    Surface surface;
    Profile profile;
  };
  struct Try {
    Pose pose;
    double cost = 0;   // in heights
    bool good = false; // at rest on three things or more
  };
  using Near = std::vector<const Laid*>;
  static constexpr int least_carriers = 3; // things, above the first row
  static constexpr double roll =
      0.5; // over the height: how far a unit may move once it is not held in its place

  std::vector<Mat3> stands() const;
  std::vector<Mat3> attitudes(const Site&) const;
  Try lowered(const Mat3& rotation, const Site&) const;
  Try first_to_fit(const std::vector<Try>& lowered) const;
  Try best_at_rest(const std::vector<Try>& lowered, const Site&) const;
  Try rested(const Try&, const Site&, const Near&) const;
  static int carriers_wanted(const Site&);
  double cost(const Rest&, const Site&, const Near&) const;
  bool clear(const Pose&, const Near&) const;
  Pose raised(Pose, const Near&) const;
  Laid laid_at(const Pose&, double cost) const;
  Near near(const Vec3& centroid, double reach, int except = -1) const;
  Near on_the_way(const Vec3& centroid, int except = -1) const;
  void rest_together(const std::vector<char>& moves, double step, int steps);
  std::vector<char> above(int held) const;
  std::vector<char> around(int unit, int held) const;
  bool no_worse_than(const Rested&) const;
  bool reposition(int unit, int round);
  void reposition_one_by_one(int held, int first_round, std::vector<int>& in_vain,
                             const std::function<void(int)>& left);
  double ground_level(const Vec3& place) const;
  double standing() const;
  RestOptions resting(double friction) const;
  Surface surface_at(const Pose&) const;
  Features wall(double at, double facing) const;
  bool within_walls(const Surface&) const;
  // m along the contour from the place of a site, where its centroid may be.
  Between room(const Site&) const;

  Surface shape_;
  Features features_, ground_features_;
  const Ground& ground_;
  Mat3 frame_;
  double gap_, height_, radius_, gyration_;
  LayerOptions options_;
  Profile ground_profile_;
  std::optional<Between> walls_;
  std::vector<Features> wall_features_;
  std::vector<Mat3> family_; // attitudes that fit into the pattern
  std::vector<Mat3> stands_; // in which a unit stands on the bare slope by itself
  std::vector<Site> sites_;
  std::vector<Laid> laid_;
  int lower_units_ = 0;
  Rested rested_;
  std::function<void()> poll_;
};

} // namespace geom
