#include "libcdem/vtk/listed_files.hpp"

#include "libcdem/vtk/file_error.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/quiet.hpp"
#include "libgeom/core/error.hpp"

#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <filesystem>

namespace cdem {
namespace {

[[noreturn]] void refuse(const std::string& path, const FileList& list, const std::string& what) {
  throw geom::InputError("file", '"' + path + '"', list.what, what);
}

// A list that somebody sends must not lead to files elsewhere.
bool is_inside(const std::filesystem::path& file) {
  if (file.empty() || file.is_absolute())
    return false;
  for (const auto& part : file)
    if (part == "..")
      return false;
  return true;
}

} // namespace

std::vector<std::string> listed_files(const std::string& path, const FileList& list) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw FileError('"' + path + "\" cannot be read: there is no such file");
  const Quiet quiet;
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  vtkXMLDataElement* group = root ? root->FindNestedElementWithName(list.group) : nullptr;
  if (group == nullptr)
    refuse(path, list, "it is none, or it is damaged");
  std::vector<std::string> files;
  for (int i = 0; i < group->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* entry = group->GetNestedElement(i);
    const char* const file = entry->GetAttribute(list.attribute);
    if (file == nullptr || std::string(entry->GetName()) != list.entry)
      continue;
    if (!is_inside(file))
      refuse(path, list, "it names \"" + std::string(file) + "\", outside its folder");
    files.emplace_back(file);
  }
  if (files.empty())
    refuse(path, list, "it lists no file");
  return files;
}

std::vector<std::string> read_pvd(const std::string& path) {
  return listed_files(path, steps_of_series);
}

} // namespace cdem
