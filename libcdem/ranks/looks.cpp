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
  const int rank = ranks().rank();
  const char own = looks[static_cast<std::size_t>(rank)][0], first = looks[0][0];
  if (own != first)
    throw geom::InputError("a callback goes another way on rank " + std::to_string(rank) + ", which " +
                           name_of(own) + " where rank 0 " + name_of(first) +
                           "; a script must do the same on all ranks");
}

} // namespace cdem
