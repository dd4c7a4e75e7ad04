// A .vtu of very many cells is written in pieces, each a .vtu of its own, which a .pvtu lists:
//
//   plate.vtu        becomes  plate.pvtu, plate/plate_0.vtu, plate/plate_1.vtu, ...
//   plate_bonds.vtu  likewise
//
// The cells of the whole are cut into runs as even as can be, whatever ranks have computed them. A piece has the points
// that its cells use, with their numbers in the whole (point_id), by which a reader joins points that several pieces have.
#pragma once

#include "libcdem/results/snapshot.hpp"

#include <string>
#include <vector>

namespace cdem {

// 1: one file. limit: cells of a file at most; 0: any number.
std::size_t number_of_pieces(std::size_t cells, std::size_t limit);

std::string list_of_pieces(const std::string& vtu_path);                // "out/plate.pvtu"
std::string piece_path(const std::string& vtu_path, std::size_t piece); // "out/plate/plate_0.vtu"

// Fields as the pieces have them. Throws FileError.
void write_list_of_pieces(const std::string& vtu_path, std::size_t pieces,
                          const std::vector<SnapshotField>& point_fields,
                          const std::vector<SnapshotField>& cell_fields);

// Removes what an earlier call has written of this name: the list with its pieces, but for the first `kept`; and the .vtu
// itself where pieces take its place.
void remove_superseded(const std::string& vtu_path, std::size_t kept);

} // namespace cdem
