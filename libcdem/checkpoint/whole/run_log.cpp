// Whether the log and the restart point of a run are whole beside their Model.
#include "libcdem/checkpoint/require_whole.hpp"
#include "libcdem/checkpoint/whole/checks.hpp"

#include "libcdem/results/cracks.hpp"
#include "libcdem/state/state.hpp"

#include <limits>

namespace cdem {

using namespace whole;

namespace {

bool is_support_quantity(const Model& model, const Probe& probe) {
  const bool axis =
      probe.crack.size() > 2 && probe.crack.find_first_of("xyz", probe.crack.size() - 1) != std::string::npos;
  const std::string quantity = axis ? probe.crack.substr(0, probe.crack.size() - 2) : "";
  const auto named = [&](const Body& body) { return body.name == probe.on; };
  const bool side = probe.on.size() == 2 && probe.on[0] >= 'x' && probe.on[0] <= 'z' &&
                    (probe.on[1] == '-' || probe.on[1] == '+');
  const bool body = std::any_of(model.bodies.begin(), model.bodies.end(), named);
  return (quantity == "reaction" && (side || body)) || (quantity == "momentum" && body && probe.body >= 0);
}

} // namespace

void require_whole(const Model& model, const RunLog& log) {
  for (const BreakRow& row : log.breaks)
    require(row.mode == BondMode::broken_tension || row.mode == BondMode::broken_shear, "breaks.mode",
            static_cast<int>(row.mode));
  for (const Probe& probe : log.probes)
    if (!probe.crack.empty() || !probe.on.empty()) {
      const auto& known = crack_quantities();
      require(probe.on.empty() ? std::find(known.begin(), known.end(), probe.crack) != known.end()
                               : is_support_quantity(model, probe),
              "probes.crack", 0);
      require(probe.body >= -1 && probe.body < count(model.bodies.size()), "probes.body", probe.body);
    }
  for (const HistoryRow& row : log.history)
    require(row.probes.size() <= log.probes.size(), "history.probes", count(row.probes.size()));
  for (const Watch& watch : log.watches) {
    all_below("watches.blocks", watch.blocks, model.blocks.size());
    require_length("watches.touched", watch.touched.size(), watch.blocks.size());
    require_length("watches.numbers", watch.numbers.size(), watch.blocks.size());
    for (const auto& touched : watch.touched)
      all_below("watches.touched", touched, model.blocks.size());
    require_length("watches.start", watch.start.size(), model.blocks.size());
    require_length("watches.gone", watch.gone.size(), model.blocks.size());
    std::size_t tets = 0; // of units that can break
    for (const int block : watch.blocks)
      if (!model.bodies[model.blocks[block].body].bonding.none())
        tets += static_cast<std::size_t>(model.blocks[block].tet_end - model.blocks[block].tet_begin);
    require_length("watches.tet_start", watch.tet_start.size(), tets);
    require_length("watches.tet_left", watch.tet_left.size(), tets);
    for (const Departure& departure : watch.left)
      require(std::count(watch.numbers.begin(), watch.numbers.end(), departure.unit) == 1, "watches.left",
              departure.unit);
  }
  for (const auto& pair : log.unmet)
    all_below("unmet", pair, model.bodies.size());
  require(log.every >= 1, "every", log.every);
}

void require_whole(const Model& model, const RunLog& log, const RestartPoint& point) {
  const auto length = [](const char* field, std::size_t size, std::size_t wanted) {
    if (size != 0)
      require_length(field, size, wanted);
  };
  require(point.step >= 0, "restart.step", point.step);
  require(point.breaks <= log.breaks.size(), "restart.breaks", count(point.breaks));
  if (!(point.contact_step >= 0 && point.contact_step < std::numeric_limits<double>::infinity()))
    refuse("restart.contact_step", std::to_string(point.contact_step) + " is out of range");
  if (!(point.strain_step >= 0 && point.strain_step < std::numeric_limits<double>::infinity()))
    refuse("restart.strain_step", std::to_string(point.strain_step) + " is out of range");
  all_below("restart.slid", point.slid, model.interfaces.size());
  for (const FlowPatterns::OfFlow& flow : point.flows.flows) {
    for (const auto& [node, force] : flow.forces)
      all_below("restart.flows", std::array{node}, model.node_position.size());
    for (const FlowCorner& corner : flow.corners)
      all_below("restart.flows", std::array{corner.node}, model.node_position.size());
    for (const AskedWater& asked : flow.asked) {
      all_below("restart.flows", std::array{asked.block}, model.blocks.size());
      const Block& block = model.blocks[asked.block];
      require(asked.first_node == block.node_begin, "restart.flows", asked.first_node);
      require_length("restart.flows", asked.nodes.size(),
                     static_cast<std::size_t>(block.node_end - block.node_begin));
      const auto require_own = [&](int node) {
        require(node >= block.node_begin && node < block.node_end, "restart.flows", node);
      };
      for (const CrackSide& side : asked.cracks) {
        require(side.block == asked.block, "restart.flows", side.block);
        std::for_each(side.nodes.begin(), side.nodes.end(), require_own);
      }
      for (const auto& [face, parted] : asked.bared) {
        require(face.block == asked.block, "restart.flows", face.block);
        require(face.face >= 0 && face.face < static_cast<int>(block.shape.faces.size()), "restart.flows",
                face.face);
        for (const auto& [node, area] : face.node_area)
          require_own(node);
      }
    }
    require(flow.corners.size() <= flow.forces.size(), "restart.flows", count(flow.corners.size()));
  }
  length("restart.near", point.near.size(), model.mesh.batches.size());
  for (const std::vector<Node>& of_nodes : point.carried)
    length("restart.carried", of_nodes.size(), model.node_position.size());
  length("restart.spring_force", point.spring_force.size(), model.points.size());
  length("restart.stretch", point.stretch.size(), model.points.size());
  length("restart.viscous", point.viscous.size(), model.points.size());
}

} // namespace cdem
