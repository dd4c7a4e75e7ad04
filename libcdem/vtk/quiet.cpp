#include "libcdem/vtk/quiet.hpp"

#include <vtkObject.h>

namespace cdem {

Quiet::Quiet() : before_(vtkObject::GetGlobalWarningDisplay()) {
  vtkObject::SetGlobalWarningDisplay(0);
}

Quiet::~Quiet() {
  vtkObject::SetGlobalWarningDisplay(before_);
}

} // namespace cdem
