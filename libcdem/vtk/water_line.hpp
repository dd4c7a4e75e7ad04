// Where the free surface of water cuts what is drawn, and the water's velocity as arrows.
#pragma once

#include "libcdem/results/snapshot.hpp"
#include "libcdem/vtk/picture.hpp"
#include "libcdem/vtk/section.hpp"
#include "libcdem/vtk/view.hpp"

namespace cdem {

inline constexpr Colour water_colour = {0.20, 0.52, 0.84}, water_line_colour = {0.03, 0.22, 0.55};
inline constexpr double water_opacity = 0.38;

using Segment = std::array<geom::Vec3, 2>; // m

// The shores of the sheets, and the lines where they cut the surface triangles at these points (m, moved). Triangles larger
// than a cell of the sheet are divided to its size.
std::vector<Segment> water_lines(const std::vector<WaterSheet>&, const std::vector<geom::Vec3>& points,
                                 const std::vector<geom::Triangle>& surface);

// Whether some of the sheets is seen: not seen from its edge alone, nor hidden everywhere by the surface triangles at these
// points.
bool is_seen(const std::vector<WaterSheet>&, const std::vector<geom::Vec3>& points,
             const std::vector<geom::Triangle>& surface, const View&);

// The part of the sheet over a rectangle of x and y; without the velocity at its points.
WaterSheet cropped(const WaterSheet&, const geom::Box&);

// Where the sheets cross a plane; the first has the label of the legend.
std::vector<Polyline> water_in_section(const std::vector<WaterSheet>&, const CutPlane&);

// Arrows of the sheets; the first has the label of the legend.
std::vector<Polyline> water_arrows(const std::vector<WaterSheet>&);
// Arrows in the plane of a section, outside of the blocks that it cuts.
std::vector<Polyline> water_arrows_in(const Snapshot& section, const std::vector<WaterSheet>&);

} // namespace cdem
