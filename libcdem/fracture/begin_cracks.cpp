#include "libcdem/fracture/begin_cracks.hpp"

#include "libcdem/bond/cohesive_faces.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/linear_traction.hpp"
#include "libcdem/fracture/own_rocks.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace cdem {
namespace {

using geom::Mat3;
using geom::Vec3;

// A crack ends where no more than this part of the strength that is left is asked of its face.
constexpr double unloaded_part = 0.97;

// 1/s, rate of deformation of a tet.
Mat3 rate_of_strain(const Model& model, const State& state, int tet) {
  const Mat3 f = Mat3::Identity() + displacement_gradient(model, state.displacement, tet);
  const Mat3 rate = displacement_gradient(model, state.velocity, tet) * f.inverse();
  return 0.5 * (rate + rate.transpose());
}

// 1/s, sqrt(d : d) of the rate of deformation d, in the mean of the two tets.
double strain_rate(const Model& model, const State& state, const FaceTets& tets) {
  return 0.5 *
         (rate_of_strain(model, state, tets.tet_a).norm() + rate_of_strain(model, state, tets.tet_b).norm());
}

// Places of the two tets of faces among the stresses, of eight faces, and what is left of their strength; lanes from `count`
// on repeat the last one.
struct SlotsOfFaces {
  int count = 0;
  int face[lanes];
  SlotsOfTets tets;
  double left[lanes];
};

// Whether the mean stress of the two tets of each face is beyond a bound: a bit each.
CDEM_INLINE void beyond_kernel(const SlotsOfFaces* eights, std::size_t count, const StressBatch* stress,
                               const UtilisationBound* bounds, std::size_t bound_count,
                               std::uint8_t* beyond) {
  using simd::Oct;
  for (std::size_t i = 0; i < count; ++i) {
    const SlotsOfFaces& at = eights[i];
    Oct s[6];
    for (int c = 0; c < 6; ++c)
      for (int lane = 0; lane < lanes; ++lane)
        s[c][lane] = 0.5 * (stress[at.tets.a[lane] / lanes].component[c][at.tets.a[lane] % lanes] +
                            stress[at.tets.b[lane] / lanes].component[c][at.tets.b[lane] % lanes]);
    for (Oct& component : s)
      component /= simd::load(at.left);
    unsigned bits = 0;
    for (std::size_t k = 0; k < bound_count; ++k)
      if (simd::any(simd::below<Oct>(Oct{}, bounds[k].coarsely_beyond(s))))
        bits |= simd::bits_of(simd::below<Oct>(Oct{}, bounds[k].beyond(s)));
    beyond[i] = static_cast<std::uint8_t>(bits);
  }
}

// Some stress s with s n = t.
Mat3 stress_with(const Vec3& t, const Vec3& n) {
  return t * n.transpose() + n * t.transpose() - t.dot(n) * n * n.transpose();
}

class ChunkCracks {
public:
  ChunkCracks(const Model& model, State& state, const StrengthWatch& watch, const NearStrength& near,
              std::int64_t index, const CrackingStep& step)
      : model_(model), state_(state), watch_(watch), near_(near), index_(index), step_(step),
        chunk_(model.mesh.chunks[index]), body_(model.bodies[model.blocks[chunk_.block].body]), rocks_(body_),
        joints_(model, state, chunk_),
        has_joints_(!body_.bonding.everywhere || !body_.region_laws.joints.empty()) {}

