// A pillar of jointed blocks shortens under a pressure p by p H / E in the rock and by p L / E in each joint,
// H the pillar's height and L the joints' equivalent thickness.
#include <libcdem/simulation.hpp>
#include <libgeom/assembly/builders.hpp>

#include <cmath>
#include <cstdio>

int main() {
  const double height = 4, pressure = 1e6; // m, Pa
  const int layers = 8;

  cdem::Elastic rock;
  rock.youngs_modulus = 30e9;
  rock.poissons_ratio = 0.25;
  rock.density = 2500;
  cdem::Joint joint;
  joint.cohesion = 8e6;
  joint.friction_angle = 30 * M_PI / 180;
  joint.tensile_strength = 5e6;
  joint.thickness = 0.01;
  const geom::Assembly blocks = geom::grid({1, 1, height}, {2, 2, layers});

  cdem::Simulation model({{{"pillar", blocks, rock, joint}}}, 1, nullptr);
  model.fix({cdem::Selection::side("x-"), {true, false, false}});
  model.fix({cdem::Selection::side("y-"), {false, true, false}});
  model.fix({cdem::Selection::side("z-"), {false, false, true}});
  model.traction({cdem::Selection::side("z+"), {0, 0, -pressure}});
  model.relax({1e-9});

  const double shortening = -model.mean("displacement.z", cdem::Selection::side("z+"));
  const double formula = pressure / rock.youngs_modulus * (height + (layers - 1) * *joint.thickness);
  std::printf("shortening %.6g m, formula %.6g m\n", shortening, formula);
  return std::abs(shortening / formula - 1) < 1e-4 ? 0 : 1;
}
