// Debian's VTK opens X windows only. This window needs no display at all: an OpenGL 3.2 core context on
// Mesa's surfaceless EGL platform with a small pbuffer; VTK draws into its own frame buffer and we read that.
#include "libcdem/vtk/offscreen.hpp"

#include "libcdem/vtk/picture.hpp"
#include "libcdem/vtk/picture_room.hpp"

#include "libgeom/core/error.hpp"

#include <vtk_glew.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <vtkAutoInit.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPNGWriter.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkUnsignedCharArray.h>

#include <stdexcept>

VTK_MODULE_INIT(vtkRenderingOpenGL2);
VTK_MODULE_INIT(vtkRenderingFreeType);

namespace cdem {
namespace {

[[noreturn]] void no_opengl(const std::string& what) {
  throw std::runtime_error("pictures need off-screen OpenGL (EGL of Mesa), but " + what +
                           "; install libegl1, libegl-mesa0 and libgl1-mesa-dri");
}

class SurfacelessWindow : public vtkGenericOpenGLRenderWindow {
public:
  static SurfacelessWindow* New();
  vtkTypeMacro(SurfacelessWindow, vtkGenericOpenGLRenderWindow);

  void Initialize() override {
    if (context_)
      return;
    const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        reinterpret_cast<void*>(eglGetProcAddress("eglGetPlatformDisplayEXT")));
    if (!get_display)
      no_opengl("EGL has no platform displays");
    display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr))
      no_opengl("the surfaceless display does not start");
    const EGLint config_wanted[] = {EGL_SURFACE_TYPE,
                                    EGL_PBUFFER_BIT,
                                    EGL_RENDERABLE_TYPE,
                                    EGL_OPENGL_BIT,
                                    EGL_RED_SIZE,
                                    8,
                                    EGL_GREEN_SIZE,
                                    8,
                                    EGL_BLUE_SIZE,
                                    8,
                                    EGL_NONE};
    EGLConfig config = nullptr;
    EGLint found = 0;
    if (!eglChooseConfig(display_, config_wanted, &config, 1, &found) || found == 0)
      no_opengl("no frame buffer format fits");
    const EGLint context_wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     3,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     2,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
    const EGLint surface_wanted[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
    eglBindAPI(EGL_OPENGL_API);
    EGLContext context = eglCreateContext(display_, config, EGL_NO_CONTEXT, context_wanted);
    surface_ = eglCreatePbufferSurface(display_, config, surface_wanted);
    if (context == EGL_NO_CONTEXT || surface_ == EGL_NO_SURFACE ||
        !eglMakeCurrent(display_, surface_, surface_, context))
      no_opengl("it gives no OpenGL 3.2 context");
    context_ = context;
    OpenGLInit();
  }
  void MakeCurrent() override {
    if (context_)
      eglMakeCurrent(display_, surface_, surface_, context_);
  }
  void LetGo() { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
  bool IsCurrent() override { return context_ && eglGetCurrentContext() == context_; }
  // The context lives as long as the process: eglTerminate would take it from everybody else who uses this
  // display.
  void Finalize() override {}
  void Render() override {
    Initialize();
    MakeCurrent();
    Superclass::Render();
  }
  void OpenGLInitContext() override {
    if (Initialized)
      return;
    glewExperimental = GL_TRUE;
    const GLenum status = glewInit();
    // Debian's GLEW is the GLX build: it loads every function and then reports 4, "no GLX display".
    if (status != GLEW_OK && status != 4)
      no_opengl("its functions cannot be loaded");
    GlewInitValid = true;
    Initialized = true;
  }
  int SupportsOpenGL() override { return 1; }
  vtkTypeBool IsDirect() override { return 0; }

private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLSurface surface_ = EGL_NO_SURFACE;
  EGLContext context_ = EGL_NO_CONTEXT;
};
vtkStandardNewMacro(SurfacelessWindow);

// Kept for the whole process, so that shaders are compiled once; never destroyed, because VTK's and Mesa's
// own statics may be gone by then.
SurfacelessWindow& window() {
  static SurfacelessWindow* const the_window = [] {
    SurfacelessWindow* w = SurfacelessWindow::New();
    w->SetOffScreenRendering(1);
    w->SetFrameBlitModeToNoBlit();
    w->SwapBuffersOff();
    w->SetMultiSamples(4);
    w->SetDPI(72);
    return w;
  }();
  return *the_window;
}

// Takes the renderers out again whatever happens, so that the window is clean for the next picture.
class Layers {
public:
  explicit Layers(const std::vector<vtkRenderer*>& layers) : layers_(layers) {
    // An empty renderer over the whole picture lays the white ground.
    layers_.insert(layers_.begin(), ground_);
    window().SetNumberOfLayers(static_cast<int>(layers_.size()));
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      layers_[i]->SetLayer(static_cast<int>(i));
      layers_[i]->SetBackground(1, 1, 1);
      window().AddRenderer(layers_[i]);
    }
  }
  ~Layers() {
    for (vtkRenderer* layer : layers_)
      window().RemoveRenderer(layer);
    window().LetGo();
  }
  Layers(const Layers&) = delete;
  Layers& operator=(const Layers&) = delete;

private:
  vtkNew<vtkRenderer> ground_;
  std::vector<vtkRenderer*> layers_;
};

