// The share of a State that each of several ranks keeps: the entries of its own chunks. Arrays have their whole length
// on every rank, so that an entry has the same index everywhere. The pages of other ranks' entries are returned to the
// system.
//
// `parted` in a State says that it holds one share only, and which; gather makes it whole.
#pragma once

#include "libcdem/parallel/residency.hpp"
#include "libcdem/ranks/partition.hpp"
#include "libcdem/state/state.hpp"

#include <algorithm>
#include <initializer_list>
#include <utility>

namespace cdem {

// Where each rank's share of something begins that runs along the chunks of meshes.
template <class Begin>
std::vector<std::int64_t> along_mesh_chunks(const Model& model, const Partition& part, std::int64_t end,
                                            const Begin& begin) {
  std::vector<std::int64_t> at;
  for (const std::int64_t chunk : part.chunk_begin) {
    const std::int64_t c = std::max(chunk, part.stars) - part.stars;
    at.push_back(c < static_cast<std::int64_t>(model.mesh.chunks.size()) ? begin(model.mesh.chunks[c]) : end);
  }
  return at;
}

class StateShares {
public:
  StateShares(const Model&, const Partition&);

  // The first entry of each rank, and the end of the last one's.
  const std::vector<std::int64_t>& node_begin() const { return nodes_; }
  const std::vector<std::int64_t>& tet_begin() const { return tets_; }
  const std::vector<std::int64_t>& point_begin() const { return points_; }
  const std::vector<std::int64_t>& batch_begin() const { return batches_; }
  const std::vector<std::int64_t>& face_begin() const { return faces_; }

  Range own(const std::vector<std::int64_t>& begin) const { return {begin[rank_], begin[rank_ + 1]}; }
  Range nodes() const { return own(nodes_); }
  Range points() const { return own(points_); }
  const std::vector<Range>& kept_nodes() const { return kept_nodes_; } // own, and those of rigid bodies

  // All ranks call these together. Afterwards all have all, or rank 0 has, which `parted` does not say.
  void gather(State&) const;          // but contacts
  void gather_surfaces(State&) const; // where nodes are, and which bonds hold
  void gather_contacts(State&) const; // of rigid bodies: those of others all know
  void gather_on_lead(State&) const;
  // Since this was last asked, some State was filled with what others own.
  bool filled() const { return std::exchange(filled_, false); }
  // The same for arrays beside the State.
  template <class T>
  void gather_nodes(std::vector<T>& values) const {
    gather(values, nodes_);
  }
  template <class T>
  void gather_points(std::vector<T>& values) const {
    gather(values, points_);
  }
  template <class T>
  void gather_nodes_on_lead(std::vector<T>& values) const {
    gather_on_lead(values.data(), nodes_, values.size() * sizeof(T), sizeof(T));
  }
  template <class T>
  void gather_points_on_lead(std::vector<T>& values) const {
    gather_on_lead(values.data(), points_, values.size() * sizeof(T), sizeof(T));
  }

  // Gives back what others own, but the nodes of rigid bodies, which all ranks move.
  void release(State&) const;
  void release_motion(State&) const; // of displacements and velocities only
  // Copies the own share and all that is not shared. `from` is the same afterwards.
  void copy(State& from, State& to) const;
  // The own entries of an array beside the State.
  template <class T>
  static void copy(const std::vector<T>& from, std::vector<T>& to, Range own) {
    if (to.size() != from.size())
      to = std::vector<T>(from.size());
    release_outside(to, {own});
    if (!from.empty())
      std::copy(from.begin() + own.begin, from.begin() + own.end, to.begin() + own.begin);
  }

private:
  template <class T>
  void gather(std::vector<T>& values, const std::vector<std::int64_t>& begin, std::size_t entries = 1) const {
    gather(values.data(), begin, values.size() * sizeof(T), entries * sizeof(T));
  }
  void gather(void* data, const std::vector<std::int64_t>& begin, std::size_t bytes, std::size_t entry) const;
  void gather_on_lead(void* data, const std::vector<std::int64_t>& begin, std::size_t bytes,
                      std::size_t entry) const;
  void gather_slips(State&) const;
  bool is_told(const Contact&) const; // of two rigid bodies: a rank has its own only
  std::string own_contacts(const State&) const;
  void add_contacts(const std::vector<std::string>& told, State&) const;
  const std::vector<std::int64_t>& begin_of(FieldPlace) const;
  template <class Visit, class... S>
  void each_shared(std::initializer_list<FieldShared>, const Visit& visit, S&... states) const;
  template <class Visit, class... S>
  void each_motion(const Visit& visit, S&... states) const;
  template <class Visit, class... S>
  void each_large(const Visit& visit, S&... states) const;
  template <class Visit, class... S>
  void each_small(const Visit& visit, S&... states) const;

  int rank_ = 0, size_ = 1;
  std::vector<std::int64_t> nodes_, tets_, points_, batches_, faces_;
  mutable bool filled_ = false;   // the same on all ranks
  std::vector<char> is_rigid_;    // per triangle at which contacts act
  std::vector<Range> kept_nodes_; // own, and of rigid bodies; ascending
};

// Makes a State whole on all ranks, who call it together; one that is stays as it is.
void make_whole(State&);

} // namespace cdem
