#include "libcdem/vtk/film.hpp"

#include "libcdem/vtk/atomic_file.hpp"
#include "libcdem/vtk/ffmpeg.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libcdem/vtk/quiet.hpp"
#include "libgeom/core/error.hpp"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkOggTheoraWriter.h>
#include <vtkPNGReader.h>
#include <vtkSmartPointer.h>

#include <array>
#include <filesystem>

namespace cdem {

namespace {

bool ends_with(const std::string& path, const char* ending) {
  const std::string end = ending;
  return path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0;
}

[[noreturn]] void refuse(const std::string& frame, const std::string& allowed) {
  throw geom::InputError("frames", '"' + frame + '"', allowed);
}

// Throws of a frame that is no picture, or of another size than those before.
vtkSmartPointer<vtkImageData> read_frame(const std::string& frame, std::array<int, 3>& size) {
  vtkNew<vtkPNGReader> reader;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(frame, ignored) || !reader->CanReadFile(frame.c_str()))
    refuse(frame, "a PNG picture that exists");
  reader->SetFileName(frame.c_str());
  reader->Update();
  vtkSmartPointer<vtkImageData> image = reader->GetOutput();
  std::array<int, 3> dimensions;
  image->GetDimensions(dimensions.data());
  if (image->GetNumberOfScalarComponents() != 3 || image->GetScalarType() != VTK_UNSIGNED_CHAR)
    refuse(frame, "a picture with 8-bit red, green and blue");
  if (size[0] > 0 && dimensions != size)
    refuse(frame,
           std::to_string(size[0]) + " x " + std::to_string(size[1]) + " pixels like the frames before it");
  size = dimensions;
  return image;
}

void write_theora(const std::vector<std::string>& frames, int frames_per_second, AtomicFile& file) {
  const Quiet quiet;
  vtkNew<vtkOggTheoraWriter> writer;
  writer->SetFileName(file.temporary().c_str());
  writer->SetRate(frames_per_second);
  writer->SetQuality(2);
  std::array<int, 3> size{0, 0, 0};
  bool started = false;
  try {
    for (const std::string& frame : frames) {
      const auto image = read_frame(frame, size);
      writer->SetInputData(image);
      if (!started)
        writer->Start();
      started = true;
      writer->Write();
    }
  } catch (...) {
    if (started)
      writer->End();
    throw;
  }
  writer->End();
  if (writer->GetError() != 0)
    file.refuse();
}

} // namespace

void write_film(const std::vector<std::string>& png_frames, int frames_per_second, const std::string& path) {
  const bool mp4 = ends_with(path, ".mp4");
  if (!mp4)
    require_extension(path, ".ogv");
  if (png_frames.empty())
    throw geom::InputError("frames", "none", "at least one picture");
  if (frames_per_second < 1 || frames_per_second > 120)
    throw geom::InputError("frames_per_second", std::to_string(frames_per_second), "between 1 and 120");
  if (mp4 && !has_ffmpeg())
    throw geom::InputError(
        "file", '"' + path + '"',
        "a name that ends in .ogv: .mp4 is written by ffmpeg, which is not installed here");
  AtomicFile file(path);
  if (mp4) {
    std::array<int, 3> size{0, 0, 0};
    for (const std::string& frame : png_frames)
      read_frame(frame, size);
    const std::string wrong = write_with_ffmpeg(png_frames, frames_per_second, file.temporary());
    if (!wrong.empty())
      throw FileError(path + " cannot be written by ffmpeg: " + wrong);
  } else {
    write_theora(png_frames, frames_per_second, file);
  }
  file.commit();
}

} // namespace cdem
