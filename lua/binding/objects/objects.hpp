// What a script holds of ours.
#pragma once

#include "lua/binding/schema/value.hpp"

#include "libcdem/simulation.hpp"

#include <optional>

namespace cdem::script {

struct MaterialObject final : Object {
  Elastic elastic;
  const char* class_name() const override { return "Material"; }
};

struct JointObject final : Object {
  Joint joint;
  const char* class_name() const override { return "Joint"; }
};

struct PlasticityObject final : Object {
  Plasticity plasticity;
  const char* class_name() const override { return "Plasticity"; }
};

struct AssemblyObject final : Object {
  geom::Assembly assembly;
  const char* class_name() const override { return "Assembly"; }
};

// cdem.select.*: a place that does not depend on a model.
struct SelectionObject final : Object {
  Selection selection;
  const char* class_name() const override { return "Selection"; }
};

} // namespace cdem::script
