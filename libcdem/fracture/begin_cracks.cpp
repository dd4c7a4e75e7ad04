#include "libcdem/fracture/begin_cracks.hpp"

#include "libcdem/fracture/faces_to_look_at.hpp"

#include <utility>

namespace cdem {
namespace {

using geom::Mat3;
using geom::Vec3;

class ChunkCracks {
public:
  ChunkCracks(const Model& model, State& state, const StrengthWatch& watch, std::int64_t chunk,
              const CrackingStep& step)
      : of_(model, state, watch, chunk), step_(step), facets_(of_, step.moved_for) {}

  BegunCracks operator()(const NearStrength& near) {
    for (const int face : faces_to_look_at(of_, facets_, near))
      if (of_.stage(face) == FaceStage::cracking)
        go_on(face);
      else if (facets_.contain(face))
        look_at_facet(face);
      else
        look_at(face);
    if (breaking_ != 0)
      begun_.breaking.emplace_back(of_.index, breaking_);
    if (crack_.tension != 0 || crack_.shear != 0)
      begun_.energies.emplace_back(of_.index, crack_);
    return std::move(begun_);
  }

private:
  FaceFrame frame_then(int face) const { return of_.frame(face, step_.moved_for); }
  FaceMoment moment(int face, const Mat3& stress, const FaceFrame& then) const {
    FaceMoment at{then, {}, stress};
    const FaceFrame now = of_.frame(face, 0);
    for (int point = 0; point < 3; ++point)
      at.moved[point] = now.gap[point] - at.frame.gap[point];
    return at;
  }

  // A face that cracks and may end.
  void go_on(int face) {
    const Joint& joint = of_.joints.of(face, room_);
    const FreedFace freed = of_.freed(face, joint);
    const FaceFrame then = frame_then(face);
    if (joint.softening != Softening::none) {
      const Mat3 stress = of_.stress(face);
      RockStrength rock = of_.rock(face);
      raise(rock, unloaded_part * (1 - damage_of(freed.face)));
      if (facets_.contain(face) ? !facets_.worst_plane(face, rock)
                                : uses_less(freed, face, stress, then, rock))
        breaking_ += end_crack(freed, moment(face, stress, then)).value_or(0);
    } else if (step_.moved_for > 0) {
      const double taken = let_go(freed, moment(face, Mat3::Zero(), then));
      breaking_ += taken;
      const bool in_shear =
          freed.state.mode[0][freed.lane] == static_cast<std::uint8_t>(BondMode::broken_shear);
      crack_.add(std::max(0.0, taken), in_shear ? 1 : 0);
    }
  }
  bool uses_less(const FreedFace& freed, int face, const Mat3& stress, const FaceFrame& then,
                 const RockStrength& rock) const {
    const FacePlane kind = of_.plane(face);
    const Mat3 borne =
        kind == FacePlane::own ? with_traction(stress, then.normal, mean_traction(freed, then)) : stress;
    return strength_utilisation(borne, rock, then.normal, kind) < 1;
  }

  // A face that holds.
  void look_at(int face) {
    const FacePlane kind = of_.plane(face);
    const FaceFrame then = frame_then(face);
    const Mat3 stress = of_.stress(face), borne = borne_by(face, stress, kind, then);
    RockStrength rock = of_.rock_left(face);
    const double components[6] = {borne(0, 0), borne(1, 1), borne(2, 2),
                                  borne(0, 1), borne(1, 2), borne(0, 2)};
    if (of_.joints.own() && !rock.curve.on() && !(UtilisationBound(rock, 1).beyond(components) > 0))
      return; // the bounds of the chunk are those of its weakest faces
    const auto plane_at = [&] {
      if (kind != FacePlane::of_material)
        return critical_plane(borne, rock, then.normal, kind);
      auto found = critical_plane(borne, rock, then.normal, FacePlane::of_ragged_border);
      if (found && std::abs(found->normal.dot(then.normal)) < least_cosine &&
          !of_.watch.is_nearest_of_a_tet(of_.model, of_.state, of_.tets(face), then.normal, found->normal))
        found.reset();
      return found;
    };
    const auto plane = at_rate(face, rock, plane_at);
    if (!plane)
      return;
    const FaceFrame before = of_.frame(face, step_.moved_for + step_.length);
    const Mat3 borne_before = borne_by(face, stress - of_.rise(face, step_.length), kind, before);
    FaceMoment at = moment(face, stress, then);
    at.borne = borne;
    begin(face, at, *plane, strength_utilisation(borne_before, rock, before.normal, kind) >= 1);
  }

