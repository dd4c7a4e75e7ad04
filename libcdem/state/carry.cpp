#include "libcdem/state/carry.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace cdem {
namespace {

class Carrier {
public:
  Carrier(const Model& old, const Model& now, const TopologyMap& map, State& state)
      : old_(old), now_(now), map_(map), from_(std::move(state)), to_(state) {}

  void operator()() {
    to_ = map_.tet ? initial_state(now_) : initial_state_without_tets(now_);
    each_field([&](const FieldRow& row, auto& from, auto& to) { carry(row, from, to); }, from_, to_);
    carry_slips();
    carry_contacts();
  }

private:
  template <class Field>
  void carry(const FieldRow& row, Field& from, Field& to) {
    if constexpr (is_array<decltype(from)>)
      carry_array(row, from, to);
    else
      to = from;
  }

  template <class T>
  void carry_array(const FieldRow& row, std::vector<T>& from, std::vector<T>& to) {
    if (stays(row.place)) {
      std::swap(from, to);
      return;
    }
    if constexpr (std::is_same_v<T, ExcavationForce>) {
      carry_excavation(from, to);
      return;
    }
    if (row.need == FieldNeed::later && !from.empty())
      to.assign(*entries_of(row, now_), first_entry(to));
    if (from.empty() || to.empty())
      return;
    switch (row.place) {
    case FieldPlace::node:
      carry_nodes(row.carried, from, to);
      break;
    case FieldPlace::tet_batch:
      if constexpr (is_tet_batch<T>)
        carry_batches(from, to);
      break;
    case FieldPlace::face_batch:
      if constexpr (std::is_same_v<T, FaceStateBatch>)
        carry_faces(from, to);
      break;
    case FieldPlace::small_strain_tet:
      copy(*map_.tet, from, to);
      break;
    case FieldPlace::face:
      copy(*map_.face, from, to);
      break;
    case FieldPlace::bond:
      copy(*map_.bond, from, to);
      break;
    case FieldPlace::frame:
      copy(*map_.frame, from, to);
      break;
    case FieldPlace::rigid_body:
      copy(*map_.rigid_body, from, to);
      break;
    default:
      break; // slips and contacts follow when all else is there
    }
  }

  // Whether all entries of a place keep their numbers.
  bool stays(FieldPlace place) const {
    switch (place) {
    case FieldPlace::node:
    case FieldPlace::excavation:
      return !map_.node;
    case FieldPlace::tet_batch:
    case FieldPlace::small_strain_tet:
      return !map_.tet;
    case FieldPlace::face_batch:
    case FieldPlace::face:
    case FieldPlace::slip:
      return !map_.face;
    case FieldPlace::bond:
      return !map_.bond;
    case FieldPlace::frame:
      return !map_.frame;
    case FieldPlace::rigid_body:
      return !map_.rigid_body;
    case FieldPlace::contact:
      return !map_.new_triangle;
    case FieldPlace::model:
    case FieldPlace::body:
    case FieldPlace::column:
    case FieldPlace::bolt:
      break;
    }
    return true;
  }

  template <class Index, class T>
  static void copy(const std::vector<Index>& old_number, const std::vector<T>& from, std::vector<T>& to) {
    for (std::size_t i = 0; i < to.size(); ++i)
      if (old_number[i] >= 0)
        to[i] = from[static_cast<std::size_t>(old_number[i])];
  }

  template <class T>
  void carry_nodes(FieldCarried carried, const std::vector<T>& from, std::vector<T>& to) const {
    if constexpr (std::is_same_v<T, Node> || std::is_same_v<T, double>) {
      if (carried == FieldCarried::divided) {
        for (const SharedNode& share : map_.divided)
          add(share.part, from[share.old_node], to[share.node]);
        return;
      }
    }
    copy(*map_.node, from, to);
    for (const BlendedNode& blended : map_.blended) {
      if constexpr (std::is_same_v<T, Node>) {
        if (carried == FieldCarried::blended) {
          for (int k = 0; k < 4; ++k)
            add(blended.weights[k], from[blended.tet[k]], to[blended.node]);
          continue;
        }
      }
      Eigen::Index nearest = 0;
      blended.weights.maxCoeff(&nearest);
      to[blended.node] = from[blended.tet[nearest]];
    }
  }

  static void add(double part, double from, double& to) { to += part * from; }
  static void add(double part, const Node& from, Node& to) {
    to.x += part * from.x;
    to.y += part * from.y;
    to.z += part * from.z;
  }

  // Forces go where all that is divided among nodes goes; those on removed nodes end.
  void carry_excavation(const std::vector<ExcavationForce>& from, std::vector<ExcavationForce>& to) const {
    if (from.empty())
      return;
    std::multimap<std::int64_t, const ExcavationForce*> at;
    for (const ExcavationForce& force : from)
      at.emplace(force.node, &force);
    for (const SharedNode& share : map_.divided) {
      const auto [begin, end] = at.equal_range(share.old_node);
      for (auto force = begin; force != end; ++force) {
        ExcavationForce part = *force->second;
        part.node = share.node;
        for (double* const component : {&part.x, &part.y, &part.z})
          *component *= share.part;
        to.push_back(part);
      }
    }
  }

