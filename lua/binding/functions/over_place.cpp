#include "lua/binding/functions/over_place.hpp"

#include "lua/binding/functions/answers.hpp"

namespace cdem::script {

std::function<double(const geom::Vec3&)> number_at_place(const std::shared_ptr<Reference>& function,
                                                         const std::string& field, const std::string& allowed,
                                                         double least) {
  return [function, field, allowed, least](const geom::Vec3& x) {
    return number_answered(*function, field, {x.x(), x.y(), x.z()}, allowed, least);
  };
}

} // namespace cdem::script
