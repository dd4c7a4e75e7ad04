#include "libcdem/step/share_sums.hpp"

#include "libcdem/ranks/bytes.hpp"

#include <algorithm>

namespace cdem {
namespace {

bool is_zero(const FaceSums& sums) {
  return sums.friction == 0 && sums.breaking == 0 && sums.damping == 0 && sums.plastic == 0 &&
         sums.crack.tension == 0 && sums.crack.shear == 0 && sums.broken.empty() && sums.astray < 0 &&
         !sums.hands_over;
}

bool is_zero(const SpringSums& sums) {
  return sums.friction == 0 && sums.breaking == 0 && sums.damping == 0 && sums.broken.empty() &&
         sums.losses.empty();
}

// act on each member, the same for writing and reading.
template <class Sums, class Act>
void each_member(Sums& sums, Act& act) {
  act(sums.friction);
  act(sums.breaking);
  act(sums.damping);
  act(sums.broken);
  if constexpr (std::is_same_v<std::remove_const_t<Sums>, FaceSums>) {
    act(sums.crack);
    act(sums.plastic);
    act(sums.astray);
    act(sums.hands_over);
  } else {
    act(sums.losses);
  }
}

constexpr std::int64_t end_of_list = -1;

template <class Sums>
void pack_list(const std::vector<Sums>& all, Range own, Pack& pack) {
  for (std::int64_t c = own.begin; c < own.end; ++c)
    if (!is_zero(all[c])) {
      pack(c);
      each_member(all[c], pack);
    }
  pack(end_of_list);
}

template <class Sums>
void unpack_list(Unpack& unpack, std::vector<Sums>& all) {
  for (std::int64_t c = 0;;) {
    unpack(c);
    if (c == end_of_list)
      return;
    each_member(all[c], unpack);
  }
}

template <class Sums>
bool any_in(const std::vector<Sums>& all, Range own) {
  for (std::int64_t c = own.begin; c < own.end && !all.empty(); ++c)
    if (!is_zero(all[c]))
      return true;
  return false;
}

template <class Sums>
void clear(std::vector<Sums>& all, std::int64_t begin, std::int64_t end) {
  for (std::int64_t c = begin; c < end; ++c)
    if (!is_zero(all[c]))
      all[c] = {};
}

} // namespace

bool has_to_tell(const Workspace& work, const BegunCracks& begun) {
  const Partition& part = work.part();
  if (part.size == 1)
    return false;
  return any_in(work.face_sums, part.mesh_chunks()) || any_in(work.bond.sums, part.point_chunks()) ||
         !begun.empty();
}

void share_reliefs(BegunCracks& begun) {
  if (!ranks().any(!begun.reliefs.empty()))
    return;
  Pack pack;
  pack(begun.reliefs);
  begun.reliefs.clear();
  for (const std::string& heard : ranks().gather(pack.text())) {
    BegunCracks of_rank;
    Unpack unpack(heard);
    unpack(of_rank.reliefs);
    append(of_rank, begun);
  }
}

void share_sums(Workspace& work, BegunCracks& begun, std::int64_t tellers) {
  const Partition& part = work.part();
  const Range meshes = part.mesh_chunks(), points = part.point_chunks();
  for (int r = 0; r < part.size; ++r) {
    if (r == part.rank)
      continue;
    clear(work.face_sums, std::max(part.chunk_begin[r], part.stars) - part.stars,
          std::max(part.chunk_begin[r + 1], part.stars) - part.stars);
    clear(work.bond.sums, part.point_begin[r], part.point_begin[r + 1]);
  }
  if (tellers == 0)
    return;
  Pack pack;
  pack_list(work.face_sums, work.face_sums.empty() ? Range() : meshes, pack);
  pack_list(work.bond.sums, work.bond.sums.empty() ? Range() : points, pack);
  pack(begun.broken);
  pack(begun.breaking);
  pack(begun.relieved);
  pack(begun.energies);
  const std::vector<std::string> heard = ranks().gather(pack.text(), Ranks::Subject::sums);
  BegunCracks all;
  for (int r = 0; r < part.size; ++r) {
    if (r == part.rank) {
      append(begun, all);
      continue;
    }
    Unpack unpack(heard[r]);
    BegunCracks of_rank;
    unpack_list(unpack, work.face_sums);
    unpack_list(unpack, work.bond.sums);
    unpack(of_rank.broken);
    unpack(of_rank.breaking);
    unpack(of_rank.relieved);
    unpack(of_rank.energies);
    append(of_rank, all);
  }
  begun = std::move(all);
}

std::vector<std::uint8_t> near_of_all_ranks(const Workspace& work) {
  const StateShares& shares = work.shared->shares();
  const Range own_bits = shares.own(shares.batch_begin());
  const auto bits = work.near.bits.begin();
  const std::string own(bits + own_bits.begin, bits + own_bits.end);
  std::vector<std::uint8_t> all;
  for (const std::string& of_rank : ranks().gather(own))
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  return all;
}

void take_near_of_all(std::vector<std::uint8_t> of_all, Workspace& work) {
  work.near.bits = std::move(of_all);
  work.near.crack_known = true;
  const StateShares& shares = work.shared->shares();
  const Range own = shares.own(shares.batch_begin());
  const auto bits = work.near.bits.begin();
  std::fill(bits, bits + own.begin, NearStrength::may_crack);
  std::fill(bits + own.end, work.near.bits.end(), NearStrength::may_crack);
}

} // namespace cdem
