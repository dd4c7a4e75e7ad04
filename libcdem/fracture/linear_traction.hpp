// The linear traction with the resultant and the moment of those at given points of one plane (theory, section 22, "Joined blocks").
#pragma once

#include "libgeom/core/types.hpp"

namespace cdem {

class LinearTraction {
public:
  // x: m, from a place near all of them.
  void add(double area, const geom::Vec3& x, const geom::Vec3& traction, const geom::Vec3& normal) {
    area_ += area;
    first_ += area * x;
    second_ += area * x * x.transpose();
    force_ += area * traction;
    arms_ += area * traction * x.transpose();
    along_ += area * normal;
  }
  void fit() {
    centroid_ = first_ / area_;
    mean_ = force_ / area_;
    normal_ = along_.normalized();
    const geom::Mat3 second = second_ - area_ * centroid_ * centroid_.transpose(),
                     arms = arms_ - force_ * centroid_.transpose();
    const double polar = second.trace();
    const geom::Vec3 moment(arms(2, 1) - arms(1, 2), arms(0, 2) - arms(2, 0), arms(1, 0) - arms(0, 1));
    slope_ = (second + polar * normal_ * normal_.transpose()).inverse() * (arms.transpose() * normal_);
    slope_ -= slope_.dot(normal_) * normal_;
    turn_ = normal_.dot(moment) / polar * normal_;
  }
  geom::Vec3 at(const geom::Vec3& x) const {
    const geom::Vec3 r = x - centroid_;
    return mean_ + slope_.dot(r) * normal_ + turn_.cross(r);
  }

private:
  double area_ = 0;
  geom::Vec3 first_ = geom::Vec3::Zero(), force_ = geom::Vec3::Zero(), along_ = geom::Vec3::Zero();
  geom::Mat3 second_ = geom::Mat3::Zero(), arms_ = geom::Mat3::Zero();
  geom::Vec3 centroid_ = geom::Vec3::Zero(), normal_ = geom::Vec3::Zero(), mean_ = geom::Vec3::Zero(),
             slope_ = geom::Vec3::Zero(), turn_ = geom::Vec3::Zero();
};

} // namespace cdem
