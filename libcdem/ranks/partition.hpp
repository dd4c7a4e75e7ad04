// Assigns to each rank a run of consecutive chunks, such that a counted load is shared evenly. The load is counted,
// never timed, so that a run can be repeated.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

struct State;

// First of each rank's share, and the end of the last one's: size + 1 numbers. Shares are as even as whole items allow.
std::vector<std::int64_t> even_shares(const std::vector<double>& load, int size);

// What a step costs for each of these of Model::chunks, in tets: those that deform, the bonds between them, and the faces
// that have broken and still hold their sides.
std::vector<double> chunk_loads(const Model&, const State&, Range chunks);

// The load of the largest share over the mean, for shares cut at `begin`.
double imbalance(const std::vector<double>& load, const std::vector<std::int64_t>& begin);

struct Partition {
  int rank = 0, size = 1;
  std::vector<std::int64_t> chunk_begin; // (size + 1) into Model::chunks
  std::vector<std::int64_t> point_begin; // (size + 1) into Model::point_chunks
  std::vector<std::int64_t> node_begin;  // (size + 1) nodes of those chunks
  std::int64_t stars = 0;                // chunks of blocks of small strain, before those of meshes

  // loads: of all chunks, chunk_loads.
  Partition(const Model&, const std::vector<double>& loads, int rank, int size);

  Range chunks() const { return share(chunk_begin); } // of Model::chunks
  Range mesh_chunks() const;                          // of MeshData::chunks, likewise
  Range point_chunks() const { return share(point_begin); }
  Range nodes() const { return share(node_begin); }
  int owner_of_node(std::int64_t node) const { return owner(node_begin, node); }

  static int owner(const std::vector<std::int64_t>& begin, std::int64_t item);

private:
  Range share(const std::vector<std::int64_t>& begin) const { return {begin[rank], begin[rank + 1]}; }
};

} // namespace cdem
