#include "libcdem/bond/water_work.hpp"

#include "libcdem/bond/interface_frame.hpp"

namespace cdem {

double water_work(const Model& model, const State& state, const Interface& interface) {
  double work = 0;
  if (!state.water_pressure.empty())
    for (int p = interface.point_begin; p < interface.point_end; ++p)
      if (state.water_pressure[p] > 0)
        work += state.water_pressure[p] * model.points[p].area *
                local_jump(model, state.displacement, p).dot(model.points[p].normal);
  return work;
}

double water_work(const Model& model, const State& state) {
  double work = 0;
  if (!state.water_pressure.empty())
    for (const Interface& interface : model.interfaces)
      work += water_work(model, state, interface);
  return work;
}

} // namespace cdem
