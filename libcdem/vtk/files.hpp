// ParaView files of a snapshot: blocks as an unstructured grid of tets (.vtu, or .vtkhdf by the ending), interfaces as a
// second file of triangles beside it, a time series of both as a .pvd. Every file is written under a temporary name and
// renamed, so that a reader never sees half of one.
#pragma once

#include "libcdem/results/contact_points.hpp"
#include "libcdem/results/snapshot.hpp"

#include <string>
#include <vector>

namespace cdem {

// Cells in one file that Model:save writes, unless it is asked for others: some GB of memory while they are written.
inline constexpr std::size_t usual_cells_per_file = 2000000;

// Points, tets and all fields, values to the bit; time ("TimeValue", where ParaView looks for it), step, title and names
// of bodies as field data. Binary, zlib. A .vtu of more than cells_per_file cells (0: of any number) is written in pieces
// (pieces.hpp). Returns the file to open: the path, or the .pvtu of the pieces. Throws geom::InputError for a name that
// ends in neither, FileError when a file cannot be written.
std::string write_vtu(const Snapshot&, const std::string& path, std::size_t cells_per_file = 0);

// The triangles of the interfaces with mode, opening, slip, traction. The picture of a .vtu finds its bonds
// when they are written to bonds_path(path of the .vtu).
std::string write_bonds(const Snapshot&, const std::string& path, std::size_t cells_per_file = 0);
std::string bonds_path(const std::string& vtu_path); // "out/plate.vtu" -> "out/plate_bonds.vtu"

// The triangles of the bonds alone as a surface (.vtp; .vtu for programs that know no .vtp), as results/crack_surface
// makes them. Throws as write_vtu.
void write_surface(const Snapshot&, const std::string& path);

// Contacts as points with force (on the source), depth and who touches; time, step and title of the header. Throws as
// write_vtu.
std::string write_contacts(const std::vector<ContactPoint>&, const Snapshot& header, const std::string& path,
                           std::size_t cells_per_file = 0);
std::string contacts_path(const std::string& vtu_path); // "out/plate.vtu" -> "out/plate_contacts.vtu"

// The free surfaces of the snapshot's water as triangles: velocity at corners, and the number of its field, from 0, at
// triangles. Throws as write_vtu.
void write_water(const Snapshot&, const std::string& path);
std::string water_path(const std::string& vtu_path); // "out/plate.vtu" -> "out/plate_water.vtu"

struct SeriesEntry {
  double time = 0;       // s
  std::int64_t step = 0; // of all stages so far
  std::string file;      // as seen from the folder of the .pvd
};
// Along one axis: time, where it rises from file to file, else steps, else 1, 2, ...
void write_pvd(const std::string& path, const std::vector<SeriesEntry>&);

// The files that a .pvd lists, in its order, as seen from its folder. Throws FileError when there is no such file,
// geom::InputError when it is damaged, lists nothing, or names a file outside its folder.
std::vector<std::string> read_pvd(const std::string& path);

// A snapshot written by write_vtu, of pieces by their .pvtu, with its bonds when they are beside it. The surface and the block
// edges are found again from the tets and "block_id": the outside of each block, and the edges where that
// outside has a corner. Throws FileError when there is no such file,
// geom::InputError when it is damaged or not one of ours.
Snapshot read_vtu(const std::string& path);

} // namespace cdem
