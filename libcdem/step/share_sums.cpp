#include "libcdem/step/share_sums.hpp"

#include <cstring>

namespace cdem {
namespace {

template <class T>
void put(const T& value, std::string& to) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
void put(const std::vector<T>& values, std::string& to) {
  put(values.size(), to);
  to.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

class Take {
public:
  explicit Take(const std::string& from) : at_(from.data()) {}

  template <class T>
  void operator()(T& value) {
    bytes(&value, sizeof value);
  }
  template <class T>
  void operator()(std::vector<T>& values) {
    std::size_t count = 0;
    (*this)(count);
    values.assign(count, T());
    bytes(values.data(), count * sizeof(T));
  }
  void bytes(void* to, std::size_t count) {
    std::memcpy(to, at_, count);
    at_ += count;
  }

private:
  const char* at_;
};

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
void each_member(Sums& sums, const Act& act) {
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
void put_list(const std::vector<Sums>& all, Range own, std::string& to) {
  for (std::int64_t c = own.begin; c < own.end; ++c)
    if (!is_zero(all[c])) {
      put(c, to);
      each_member(all[c], [&](const auto& member) { put(member, to); });
    }
  put(end_of_list, to);
}

template <class Sums>
void take_list(Take& take, std::vector<Sums>& all) {
  for (std::int64_t c = 0;;) {
    take(c);
    if (c == end_of_list)
      return;
    each_member(all[c], [&](auto& member) { take(member); });
  }
}

} // namespace

void share_sums(Workspace& work, BegunCracks& begun) {
  if (!work.shared)
    return;
  const Partition& part = work.shared->part();
  const Range chunks = part.chunks(), meshes = part.mesh_chunks(), points = part.point_chunks();
  std::string told(reinterpret_cast<const char*>(work.node_sums.data() + chunks.begin),
                   static_cast<std::size_t>(chunks.size()) * sizeof(NodeSums));
  put_list(work.face_sums, work.face_sums.empty() ? Range() : meshes, told);
  put_list(work.bond.sums, work.bond.sums.empty() ? Range() : points, told);
  put(begun.broken, told);
  put(begun.breaking, told);
  put(begun.energies, told);
  const std::vector<std::string> heard = ranks().gather(told, Ranks::Subject::sums);
  BegunCracks all;
  for (int r = 0; r < part.size; ++r) {
    Take take(heard[r]);
    BegunCracks of_rank;
    if (r == part.rank) {
      append(begun, all);
      continue;
    }
    const std::int64_t first = part.chunk_begin[r], count = part.chunk_begin[r + 1] - first;
    take.bytes(work.node_sums.data() + first, static_cast<std::size_t>(count) * sizeof(NodeSums));
    for (std::int64_t c = std::max(first - part.stars, std::int64_t{0}); c < first + count - part.stars; ++c)
      work.face_sums[c] = {};
    for (std::int64_t c = part.point_begin[r]; c < part.point_begin[r + 1]; ++c)
      work.bond.sums[c] = {};
    take_list(take, work.face_sums);
    take_list(take, work.bond.sums);
    take(of_rank.broken);
    take(of_rank.breaking);
    take(of_rank.energies);
    append(of_rank, all);
  }
  begun = std::move(all);
}

} // namespace cdem