  // A face that holds in a facet. Its law begins at what each point carries, at most the strength.
  void look_at_facet(int face) {
    RockStrength rock = of_.rock_left(face);
    auto plane = at_rate(face, rock, [&] { return facets_.worst_plane(face, rock); });
    if (!plane)
      return;
    FaceMoment at = moment(face, of_.stress(face), frame_then(face));
    const Vec3 n = plane->normal = at.frame.normal;
    at.carried = carried_tractions(of_.freed(face, room_), at.frame, at.stress);
    for (Vec3& t : *at.carried)
      if (const auto beyond = critical_plane(stress_with(t, n), rock, n, FacePlane::own))
        t = beyond->traction;
    begin(face, at, *plane, true);
  }

  // The plane that fails, with the strength at the rate of strain; plane_at() follows `rock`.
  template <class PlaneAt>
  std::optional<CriticalPlane> at_rate(int face, RockStrength& rock, const PlaneAt& plane_at) {
    std::optional<CriticalPlane> plane = plane_at();
    if (plane && !of_.state.rate_factor.empty()) {
      const double factor = step_.in_real_time ? dynamic_increase_factor(of_.joints.before_rate(face).rate,
                                                                         of_.strain_rate(face))
                                               : 1;
      raise(rock, factor);
      plane = plane_at();
      if (plane)
        of_.state.rate_factor[of_.number(face)] = factor;
    }
    return plane;
  }

  // Pa: a joint has a plane of its own, on which it bears what its springs add too.
  Mat3 borne_by(int face, const Mat3& stress, FacePlane kind, const FaceFrame& f) const {
    if (kind != FacePlane::own)
      return stress;
    return with_traction(stress, f.normal, stress * f.normal + mean_traction(of_.freed(face, room_), f));
  }

  void begin(int face, FaceMoment at, const CriticalPlane& plane, bool was_beyond) {
    const Vec3 change = plane.traction - at.borne * plane.normal;
    if (!was_beyond && change.norm() > 1e-9 * plane.traction.norm()) {
      const Elastic& m = of_.body.material;
      const Mat3 relieved = relief(change, plane.normal, m.lame_lambda(), m.shear_modulus());
      const Stress stress{relieved(0, 0), relieved(1, 1), relieved(2, 2),
                          relieved(0, 1), relieved(1, 2), relieved(0, 2)};
      begun_.reliefs.push_back({of_.tets(face).tet_a, stress});
      begun_.reliefs.push_back({of_.tets(face).tet_b, stress});
      at.relieved = relieved;
    }
    const Joint& joint = of_.joints.of(face, room_);
    breaking_ += begin_crack(of_.freed(face, joint), at, plane.normal, plane.mode);
    if (joint.softening != Softening::none)
      return;
    const double normal = plane.traction.dot(plane.normal);
    for (int point = 0; point < 3; ++point)
      begun_.broken.push_back({of_.index,
                               {of_.batch(face), point, face % lanes},
                               plane.mode,
                               plane.normal,
                               normal,
                               (plane.traction - normal * plane.normal).norm()});
  }

  FacesOfChunk of_;
  CrackingStep step_;
  LoadedFacets facets_;
  Joint room_;
  BegunCracks begun_;
  double breaking_ = 0; // J, of the chunk
  CrackEnergy crack_;   // J, of the chunk
};

} // namespace

BegunCracks begin_cracks(const Model& model, State& state, const StrengthWatch& watch,
                         const NearStrength& near, Range chunks, const CrackingStep& step) {
  std::vector<BegunCracks> of_chunks(static_cast<std::size_t>(chunks.size()));
  for_chunks(chunks, step.threads, [&](std::int64_t c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    if (chunk.side_batches.size() > 0 && !is_rigid(model, chunk))
      of_chunks[c - chunks.begin] = ChunkCracks(model, state, watch, c, step)(near);
  });
  BegunCracks all;
  for (const BegunCracks& some : of_chunks)
    append(some, all);
  return all;
}

void append(const BegunCracks& more, BegunCracks& all) {
  all.breaking.insert(all.breaking.end(), more.breaking.begin(), more.breaking.end());
  all.relieved.insert(all.relieved.end(), more.relieved.begin(), more.relieved.end());
  all.energies.insert(all.energies.end(), more.energies.begin(), more.energies.end());
  all.broken.insert(all.broken.end(), more.broken.begin(), more.broken.end());
  all.reliefs.insert(all.reliefs.end(), more.reliefs.begin(), more.reliefs.end());
}

} // namespace cdem
