#include "libcdem/model/names.hpp"

#include "libgeom/core/error.hpp"

#include <fmt/format.h>

namespace cdem {

std::string block_name(const Model& model, int block) {
  const int body = model.blocks[block].body;
  int unit = 0, units = 0;
  for (const Block& b : model.blocks)
    if (b.body == body) {
      ++units;
      unit += b.id <= model.blocks[block].id ? 1 : 0;
    }
  return units > 1 ? fmt::format("unit {} of \"{}\"", unit, model.bodies[body].name)
                   : fmt::format("\"{}\"", model.bodies[body].name);
}

void refuse_body(const std::string& field, const std::string& name, const Model& model) {
  std::string names;
  for (const Body& body : model.bodies)
    names += (names.empty() ? "\"" : ", \"") + body.name + "\"";
  throw geom::InputError(field, "\"" + name + "\"", "the name of a body (" + names + ")");
}

} // namespace cdem
