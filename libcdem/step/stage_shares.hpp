// The share of this rank in a stage among several: which chunks are whose, who keeps what of the State. One rank alone has
// everything.
#pragma once

#include "libcdem/step/soundness.hpp"
#include "libcdem/step/stage_context.hpp"
#include "libcdem/step/workspace.hpp"

#include <exception>

namespace cdem {

class StageShares {
public:
  StageShares(const StageContext&, Workspace&);

  // moving: the velocities that loads depend on; null: they depend on none.
  void share(const std::vector<Node>* moving);
  // Counts the loads of the ranks, which all do so together. True where another share would make them more even.
  bool count_loads();
  // Shares the chunks anew. Each rank has all of the state by then, and all springs.
  void share_anew(const std::vector<Node>* moving, const StageStep&);
  void give_back();                              // memory of what other ranks own
  void loads_are_whole() { gave_back_ = false; } // the workspace's loads are those of all ranks again
  void gather(BondWork&) const;

  // An error has ended the stage.
  bool has_failed() const { return std::uncaught_exceptions() > exceptions_; }
  // An error that the other ranks, which are elsewhere, do not have.
  bool left_alone() const { return has_failed() && !ranks().all_fail(Ranks::patience); }
  void add_to(Progress&) const; // loads of the ranks, and how often they were shared anew

private:
  void warn_of_idle() const;

  const StageContext& context_;
  Workspace& work_;
  bool gave_back_ = false; // since it was last shared
  int shared_anew_ = 0;    // how often
  std::string loads_;      // when they were last counted
  int exceptions_ = std::uncaught_exceptions();
};

} // namespace cdem
