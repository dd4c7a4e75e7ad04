#include "libcdem/vtk/pieces.hpp"

#include "libcdem/vtk/atomic_file.hpp"
#include "libcdem/vtk/checksum.hpp"
#include "libcdem/vtk/component_names.hpp"
#include "libcdem/vtk/listed_files.hpp"
#include "libcdem/vtk/xml_text.hpp"

#include <filesystem>
#include <fstream>
#include <set>

namespace cdem {

namespace fs = std::filesystem;

namespace {

void write_fields(std::ofstream& out, const char* place, const std::vector<SnapshotField>& fields) {
  out << "    <" << place << ">\n";
  for (const SnapshotField& field : fields) {
    out << "      <PDataArray type=\"" << (field.integer ? "Int64" : "Float64") << "\" Name=\""
        << xml_text(field.name) << "\" NumberOfComponents=\"" << field.components << '"';
    for (int c = 0; c < field.components; ++c)
      if (const std::string name = component_name(field, c); !name.empty())
        out << " ComponentName" << c << "=\"" << name << '"';
    out << "/>\n";
  }
  out << "    </" << place << ">\n";
}

} // namespace

std::size_t number_of_pieces(std::size_t cells, std::size_t limit) {
  return limit == 0 || cells == 0 ? 1 : (cells + limit - 1) / limit;
}

std::string list_of_pieces(const std::string& vtu_path) {
  return fs::path(vtu_path).replace_extension(".pvtu").string();
}

std::string piece_path(const std::string& vtu_path, std::size_t piece) {
  const fs::path path(vtu_path);
  const std::string stem = path.stem().string();
  return (path.parent_path() / stem / (stem + '_' + std::to_string(piece) + ".vtu")).string();
}

void write_list_of_pieces(const std::string& vtu_path, std::size_t pieces,
                          const std::vector<SnapshotField>& point_fields,
                          const std::vector<SnapshotField>& cell_fields) {
  const std::string path = list_of_pieces(vtu_path);
  AtomicFile file(path);
  std::ofstream out(file.temporary());
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" "
         "compressor=\"vtkZLibDataCompressor\">\n"
         "  <PUnstructuredGrid GhostLevel=\"0\">\n";
  write_fields(out, "PPointData", point_fields);
  write_fields(out, "PCellData", cell_fields);
  out << "    <PPoints>\n      <PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n    "
         "</PPoints>\n";
  for (std::size_t piece = 0; piece < pieces; ++piece)
    out << "    <Piece Source=\""
        << xml_text(fs::path(piece_path(vtu_path, piece))
                        .lexically_relative(fs::path(path).parent_path())
                        .generic_string())
        << "\"/>\n";
  out << "  </PUnstructuredGrid>\n</VTKFile>\n";
  out.close();
  if (!out || !add_checksum(file.temporary()))
    file.refuse();
  file.commit();
}

void remove_superseded(const std::string& vtu_path, std::size_t kept) {
  std::error_code ignored;
  const std::string list = list_of_pieces(vtu_path);
  if (kept > 0)
    fs::remove(vtu_path, ignored);
  if (!fs::exists(list, ignored))
    return;
  std::set<fs::path> stays;
  for (std::size_t piece = 0; piece < kept; ++piece)
    stays.insert(piece_path(vtu_path, piece));
  try {
    const fs::path folder = fs::path(list).parent_path();
    for (const std::string& file : listed_files(list, pieces_of_file))
      if (stays.count(folder / file) == 0)
        fs::remove(folder / file, ignored);
  } catch (const std::exception&) { // a list of another program: its pieces are not ours
    return;
  }
  if (kept == 0)
    fs::remove(list, ignored);
  fs::remove(fs::path(piece_path(vtu_path, 0)).parent_path(), ignored); // where it is empty
}

} // namespace cdem
