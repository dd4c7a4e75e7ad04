// Names of the components of a field in VTK's files.
#pragma once

#include "libcdem/results/snapshot.hpp"

namespace cdem {

// "" where it has none.
inline std::string component_name(const SnapshotField& field, int component) {
  const char* const vector_names[] = {"x", "y", "z"};
  const char* const tensor_names[] = {"XX", "YY", "ZZ", "XY", "YZ", "XZ"}; // ParaView's symmetric tensor
  const char* const principal_names[] = {"1", "2", "3"};
  if (field.components == 3)
    return (field.name.find("principal") != std::string::npos ? principal_names : vector_names)[component];
  return field.components == 6 ? tensor_names[component] : "";
}

} // namespace cdem
