// Memory that building and cutting a model takes at most, told before it is taken. Every rank builds and cuts the whole model,
// so each of them takes all of it.
//
// The bytes are those of a tetrahedron, as measured: the largest memory of a process that builds a cube and takes a step,
// less that of the smallest model. They hold for models of 50,000 tets or more.
#pragma once

#include "libcdem/simulation.hpp"

namespace cdem {

double memory_to_build(const ModelSpec&);      // bytes
double memory_to_cut(std::int64_t block_tets); // bytes; with as many blocks afterwards as before

// One line, "" where the memory is enough. limit: bytes that each of so many ranks may take; what: "building this model".
std::string memory_warning(const std::string& what, double bytes, double limit, int ranks);

} // namespace cdem
