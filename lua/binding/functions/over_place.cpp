#include "lua/binding/functions/over_place.hpp"

#include "lua/binding/functions/solving_warnings.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>

namespace cdem::script {

std::function<double(const geom::Vec3&)> number_at_place(const std::shared_ptr<Reference>& function,
                                                         const std::string& field, const std::string& allowed,
                                                         double least) {
  return [function, field, allowed, least](const geom::Vec3& x) {
    const Values answer = function->call({x.x(), x.y(), x.z()});
    if (answer.empty() || !answer[0].is_number() || !std::isfinite(answer[0].number()) ||
        !(answer[0].number() >= least))
      throw geom::InputError(field + place_text(x) + " of " + function->place(),
                             answer.empty() ? "nothing" : describe(answer[0]), allowed);
    return answer[0].number();
  };
}

} // namespace cdem::script
