// Series of files as .pvd, along one axis: the model's time where every file has a later one than the file before, else
// the steps, which relaxations take too, else the files' order.
#include "libcdem/vtk/atomic_file.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/xml_text.hpp"

#include <cstdio>
#include <fstream>
#include <functional>

namespace cdem {
namespace {

using Place = std::function<double(std::size_t)>; // of a file on the axis

bool rises(std::size_t files, const Place& place) {
  for (std::size_t i = 1; i < files; ++i)
    if (!(place(i) > place(i - 1)))
      return false;
  return true;
}

} // namespace

void write_pvd(const std::string& path, const std::vector<SeriesEntry>& series) {
  require_extension(path, ".pvd");
  const Place time = [&](std::size_t i) { return series[i].time; };
  const Place step = [&](std::size_t i) { return static_cast<double>(series[i].step); };
  const bool by_time = rises(series.size(), time), by_step = !by_time && rises(series.size(), step);
  AtomicFile file(path);
  std::ofstream out(file.temporary());
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      << (by_time   ? "  <!-- timestep: time, s -->\n"
          : by_step ? "  <!-- timestep: steps so far -->\n"
                    : "  <!-- timestep: number of the file -->\n")
      << "  <Collection>\n";
  for (std::size_t i = 0; i < series.size(); ++i) {
    char place[32];
    std::snprintf(place, sizeof place, "%.17g",
                  by_time   ? time(i)
                  : by_step ? step(i)
                            : static_cast<double>(i + 1));
    out << "    <DataSet timestep=\"" << place << "\" group=\"\" part=\"0\" file=\""
        << xml_text(series[i].file) << "\"/>\n";
  }
  out << "  </Collection>\n</VTKFile>\n";
  out.close();
  if (!out)
    file.refuse();
  file.commit();
}

} // namespace cdem
