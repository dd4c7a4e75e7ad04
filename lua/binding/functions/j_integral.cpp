// The energy release rate at the front of a crack.
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/model_object.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;
using geom::Vec3;

struct JFound : JIntegral {
  Elastic material;

  // Pa m^0.5, with a Young's modulus.
  std::optional<double> toughness(double modulus) const {
    return mean() >= 0 ? std::optional<double>(std::sqrt(mean() * modulus)) : std::nullopt;
  }
};

const Record<JDomain> domain_record{{{number("inner", "m").required(), &JDomain::inner},
                                     {number("outer", "m").required(), &JDomain::outer},
                                     {number("j", "J/m2").required(), &JDomain::j}}};

const Record<JFound> j_record{
    "JIntegral",
    "Energy release rate at a crack front.",
    {{number("j", "J/m2").doc("mean over the domains"), &JFound::mean},
     {number("spread").doc("largest less smallest of the domains, over the mean"), &JFound::spread},
     {number("thickness", "m").doc("length of the front"), &JFound::thickness},
     {list("domains", record_type(domain_record.fields())), &JFound::domains, domain_record},
     {number("k_plane_stress", "Pa m^0.5").doc("sqrt(E j); nil where j < 0"),
      [](const JFound& f) { return f.toughness(f.material.youngs_modulus); }},
     {number("k_plane_strain", "Pa m^0.5").doc("sqrt(E j / (1 - nu^2)); nil where j < 0"),
      [](const JFound& f) {
        const double nu = f.material.poissons_ratio;
        return f.toughness(f.material.youngs_modulus / (1 - nu * nu));
      }}}};

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
  const Elastic& material = model.simulation.material(body.empty() ? model.body_names[0] : body);
  return j_record({found, material});
}

} // namespace

void bind_j_integral(Module& m) {
  m.records.push_back(j_record);
  m.the_class("Model").add(
      "j_integral",
      "Energy release rate at a straight crack front or notch of a meshed body, the mean over its thickness "
      "(J integral over domains of tetrahedra). The body must be at rest at small strain, the crack faces "
      "free, flat and parallel to the growth, without supports, loads, contacts and bonds in the domain; "
      "anything else is refused.",
      {vec3("point", "m").required().doc("anywhere on the front, undeformed"),
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
