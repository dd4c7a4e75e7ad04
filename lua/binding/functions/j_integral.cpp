// The energy release rate at the front of a crack.
#include "lua/binding/module/module.hpp"
#include "lua/binding/session/model_object.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;
using geom::Vec3;

Value j_integral(Session&, ModelObject& model, const Arguments& a) {
  JFront front;
  front.point = a.vec3("point");
  front.front = a.vec3("front");
  if (!(front.front.norm() > 0))
    throw InputError("front", describe(a.value("front")), "longer than zero");
  front.front.normalize();
  const Vec3 growth = a.vec3("growth"), square = growth - growth.dot(front.front) * front.front;
  if (!(square.norm() > 0.1 * growth.norm()))
    throw InputError("growth", describe(a.value("growth")), "square to the front",
                     "it is where the crack would go on");
  front.growth = square.normalized();
  std::vector<JDomain> domains;
  for (const double outer : a.numbers("radii")) {
    if (!(outer > 0))
      throw InputError("radii", describe(a.value("radii")), "above 0");
    domains.push_back({a.number("inner") * outer, outer, 0});
  }
  const std::string body = a.text_or("body", "");
  const JIntegral found = model.simulation.j_integral(body, front, domains);
  Values rows;
  for (const JDomain& domain : found.domains)
    rows.emplace_back(Table{{"inner", domain.inner}, {"outer", domain.outer}, {"j", domain.j}});
  const double j = found.mean();
  Table result{{"j", j},
               {"spread", found.spread()},
               {"thickness", found.thickness},
               {"domains", Table::list(std::move(rows))}};
  const Elastic& material = model.simulation.material(body.empty() ? model.body_names[0] : body);
  const double nu = material.poissons_ratio, k2 = j * material.youngs_modulus;
  if (j >= 0) {
    result.named["k_plane_stress"] = std::sqrt(k2);
    result.named["k_plane_strain"] = std::sqrt(k2 / (1 - nu * nu));
  }
  return result;
}

} // namespace

void bind_j_integral(Module& m) {
  m.records.push_back(
      {"JIntegral",
       "Energy release rate at a crack front.",
       {number("j").unit("J/m2").required().doc("mean over the domains"),
        number("spread").required().doc("largest less smallest of the domains, over the mean"),
        number("thickness").unit("m").required().doc("length of the front"),
        list("domains",
             record_type({number("inner").unit("m").required(), number("outer").unit("m").required(),
                          number("j").unit("J/m2").required()}))
            .required(),
        number("k_plane_stress").unit("Pa m^0.5").doc("sqrt(E j); nil where j < 0"),
        number("k_plane_strain").unit("Pa m^0.5").doc("sqrt(E j / (1 - nu^2)); nil where j < 0")}});
  m.the_class("Model").add(
      "j_integral",
      "Energy release rate at a straight crack front or notch of a meshed body, the mean over its thickness "
      "(J integral over domains of tetrahedra). The body must be at rest at small strain, the crack faces "
      "free, flat and parallel to the growth, without supports, loads, contacts and bonds in the domain; "
      "anything else is refused.",
      {vec3("point").unit("m").required().doc("anywhere on the front, undeformed"),
       vec3("front").required().doc("direction of the front, through the thickness"),
       vec3("growth").required().doc("where the crack would go on, square to the front"),
       list("radii", number_type())
           .unit("m")
           .required()
           .doc("outer radii of the domains, about the front; several show whether they agree"),
       number("inner").from(0, 1).standard(0.5).doc(
           "inner radius over the outer one; a blunt notch must lie within it"),
       text("body").doc("with the crack; the only one when left out")},
      j_integral, "cdem.JIntegral");
}

} // namespace cdem::script
