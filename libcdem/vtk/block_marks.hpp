// Marks over a picture, one for each block that it shows (in its `fit`): arrows along the displacement, crosses along the principal
// stresses. A block's place, displacement and stress are means over the area of it that is shown.
#pragma once

#include "libcdem/vtk/picture.hpp"

namespace cdem {

// The longest is as long as two blocks are wide, at most 8 % of the body. A legend says what the longest stands for. Of
// more than 1500 blocks evenly many are left out.
std::vector<Polyline> displacement_arrows(const Snapshot&, const PictureOptions&);
// Pressure and tension in two colours.
std::vector<Polyline> stress_crosses(const Snapshot&, const PictureOptions&);

} // namespace cdem