  BegunCracks operator()() {
    find_facet_tractions();
    for (const int face : faces_to_look_at()) {
      const std::int64_t batch = chunk_.face_batches.begin + face / lanes;
      const int lane = face % lanes;
      if (state_.faces[batch].stage[lane] == FaceStage::cracking)
        go_on(batch, lane);
      else
        look_at(batch, lane);
    }
    if (breaking_ != 0)
      begun_.breaking.emplace_back(index_, breaking_);
    if (crack_.tension != 0 || crack_.shear != 0)
      begun_.energies.emplace_back(index_, crack_);
    return std::move(begun_);
  }

private:
  // Ascending: those that crack and may end, and of those that hold the ones that may be at what is left of their strength. The
  // part of its strength that a joint uses is no more than what the stress of its tets and what its springs use together.
  std::vector<int> faces_to_look_at() const {
    thread_local std::vector<SlotsOfFaces> near;
    thread_local std::vector<std::uint8_t> beyond;
    thread_local std::vector<int> cracking;
    near.clear();
    cracking.clear();
    std::vector<int> faces;
    const std::int64_t first = chunk_.face_batches.begin * lanes;
    const double harmless = watch_.harmless_stress(index_);
    for (int begin = 0; begin < chunk_.faces; begin += lanes) {
      const std::int64_t batch = (first + begin) / lanes;
      const FaceStateBatch& state = state_.faces[batch];
      const unsigned used = (1u << std::min(chunk_.faces - begin, lanes)) - 1,
                     resumed = faces_in(state, FaceStage::resumed),
                     hold = (faces_in(state, FaceStage::holding) | resumed) & used;
      each_lane(faces_in(state, FaceStage::cracking) & used, [&](int lane) {
        __builtin_prefetch(&state_.cohesive[first + begin + lane].damage);
        cracking.push_back(begin + lane);
      });
      const unsigned pulled = has_joints_ ? pulled_faces(batch, harmless) | resumed : 0;
      each_lane(hold != 0 ? hold & (near_faces(batch) | pulled) : 0, [&](int lane) {
        const int face = begin + lane;
        if (is_in_facet(face))
          return;
        const bool resumes = (resumed >> lane & 1u) != 0;
        const double pull =
            has_joints_ ? most_of_traction * std::sqrt(near_.pull2[first + face]) / harmless : 0;
        const double left = (resumes ? 1 - damage_of(state_.cohesive[first + face]) : 1) - pull;
        // The bounds of a curve are not in proportion to what is left.
        if (!(left > 0) || (resumes && rock_of(face).curve.on()))
          faces.push_back(face);
        else
          add(face, left, near);
      });
    }
    std::copy_if(cracking.begin(), cracking.end(), std::back_inserter(faces),
                 [&](int face) { return may_end(state_.cohesive[first + face]); });
    for (int face = 0; face < static_cast<int>(in_facet_.size()); ++face)
      if (is_in_facet(face) && holds(state_.faces[(first + face) / lanes].stage[face % lanes]))
        faces.push_back(face);
    std::sort(faces.begin(), faces.end());
    if (near.empty())
      return faces;
    SlotsOfFaces& last = near.back();
    for (int lane = last.count; lane < lanes; ++lane) {
      last.tets.a[lane] = last.tets.a[last.count - 1];
      last.tets.b[lane] = last.tets.b[last.count - 1];
      last.left[lane] = last.left[last.count - 1];
    }
    beyond.resize(near.size());
    const std::vector<UtilisationBound>& bounds = watch_.strength_bounds(index_);
    simd::best<beyond_kernel>(near.data(), near.size(), state_.stress.data(), bounds.data(), bounds.size(),
                              beyond.data());
    for (std::size_t i = 0; i < near.size(); ++i)
      for (int lane = 0; lane < near[i].count; ++lane)
        if ((beyond[i] >> lane & 1) != 0)
          faces.push_back(near[i].face[lane]);
    std::sort(faces.begin(), faces.end());
    return faces;
  }

