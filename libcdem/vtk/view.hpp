// Where the viewer stands and how places in the model become pixels.
#pragma once

#include "libcdem/vtk/picture.hpp"

namespace cdem {

struct Rect { // pixels, origin at the lower left
  double left = 0, bottom = 0, width = 0, height = 0;
  double right() const { return left + width; }
  double top() const { return bottom + height; }
  double centre_x() const { return left + width / 2; }
  double centre_y() const { return bottom + height / 2; }
};

class View {
public:
  // Throws geom::InputError for an unknown view, or a camera without direction.
  static View named(const std::string& view, const std::string& up);
  static View from(const Camera&);
  // "iso" from the corner, one of four about the upward axis, from which far more of what looks upwards is seen past what
  // stands in front: the face of a slope, stepped or plane, and not its back. The usual corner where another shows less than half as much again.
  static View iso(const std::string& up, const std::vector<geom::Vec3>& points,
                  const std::vector<geom::Triangle>& surface);

  // Named views: moves and scales so that the extent (in view axes) fills `frame` but for `inset` pixels all
  // round.
  void fit(const geom::Box& extent_in_view, const Rect& frame, double inset);
  // Literal camera: the frame shows view_angle from bottom to top.
  void place(const Rect& frame);

  geom::Vec3 in_view(const geom::Vec3& x) const { return {right.dot(x), up.dot(x), toward.dot(x)}; }
  // In view axes: right, up, toward the viewer, m.
  geom::Box extent(const std::vector<geom::Vec3>& points) const;
  geom::Box extent(const geom::Box&) const;
  double pixel_size(const geom::Vec3& x) const; // m a pixel covers at the depth of x
  std::array<double, 2> pixel(const geom::Vec3& x) const;
  bool in_front(const geom::Vec3& x) const; // of the camera
  geom::Vec3 direction_to_viewer(const geom::Vec3& x) const;

  geom::Vec3 right, up, toward;                // unit vectors; toward points from the model to the viewer
  geom::Vec3 focal_point = geom::Vec3::Zero(); // m, shown in the middle of the frame
  double distance = 1;                         // m from the camera to the focal point
  double view_angle = 30;                      // degrees
  bool perspective = false, literal = false;
  double metres_per_pixel = 1; // at the focal point
  Rect frame;
};

// Of a picture of these points; not yet placed in it.
View view_of(const PictureOptions&, const std::vector<geom::Vec3>& points,
             const std::vector<geom::Triangle>& surface);

} // namespace cdem
