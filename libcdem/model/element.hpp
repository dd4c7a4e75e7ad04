// How a body's tets deform.
#pragma once

namespace cdem {

enum class Element {
  small_strain,  // star meshes of convex blocks, Han 2010 eqs 1-7
  finite_volume, // meshes that may move far, Feng 2014 eqs 2-14
  rigid          // meshes that keep their shape
};

} // namespace cdem
