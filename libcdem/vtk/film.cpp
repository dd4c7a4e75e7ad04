#include "libcdem/vtk/film.hpp"

#include "libcdem/vtk/atomic_file.hpp"
#include "libcdem/vtk/quiet.hpp"
#include "libgeom/core/error.hpp"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkOggTheoraWriter.h>
#include <vtkPNGReader.h>

#include <array>
#include <filesystem>

namespace cdem {

void write_film(const std::vector<std::string>& png_frames, int frames_per_second,
                const std::string& ogv_path) {
  require_extension(ogv_path, ".ogv");
  if (png_frames.empty())
    throw geom::InputError("frames", "none", "at least one picture");
  if (frames_per_second < 1 || frames_per_second > 120)
    throw geom::InputError("frames_per_second", std::to_string(frames_per_second), "between 1 and 120");
  AtomicFile file(ogv_path);
  const Quiet quiet;
  vtkNew<vtkOggTheoraWriter> writer;
  writer->SetFileName(file.temporary().c_str());
  writer->SetRate(frames_per_second);
  writer->SetQuality(2);
  std::array<int, 3> size{0, 0, 0};
  bool started = false;
  const auto refuse = [&](const std::string& frame, const std::string& allowed) {
    if (started)
      writer->End();
    throw geom::InputError("frames", '"' + frame + '"', allowed);
  };
  for (const std::string& frame : png_frames) {
    vtkNew<vtkPNGReader> reader;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(frame, ignored) || !reader->CanReadFile(frame.c_str()))
      refuse(frame, "a PNG picture that exists");
    reader->SetFileName(frame.c_str());
    reader->Update();
    vtkImageData* image = reader->GetOutput();
    std::array<int, 3> dimensions;
    image->GetDimensions(dimensions.data());
    if (image->GetNumberOfScalarComponents() != 3 || image->GetScalarType() != VTK_UNSIGNED_CHAR)
      refuse(frame, "a picture with 8-bit red, green and blue");
    if (started && dimensions != size)
      refuse(frame,
             std::to_string(size[0]) + " x " + std::to_string(size[1]) + " pixels like the frames before it");
    writer->SetInputData(image);
    if (!started) {
      size = dimensions;
      writer->Start();
      started = true;
    }
    writer->Write();
  }
  writer->End();
  if (writer->GetError() != 0)
    file.refuse();
  file.commit();
}

} // namespace cdem