  // A bit for each face of the batch beside a tet that may be at its strength.
  unsigned near_faces(std::int64_t batch) const {
    static_assert(NearStrength::may_crack == 1);
    const SlotsOfTets& at = watch_.slots_at(batch);
    unsigned bits = 0;
    for (int lane = 0; lane < lanes; ++lane)
      bits |= ((near_.bits[at.a[lane] / lanes] | near_.bits[at.b[lane] / lanes]) & NearStrength::may_crack)
              << lane;
    return bits;
  }
  // A bit for each face of the batch whose springs may use the rest of what `due_at` leaves to its tets.
  unsigned pulled_faces(std::int64_t batch, double harmless) const {
    const double most = (1 - due_at) * harmless / most_of_traction;
    unsigned bits = 0;
    for (int lane = 0; lane < lanes; ++lane)
      bits |= static_cast<unsigned>(near_.pull2[batch * lanes + lane] > most * most) << lane;
    return bits;
  }
  void add(int face, double left, std::vector<SlotsOfFaces>& near) const {
    if (near.empty() || near.back().count == lanes)
      near.emplace_back();
    const SlotsOfTets& at = watch_.slots_at(chunk_.face_batches.begin + face / lanes);
    SlotsOfFaces& last = near.back();
    last.face[last.count] = face;
    last.tets.a[last.count] = at.a[face % lanes];
    last.tets.b[last.count] = at.b[face % lanes];
    last.left[last.count++] = left;
  }

  // Mean of both tets.
  Mat3 stress_at(std::int64_t face) const {
    const FaceTets& tets = model_.mesh.face_tets[face];
    return 0.5 * (matrix(mesh_stress(model_, state_, tets.tet_a)) +
                  matrix(mesh_stress(model_, state_, tets.tet_b)));
  }

  // behind: s, before now.
  FaceFrame frame(std::int64_t batch, int lane, double behind) const {
    const auto since = [&](int node) { return Vec3(behind * velocity_of(state_, node)); };
    return face_frame(
        face_nodes(model_.mesh, chunk_, batch, lane),
        [&](int node) { return Vec3(place_of(model_, state_, node) - since(node)); },
        [&](int node) { return Vec3(vec(state_.displacement[node]) - since(node)); });
  }
  FaceMoment moment(std::int64_t batch, int lane, const Mat3& stress, const FaceFrame& then) const {
    FaceMoment at{then, {}, stress};
    const FaceFrame now = frame(batch, lane, 0);
    for (int point = 0; point < 3; ++point)
      at.moved[point] = now.gap[point] - at.frame.gap[point];
    return at;
  }

  FaceMoment moment(std::int64_t batch, int lane, const Mat3& stress) const {
    return moment(batch, lane, stress, frame(batch, lane, step_.moved_for));
  }

  // Among the faces of the chunk.
  int place(std::int64_t batch, int lane) const {
    return static_cast<int>(batch - chunk_.face_batches.begin) * lanes + lane;
  }

  // A face that cracks and may end.
  void go_on(std::int64_t batch, int lane) {
    CohesiveFace& face = state_.cohesive[batch * lanes + lane];
    const Joint& joint = joints_.of(place(batch, lane), room_);
    const FaceBatch& at = model_.mesh.faces[batch];
    if (joint.softening != Softening::none) {
      const std::int64_t number = batch * lanes + lane;
      const Mat3 stress = stress_at(number);
      RockStrength rock = rock_of(place(batch, lane));
      raise(rock, unloaded_part * (1 - damage_of(face)));
      const FacePlane kind = plane_of_face(number);
      const FaceFrame then = frame(batch, lane, step_.moved_for);
      const int at_place = place(batch, lane);
      const auto holds_again = [&] {
        if (is_in_facet(at_place))
          return !worst_plane(in_facet_[at_place], rock);
        const Mat3 borne =
            kind == FacePlane::own
                ? with_traction(stress, then.normal,
                                mean_traction(at, lane, then, joint, state_.faces[batch], face))
                : stress;
        return strength_utilisation(borne, rock, then.normal, kind) < 1;
      };
      if (holds_again())
        breaking_ += end_crack(at, lane, moment(batch, lane, stress, then), joint, state_.faces[batch], face)
                         .value_or(0);
    } else if (step_.moved_for > 0) {
      const double taken =
          let_go(at, lane, moment(batch, lane, Mat3::Zero()), joint, state_.faces[batch], face);
      breaking_ += taken;
      crack_.add(std::max(0.0, taken),
                 state_.faces[batch].mode[0][lane] == static_cast<std::uint8_t>(BondMode::broken_shear) ? 1
                                                                                                        : 0);
    }
  }