// An empty picture of a few pixels takes the place of the large one; the context and the shaders stay.
void give_buffers_back() {
  constexpr int few = 16;
  const Layers nothing({});
  vtkNew<vtkUnsignedCharArray> pixels;
  window().SetSize(few, few);
  window().Render();
  window().GetPixelData(0, 0, few - 1, few - 1, 0, pixels.Get(), 0);
  forget_kept_pixels();
}

bool buffers_are_kept = false; // of a picture, for the next one

std::string drawn(const std::array<int, 2>& size, const std::vector<vtkRenderer*>& layers) {
  constexpr int n = supersampling;
  const int width = size[0], height = size[1];
  require_room_for_picture(size);
  window().Initialize();
  window().MakeCurrent();
  vtkNew<vtkUnsignedCharArray> fine;
  {
    const Layers guard(layers);
    window().SetSize(n * width, n * height);
    window().Render();
    window().GetPixelData(0, 0, n * width - 1, n * height - 1, 0, fine.Get(), 0);
  }
  vtkNew<vtkImageData> image;
  image->SetDimensions(width, height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* out = static_cast<unsigned char*>(image->GetScalarPointer());
  const unsigned char* in = fine->GetPointer(0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        int sum = n * n / 2; // rounds
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i)
            sum += in[3 * (static_cast<std::ptrdiff_t>(n * y + j) * n * width + n * x + i) + c];
        *out++ = static_cast<unsigned char>(sum / (n * n));
      }
  vtkNew<vtkPNGWriter> writer;
  writer->WriteToMemoryOn(); // libpng would print what goes wrong with a file
  writer->SetInputData(image);
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)),
          static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

} // namespace

void check_picture_size(const std::array<int, 2>& size) {
  for (const int side : size)
    if (side < least_picture_side || side > most_picture_side)
      throw geom::InputError("size", "{" + std::to_string(size[0]) + ", " + std::to_string(size[1]) + "}",
                             "between " + std::to_string(least_picture_side) + " and " +
                                 std::to_string(most_picture_side) + " pixels");
}

std::array<double, 4> viewport_of(const Rect& frame, const std::array<int, 2>& size) {
  return {frame.left / size[0], frame.bottom / size[1], frame.right() / size[0], frame.top() / size[1]};
}

std::string png_of(const std::array<int, 2>& size, const std::vector<vtkRenderer*>& layers) {
  buffers_are_kept = true;
  return drawn(size, layers);
}

std::string flat_png_of(const std::array<int, 2>& size, const std::vector<vtkRenderer*>& layers) {
  std::string png = drawn(size, layers);
  if (!buffers_are_kept)
    give_buffers_back();
  return png;
}

} // namespace cdem
