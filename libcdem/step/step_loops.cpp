#include "libcdem/step/step_loops.hpp"

#include "libcdem/parallel/exact_sum.hpp"

#include <algorithm>
#include <array>
#include <iterator>

namespace cdem {
namespace {

constexpr double NodeSums::*members[] = {&NodeSums::residual2, &NodeSums::applied2, &NodeSums::reaction2,
                                         &NodeSums::stiffness, &NodeSums::inertia,  &NodeSums::kinetic,
                                         &NodeSums::external,  &NodeSums::damping,  &NodeSums::radiated};
constexpr std::size_t n_members = std::size(members);
static_assert(n_members * sizeof(double) == sizeof(NodeSums), "all of them are summed");

} // namespace

NodeSums sums_of(const Workspace& work, std::int64_t& tellers) {
  const Range own =
      work.shared ? work.shared->part().chunks() : Range{0, static_cast<std::int64_t>(work.node_sums.size())};
  using Exact = ExactSums<n_members>;
  Exact exact;
  const auto add = [&](const NodeSums& sums) {
    for (std::size_t i = 0; i < n_members; ++i)
      if (const double x = sums.*members[i]; x != 0)
        exact.add(i, x);
  };
  for (std::int64_t c = own.begin; c < own.end; ++c)
    add(work.node_sums[c]);
  for (int rigid = 0; rigid < static_cast<int>(work.rigid_sums.size()); ++rigid)
    if (!work.shared || work.shared->moves(rigid))
      add(work.rigid_sums[rigid]);
  if (work.shared) {
    std::array<std::int64_t, Exact::size() + 1> told;
    std::copy_n(exact.data(), Exact::size(), told.begin());
    told.back() = tellers;
    ranks().sum(told.data(), told.size());
    std::copy_n(told.begin(), Exact::size(), exact.data());
    tellers = told.back();
  }
  NodeSums sum;
  for (std::size_t i = 0; i < n_members; ++i)
    sum.*members[i] = exact.value(i);
  return sum;
}

} // namespace cdem