  // A face that holds.
  void look_at(std::int64_t batch, int lane) {
    const std::int64_t number = batch * lanes + lane;
    const int face = place(batch, lane);
    if (is_in_facet(face))
      return look_at_facet(batch, lane);
    const FacePlane kind = plane_of_face(number);
    const FaceFrame then = frame(batch, lane, step_.moved_for);
    const Mat3 stress = stress_at(number), borne = borne_by(stress, kind, batch, lane, then);
    RockStrength rock = rock_left(number, face);
    const double components[6] = {borne(0, 0), borne(1, 1), borne(2, 2),
                                  borne(0, 1), borne(1, 2), borne(0, 2)};
    if (joints_.own() && !rock.curve.on() && !(UtilisationBound(rock, 1).beyond(components) > 0))
      return; // the bounds of the chunk are those of its weakest faces
    const FaceTets& tets = model_.mesh.face_tets[number];
    const auto plane_at = [&] {
      if (kind != FacePlane::of_material)
        return critical_plane(borne, rock, then.normal, kind);
      auto found = critical_plane(borne, rock, then.normal, FacePlane::of_ragged_border);
      if (found && std::abs(found->normal.dot(then.normal)) < least_cosine &&
          !watch_.is_nearest_of_a_tet(model_, state_, tets, then.normal, found->normal))
        found.reset();
      return found;
    };
    const auto plane = at_rate(number, face, rock, plane_at);
    if (!plane)
      return;
    const FaceFrame before = frame(batch, lane, step_.moved_for + step_.length);
    const bool was_beyond = strength_utilisation(borne_by(stress - rise(tets), kind, batch, lane, before),
                                                 rock, before.normal, kind) >= 1;
    FaceMoment at = moment(batch, lane, stress, then);
    at.borne = borne;
    begin(batch, lane, at, *plane, was_beyond);
  }

  // The plane that fails, with the strength at the rate of strain; plane_at() follows `rock`.
  template <class PlaneAt>
  std::optional<CriticalPlane> at_rate(std::int64_t number, int face, RockStrength& rock,
                                       const PlaneAt& plane_at) {
    std::optional<CriticalPlane> plane = plane_at();
    if (plane && !state_.rate_factor.empty()) {
      const double factor =
          step_.in_real_time
              ? dynamic_increase_factor(joints_.before_rate(face).rate,
                                        strain_rate(model_, state_, model_.mesh.face_tets[number]))
              : 1;
      raise(rock, factor);
      plane = plane_at();
      if (plane)
        state_.rate_factor[number] = factor;
    }
    return plane;
  }

