#include "libcdem/ranks/looks.hpp"

#include "libcdem/ranks/ranks.hpp"
#include "libgeom/core/error.hpp"

namespace cdem {
namespace {

const char* name_of(char look) {
  switch (static_cast<Look>(look)) {
  case Look::ended:
    return "ended its callback";
  case Look::state:
    return "looks at the state";
  case Look::state_on_rank_0:
    return "saves or draws the state";
  case Look::surface:
    return "draws a picture";
  }
  return "does something else";
}

} // namespace

void agree_on_look(Look look) {
  const std::vector<std::string> looks =
      ranks().gather(std::string(1, static_cast<char>(look)), Ranks::Subject::looks);
  for (std::size_t rank = 1; rank < looks.size(); ++rank)
    if (looks[rank] != looks[0])
      throw geom::InputError("a callback goes another way on rank " + std::to_string(rank) + ", which " +
                             name_of(looks[rank][0]) + " where rank 0 " + name_of(looks[0][0]) +
                             "; a script must do the same on all ranks");
}

} // namespace cdem