  // A batch holds some numbers of eight tets: number by number, tet by tet.
  template <class T>
  static constexpr bool is_tet_batch =
      std::is_same_v<T, StressBatch> || std::is_same_v<T, PlasticStrainBatch> || std::is_same_v<T, TimeBatch>;
  static double* lane_of(StressBatch& batch, int number) { return batch.component[number]; }
  static double* lane_of(PlasticStrainBatch& batch, int) { return batch.strain; }
  static double* lane_of(TimeBatch& batch, int) { return batch.time; }

  template <class Batch>
  void carry_batches(std::vector<Batch>& from, std::vector<Batch>& to) const {
    constexpr int numbers = sizeof(Batch) / sizeof(double) / lanes;
    for (auto tet = static_cast<std::size_t>(now_.mesh.first_tet); tet < now_.tets.size(); ++tet) {
      const int was = (*map_.tet)[tet];
      if (was < 0)
        continue;
      const int slot = now_.mesh.tet_slot[tet - static_cast<std::size_t>(now_.mesh.first_tet)],
                old_slot = old_.mesh.tet_slot[was - old_.mesh.first_tet];
      for (int i = 0; i < numbers; ++i)
        lane_of(to[slot / lanes], i)[slot % lanes] = lane_of(from[old_slot / lanes], i)[old_slot % lanes];
    }
  }

  // But for the place of their slips, which is that of an initial state.
  void carry_faces(const std::vector<FaceStateBatch>& from, std::vector<FaceStateBatch>& to) const {
    for (std::size_t face = 0; face < map_.face->size(); ++face) {
      const std::int64_t was = (*map_.face)[face];
      if (was < 0)
        continue;
      const FaceStateBatch& f = from[static_cast<std::size_t>(was / lanes)];
      FaceStateBatch& t = to[face / lanes];
      const int lane = static_cast<int>(face % lanes), old_lane = static_cast<int>(was % lanes);
      for (int point = 0; point < 3; ++point)
        t.mode[point][lane] = f.mode[point][old_lane];
      t.handed_over[lane] = f.handed_over[old_lane];
      t.stage[lane] = f.stage[old_lane];
      t.preloaded[lane] = f.preloaded[old_lane];
      t.let_go[lane] = f.let_go[old_lane];
      t.told[lane] = f.told[old_lane];
    }
  }

  void carry_slips() {
    if (!map_.face)
      return;
    for (std::size_t face = 0; face < map_.face->size(); ++face) {
      const std::int64_t was = (*map_.face)[face];
      if (was < 0)
        continue;
      if (from_.faces[was / lanes].slip >= 0)
        slips_of(to_, static_cast<std::int64_t>(face / lanes))
            .set(static_cast<int>(face % lanes), slip_of(from_, was / lanes, static_cast<int>(was % lanes)));
    }
  }

  void carry_contact_of_tets(Contact c, const std::vector<int>& new_tet) {
    int a = static_cast<int>(c.source), b = c.target;
    if (!new_tet.empty()) {
      a = new_tet[a];
      b = new_tet[b];
    }
    if (a < 0 || b < 0)
      return;
    if (a > b) { // the lower one is the source
      std::swap(a, b);
      c.normal = -c.normal;
      c.shear = -c.shear;
    }
    c.source = static_cast<std::uint32_t>(a) & 0x3fffffffu;
    c.target = c.fragment = b;
    to_.contacts.push_back(c);
  }

  void carry_contacts() {
    if (!map_.new_triangle || (from_.contacts.empty() && from_.opened_contacts.empty()))
      return;
    const std::vector<int> pieces = map_.fragments_of_nodes(now_, to_);
    std::vector<int> new_tet; // by the old number; none: all stay
    if (map_.tet) {
      new_tet.assign(old_.tets.size(), -1);
      for (std::size_t t = 0; t < map_.tet->size(); ++t)
        if ((*map_.tet)[t] >= 0)
          new_tet[(*map_.tet)[t]] = static_cast<int>(t);
    }
    const auto now = [&](int triangle) { return (*map_.new_triangle)[triangle]; };
    const auto carry_contact = [&](Contact& c) { // false: its triangles are gone
      const bool edge = c.kind == Contact::edge;
      const auto [old_source, old_target] = triangles_of(c);
      const int source = now(old_source), target = now(old_target);
      if (source < 0 || target < 0 || (edge && (now(c.beside) < 0 || now(c.fragment) < 0)))
        return false;
      c.source = static_cast<std::uint32_t>(3 * source + static_cast<int>(c.source) % 3) & 0x3fffffffu;
      c.target = edge ? 3 * target + c.target % 3 : target;
      if (edge)
        c.beside = now(c.beside);
      c.fragment = edge ? now(c.fragment) : pieces[now_.surface.triangles[target].nodes[0]];
      return true;
    };
    for (Contact c : from_.contacts)
      if (c.kind == Contact::tets)
        carry_contact_of_tets(c, new_tet);
      else if (carry_contact(c))
        to_.contacts.push_back(c);
    for (OpenedContact opened : from_.opened_contacts)
      if (carry_contact(opened.last))
        to_.opened_contacts.push_back(opened);
    sort_by_key(to_.contacts);
    sort_by_key(to_.opened_contacts);
  }

  const Model& old_;
  const Model& now_;
  const TopologyMap& map_;
  State from_;
  State& to_;
};

} // namespace

void carry(const Model& old, const Model& now, const TopologyMap& map, State& state) {
  Carrier(old, now, map, state)();
}

} // namespace cdem