  // A face between joined blocks without zones that is not damaged.
  struct InFacet {
    bool is = false;
    Vec3 normal = Vec3::Zero();     // unit
    std::array<Vec3, 3> at_corners; // Pa, in space, on side a
  };
  bool is_in_facet(int face) const { return !in_facet_.empty() && in_facet_[face].is; }
  // The traction at the corners of such faces: of the linear one that has the resultant and the moment of what all of them carry
  // in a facet. Their tets' stress alone does not see bending.
  void find_facet_tractions() {
    const std::vector<FacetFaces>& facets = watch_.facets(index_);
    if (facets.empty())
      return;
    in_facet_.resize(static_cast<std::size_t>(chunk_.faces));
    for (const FacetFaces& facet : facets)
      fit(facet);
  }
  void fit(const FacetFaces& facet) {
    LinearTraction linear;
    std::optional<Vec3> near; // a place of the facet
    for (std::size_t i = 0; i < facet.faces.size(); ++i) {
      const int face = facet.faces[i], lane = face % lanes;
      const std::int64_t number = chunk_.face_batches.begin * lanes + face, batch = number / lanes;
      const FaceStage stage = state_.faces[batch].stage[lane];
      if (!holds(stage) && !(stage == FaceStage::cracking && may_end(state_.cohesive[number]) &&
                             joints_.of(face, room_).softening != Softening::none))
        continue;
      const std::array<Vec3, 3> corners = corners_of(batch, lane);
      if (!near)
        near = corners[0];
      const FaceFrame then = stage == FaceStage::holding ? frame_of_whole(batch, lane, corners)
                                                         : frame(batch, lane, step_.moved_for);
      const auto tractions = carried_tractions(model_.mesh.faces[batch], lane, then, stress_at(number),
                                               joints_.of(face, room_), stage, state_.cohesive[number]);
      const double side = facet.first_is_a[i] != 0 ? 1 : -1;
      const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 6 - *near;
      for (int point = 0; point < 3; ++point)
        linear.add(model_.mesh.faces[batch].area[lane], middle + 0.5 * corners[point],
                   side * tractions[point], side * then.normal);
      in_facet_[face] = {true, then.normal, corners};
    }
    if (!near)
      return;
    linear.fit();
    for (std::size_t i = 0; i < facet.faces.size(); ++i)
      if (InFacet& face = in_facet_[facet.faces[i]]; face.is)
        for (Vec3& at : face.at_corners) // a place so far
          at = (facet.first_is_a[i] != 0 ? 1 : -1) * linear.at(at - *near);
  }
  std::array<Vec3, 3> corners_of(std::int64_t batch, int lane) const {
    const FaceNodes nodes = face_nodes(model_.mesh, chunk_, batch, lane);
    std::array<Vec3, 3> corners;
    for (int corner = 0; corner < 3; ++corner)
      corners[corner] = place_of(model_, state_, nodes.a[corner]);
    return corners;
  }
  // The gaps at the moment of the stress and the normal of side a: sides that have never cracked lie on each other.
  FaceFrame frame_of_whole(std::int64_t batch, int lane, const std::array<Vec3, 3>& corners) const {
    const FaceNodes nodes = face_nodes(model_.mesh, chunk_, batch, lane);
    const auto moved = [&](int node) {
      return Vec3(vec(state_.displacement[node]) - step_.moved_for * velocity_of(state_, node));
    };
    Vec3 apart[3];
    for (int corner = 0; corner < 3; ++corner)
      apart[corner] = moved(nodes.b[corner]) - moved(nodes.a[corner]);
    FaceFrame f;
    f.normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    f.along = f.across = Vec3::Zero();
    for (int point = 0; point < 3; ++point)
      f.gap[point] = (apart[0] + apart[1] + apart[2]) / 6 + 0.5 * apart[point];
    return f;
  }
  // The plane of the corner that uses most of the strength, if that is all of it.
  static std::optional<CriticalPlane> worst_plane(const InFacet& face, const RockStrength& rock) {
    double most = 0;
    Mat3 worst = Mat3::Zero();
    for (const Vec3& t : face.at_corners) {
      const Mat3 stress = stress_with(t, face.normal);
      if (const double used = strength_utilisation(stress, rock, face.normal, FacePlane::own); used > most) {
        most = used;
        worst = stress;
      }
    }
    return most >= 1 ? critical_plane(worst, rock, face.normal, FacePlane::own) : std::nullopt;
  }
  // A face that holds in a facet. Its law begins at what each point carries, at most the strength.
  void look_at_facet(std::int64_t batch, int lane) {
    const std::int64_t number = batch * lanes + lane;
    const int face = place(batch, lane);
    RockStrength rock = rock_left(number, face);
    auto plane = at_rate(number, face, rock, [&] { return worst_plane(in_facet_[face], rock); });
    if (!plane)
      return;
    FaceMoment at = moment(batch, lane, stress_at(number));
    const Vec3 n = plane->normal = at.frame.normal;
    at.carried =
        carried_tractions(model_.mesh.faces[batch], lane, at.frame, at.stress, joints_.of(face, room_),
                          state_.faces[batch].stage[lane], state_.cohesive[number]);
    for (Vec3& t : *at.carried)
      if (const auto beyond = critical_plane(stress_with(t, n), rock, n, FacePlane::own))
        t = beyond->traction;
    begin(batch, lane, at, *plane, true);
  }

