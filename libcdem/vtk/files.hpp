// ParaView files of a snapshot: blocks as an unstructured grid of tets (.vtu, or .vtkhdf by the ending), interfaces as a
// second file of triangles beside it, a time series of both as a .pvd. Every file is written under a temporary name and
// renamed, so that a reader never sees half of one.
#pragma once

#include "libcdem/results/contact_points.hpp"
#include "libcdem/results/snapshot.hpp"

#include <string>
#include <vector>

namespace cdem {

// Points, tets and all fields, values to the bit; time ("TimeValue", where ParaView looks for it), step, title and names
// of bodies as field data. Binary, zlib. Throws geom::InputError for a name that ends in neither, FileError
// when the file cannot be written.
void write_vtu(const Snapshot&, const std::string& path);

// The triangles of the interfaces with mode, opening, slip, traction. The picture of a .vtu finds its bonds
// when they are written to bonds_path(path of the .vtu).
void write_bonds(const Snapshot&, const std::string& path);
std::string bonds_path(const std::string& vtu_path); // "out/plate.vtu" -> "out/plate_bonds.vtu"

// The triangles of the bonds alone as a surface (.vtp; .vtu for programs that know no .vtp), as results/crack_surface
// makes them. Throws as write_vtu.
void write_surface(const Snapshot&, const std::string& path);

// Contacts as points with force (on the source), depth and who touches; time, step and title of the header. Throws as
// write_vtu.
void write_contacts(const std::vector<ContactPoint>&, const Snapshot& header, const std::string& path);
std::string contacts_path(const std::string& vtu_path); // "out/plate.vtu" -> "out/plate_contacts.vtu"

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

// A snapshot written by write_vtu, with its bonds when bonds_path(path) is there. The surface and the block
// edges are found again from the tets and "block_id": the outside of each block, and the edges where that
// outside has a corner. Throws FileError when there is no such file,
// geom::InputError when it is damaged or not one of ours.
Snapshot read_vtu(const std::string& path);

} // namespace cdem
