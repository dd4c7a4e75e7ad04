// Files that an XML file of ours names: the steps of a series (.pvd), the pieces of a large file (.pvtu).
#pragma once

#include <string>
#include <vector>

namespace cdem {

struct FileList {
  const char *group, *entry, *attribute; // of the elements around and of each entry, and of the name in it
  const char* what;                      // "a series written by cdem", for messages
};
inline constexpr FileList steps_of_series{"Collection", "DataSet", "file", "a series written by cdem"},
    pieces_of_file{"PUnstructuredGrid", "Piece", "Source", "a .pvtu file written by cdem"};

// In their order, as seen from the folder of the list. Throws FileError when there is no such file, geom::InputError when it
// is damaged, lists nothing, or names a file outside its folder.
std::vector<std::string> listed_files(const std::string& path, const FileList&);

} // namespace cdem