  // The strength of a face that holds: a crack that did not continue took the rest, at most the part that may_end allows.
  RockStrength rock_left(std::int64_t number, int face) const {
    RockStrength rock = rock_of(face);
    if (state_.faces[number / lanes].stage[number % lanes] == FaceStage::resumed)
      raise(rock, 1 - damage_of(state_.cohesive[number]));
    return rock;
  }
  // Pa: a joint has a plane of its own, on which it bears what its springs add too.
  Mat3 borne_by(const Mat3& stress, FacePlane kind, std::int64_t batch, int lane, const FaceFrame& f) const {
    if (kind != FacePlane::own)
      return stress;
    const Joint none;
    const Vec3 pull = mean_traction(model_.mesh.faces[batch], lane, f, none, state_.faces[batch],
                                    state_.cohesive[batch * lanes + lane]);
    return with_traction(stress, f.normal, stress * f.normal + pull);
  }
  RockStrength rock_of(int face) const {
    return rocks_.of(joints_.law(face), joints_.tensile_strength(face), joints_.cohesion(face));
  }
  FacePlane plane_of_face(std::int64_t number) const {
    const FaceTets& tets = model_.mesh.face_tets[number];
    return watch_.plane_between(model_, tets.tet_a, tets.tet_b);
  }
  // Pa, in the last step.
  Mat3 rise(const FaceTets& tets) const {
    const auto rate = [&](int tet) {
      return matrix(elastic_stress(body_.material, rate_of_strain(model_, state_, tet)));
    };
    return 0.5 * step_.length * (rate(tets.tet_a) + rate(tets.tet_b));
  }

  static void raise(RockStrength& rock, double factor) {
    rock.tensile_strength *= factor;
    rock.cohesion *= factor;
  }

  void begin(std::int64_t batch, int lane, FaceMoment at, const CriticalPlane& plane, bool was_beyond) {
    const std::int64_t number = batch * lanes + lane;
    const Vec3 change = plane.traction - at.borne * plane.normal;
    if (!was_beyond && change.norm() > 1e-9 * plane.traction.norm()) {
      const Elastic& m = body_.material;
      const Mat3 relieved = relief(change, plane.normal, m.lame_lambda(), m.shear_modulus());
      const FaceTets& tets = model_.mesh.face_tets[number];
      const Stress stress{relieved(0, 0), relieved(1, 1), relieved(2, 2),
                          relieved(0, 1), relieved(1, 2), relieved(0, 2)};
      begun_.reliefs.push_back({tets.tet_a, stress});
      begun_.reliefs.push_back({tets.tet_b, stress});
      at.relieved = relieved;
    }
    const Joint& joint = joints_.of(place(batch, lane), room_);
    breaking_ += begin_crack(model_.mesh.faces[batch], lane, at, joint, plane.normal, plane.mode,
                             state_.faces[batch], state_.cohesive[number]);
    if (joint.softening != Softening::none)
      return;
    const double normal = plane.traction.dot(plane.normal);
    for (int point = 0; point < 3; ++point)
      begun_.broken.push_back({index_,
                               {batch, point, lane},
                               plane.mode,
                               plane.normal,
                               normal,
                               (plane.traction - normal * plane.normal).norm()});
  }

  const Model& model_;
  State& state_;
  const StrengthWatch& watch_;
  const NearStrength& near_;
  std::int64_t index_;
  CrackingStep step_;
  const MeshChunk& chunk_;
  const Body& body_;
  OwnRocks rocks_;
  FaceJoints joints_;
  bool has_joints_; // some faces may have a plane of their own
  Joint room_;
  std::vector<InFacet> in_facet_; // per face; empty: there are no facets
  BegunCracks begun_;
  double breaking_ = 0; // J, of the chunk
  CrackEnergy crack_;   // J, of the chunk
};

// J/m3.
double elastic_energy(const Elastic& m, const Mat3& s) {
  const double trace = s.trace();
  return (s.squaredNorm() - m.poissons_ratio / (1 + m.poissons_ratio) * trace * trace) /
         (4 * m.shear_modulus());
}

bool is_larger(const Stress& a, const Stress& b) {
  const double x = matrix(a).squaredNorm(), y = matrix(b).squaredNorm();
  return x != y ? x > y : std::lexicographical_compare(b.begin(), b.end(), a.begin(), a.end());
}

} // namespace

BegunCracks begin_cracks(const Model& model, State& state, const StrengthWatch& watch,
                         const NearStrength& near, Range chunks, const CrackingStep& step) {
  std::vector<BegunCracks> of_chunks(static_cast<std::size_t>(chunks.size()));
  for_chunks(chunks, step.threads, [&](std::int64_t c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    if (chunk.side_batches.size() > 0 && !is_rigid(model, chunk))
      of_chunks[c - chunks.begin] = ChunkCracks(model, state, watch, near, c, step)();
  });
  BegunCracks all;
  for (const BegunCracks& some : of_chunks)
    append(some, all);
  return all;
}

void relieve(const Model& model, State& state, BegunCracks& begun, Range chunks, const CrackingStep& step) {
  std::vector<BegunCracks::Relief>& all = begun.reliefs;
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.tet != b.tet ? a.tet < b.tet : is_larger(a.change, b.change);
  });
  all.erase(std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.tet == b.tet; }),
            all.end());
  std::int64_t chunk = 0;
  for (const BegunCracks::Relief& relief : all) {
    while (relief.tet >= model.mesh.chunks[chunk].tets.end)
      ++chunk;
    const Elastic& material = model.bodies[model.blocks[model.mesh.chunks[chunk].block].body].material;
    const Mat3 before = matrix(mesh_stress(model, state, relief.tet)), change = matrix(relief.change),
               after = before + change;
    const double taken = elastic_energy(material, before) - elastic_energy(material, after);
    if (!(taken > 0)) // relief of a face beside, not of this tet
      continue;
    set_mesh_stress(model, state, relief.tet,
                    {after(0, 0), after(1, 1), after(2, 2), after(0, 1), after(1, 2), after(0, 2)});
    if (chunk < chunks.begin || chunk >= chunks.end)
      continue;
    const Mat3 f = Mat3::Identity() + displacement_gradient(model, state.displacement, relief.tet);
    // Half a step's work of what is taken has gone into no store.
    const double work =
        -0.5 * step.moved_for * change.cwiseProduct(rate_of_strain(model, state, relief.tet)).sum();
    const double energy = tet_volume(model, relief.tet) * f.determinant() * (taken + work);
    if (!begun.relieved.empty() && begun.relieved.back().first == chunk)
      begun.relieved.back().second += energy;
    else
      begun.relieved.emplace_back(chunk, energy);
  }
  all.clear();
}

void append(const BegunCracks& more, BegunCracks& all) {
  all.breaking.insert(all.breaking.end(), more.breaking.begin(), more.breaking.end());
  all.relieved.insert(all.relieved.end(), more.relieved.begin(), more.relieved.end());
  all.energies.insert(all.energies.end(), more.energies.begin(), more.energies.end());
  all.broken.insert(all.broken.end(), more.broken.begin(), more.broken.end());
  all.reliefs.insert(all.reliefs.end(), more.reliefs.begin(), more.reliefs.end());
}

} // namespace cdem
