#include "libcdem/bond/freed_face.hpp"

#include "libcdem/bond/cohesive_law.hpp"

namespace cdem {
namespace {

using geom::Vec3;

Vec3 vec(const CohesiveFace::Vector& v) {
  return {v[0], v[1], v[2]};
}
CohesiveFace::Vector array(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

// Pa, what a cracking point carries, in the face's axes.
Vec3 carried(const SofteningLaw& law, const CohesiveFace& face, int point, const Vec3& gap) {
  return vec(cohesive_response<double>(law, cohesive_point(face, point), triple(gap), false).traction);
}

} // namespace

SofteningLaw cohesive_law(const Joint& joint, double k) {
  const double stiffness = crack_stiffness * k;
  return softening_law(joint, stiffness, stiffness, SofteningBegins::at_strength);
}

FaceSpring cohesive_spring(const FaceBatch& batch, int lane, const FaceFrame& f, int point,
                           const Joint& joint, const FaceStateBatch& state, const CohesiveFace& face) {
  FaceSpring spring;
  spring.gap = f.gap[point];
  spring.normal = f.normal;
  const Vec3 stretch = f.in_axes(f.gap[point]) + vec(face.offset[point]);
  if (holds(state.stage[lane])) {
    spring.force = batch.kn[lane] * f.in_space(stretch);
    spring.energy = 0.5 * batch.kn[lane] * stretch.squaredNorm();
  } else if (has_springs(state.stage[lane])) {
    const SofteningLaw law = cohesive_law(joint, batch.kn[lane] / batch.area[lane]);
    const CohesivePoint<double> at = cohesive_point(face, point);
    const Triple<double> gap = triple(f.in_axes(f.gap[point]));
    const CohesiveResponse<double> r = cohesive_response<double>(law, at, gap, false);
    const double area = (1 - state.let_go[lane]) * batch.area[lane];
    spring.force = f.in_space(area * vec(r.traction));
    spring.energy = area * cohesive_stored<double>(law, at, gap, r);
  }
  return spring;
}

double FreedFace::stored(const FaceFrame& f) const {
  double energy = 0;
  for (int point = 0; point < 3; ++point)
    energy += spring(f, point).energy;
  return energy;
}

std::array<Vec3, 3> carried_tractions(const FreedFace& of, const FaceFrame& f, const geom::Mat3& stress) {
  const double k = of.penalty();
  const Vec3 on_face = stress * f.normal;
  std::array<Vec3, 3> tractions;
  for (int point = 0; point < 3; ++point)
    tractions[point] =
        holds(of.state.stage[of.lane])
            ? Vec3(on_face + k * (f.gap[point] + f.in_space(vec(of.face.offset[point]))))
            : f.in_space(carried(cohesive_law(of.joint, k), of.face, point, f.in_axes(f.gap[point])));
  return tractions;
}

Vec3 mean_traction(const FreedFace& of, const FaceFrame& f) {
  Vec3 force = Vec3::Zero();
  for (int point = 0; point < 3; ++point)
    force += of.spring(f, point).force;
  return force / (3 * of.batch.area[of.lane]);
}

double begin_crack(const FreedFace& of, const FaceMoment& at, const Vec3& m, BondMode mode) {
  const FaceFrame& f = at.frame;
  CohesiveFace& face = of.face;
  const double k = of.penalty(), before = of.stored(f);
  const geom::Mat3 stress = at.stress + at.relieved;
  const Vec3 on_plane = f.in_axes((at.borne + at.relieved) * m), on_face = f.in_axes(stress * f.normal);
  of.state.stage[of.lane] = FaceStage::cracking;
  face.plane = array(f.in_axes(m));
  const SofteningLaw law = cohesive_law(of.joint, k);
  double work = 0;
  for (int point = 0; point < 3; ++point) {
    const Vec3 gap = f.in_axes(f.gap[point]), held = on_face + k * (gap + vec(face.offset[point])),
               pulls = at.carried ? f.in_axes((*at.carried)[point]) : held;
    const PartsOfStretch<double> stands = parts_of_stretch<double>(
        law, triple(f.in_axes(m)), triple(Vec3((at.carried ? pulls : on_plane) / law.kn)));
    work += 0.5 * of.batch.area[of.lane] *
            (at.relieved * f.normal + f.in_space(pulls - held)).dot(at.moved[point]);
    // A crack that ended may have damaged it: its law goes on where it was.
    const double part = 1 - face.damage[point];
    double drawn = fourth_power(part);
    Vec3 bonded = vec(stands.bonded) / (part * drawn);
    // What pressure stores in the contact of a brittle face, its own springs may have stored. r0 bears the rest for a step.
    if (at.carried && !law.softens) {
      const double own = k * (gap + vec(face.offset[point])).squaredNorm(),
                   contact = law.kn * vec(stands.pressed).squaredNorm();
      drawn = contact > own ? 1 - own / contact : 0;
      bonded.setZero();
    }
    face.offset[point] = array(vec(stands.pressed) + bonded);
    face.start[point] = array(gap);
    face.drawn[point] = drawn;
    face.slip[point] = {};
    face.rest[point] = {};
    face.rest[point] = array((pulls - carried(law, face, point, gap)) / part);
    if (!law.softens)
      of.state.mode[point][of.lane] = static_cast<std::uint8_t>(mode);
  }
  return before - of.stored(f) - work;
}

void break_face(const Model& model, State& state, const MeshChunk& chunk, std::int64_t batch, int lane,
                const geom::Mat3& stress) {
  const FaceFrame f = face_frame(
      face_nodes(model.mesh, chunk, batch, lane), [&](int node) { return place_of(model, state, node); },
      [&](int node) { return cdem::vec(state.displacement[node]); });
  Joint room;
  const Joint& joint =
      FaceJoints(model, state, chunk).of((batch - chunk.face_batches.begin) * lanes + lane, room);
  const FreedFace of{model.mesh.faces[batch], lane, joint, state.faces[batch],
                     state.cohesive[batch * lanes + lane]};
  const SofteningLaw law = cohesive_law(joint, of.penalty());
  CohesiveFace broken;
  broken.plane[2] = 1;
  broken.damage = {1, 1, 1};
  for (int point = 0; point < 3; ++point) {
    const Vec3 traction = stress * f.normal + of.spring(f, point).force / of.batch.area[lane];
    const Vec3 stretch = f.in_axes(traction) / law.kn;
    broken.offset[point] = array(vec(parts_of_stretch<double>(law, {0, 0, 1}, triple(stretch)).pressed));
    broken.start[point] = array(f.in_axes(f.gap[point]));
    of.state.mode[point][lane] = static_cast<std::uint8_t>(BondMode::contact);
  }
  of.face = broken;
  of.state.stage[lane] = FaceStage::cracking;
  of.state.preloaded[lane] = 0;
}

double let_go(const FreedFace& of, const FaceMoment& at) {
  CohesiveFace& face = of.face;
  const SofteningLaw law = cohesive_law(of.joint, of.penalty());
  const double before = of.stored(at.frame);
  double work = 0;
  for (int point = 0; point < 3; ++point) {
    const Vec3 gap = at.frame.in_axes(at.frame.gap[point]);
    const Vec3 before_it = carried(law, face, point, gap);
    face.damage[point] = 1;
    face.rest[point] = {};
    const Vec3 lost = before_it - carried(law, face, point, gap);
    work += 0.5 * of.batch.area[of.lane] * at.frame.in_space(lost).dot(at.moved[point]);
  }
  return before - of.stored(at.frame) + work;
}

std::optional<double> end_crack(const FreedFace& of, const FaceMoment& at) {
  const FaceFrame& f = at.frame;
  CohesiveFace& face = of.face;
  const SofteningLaw law = cohesive_law(of.joint, of.penalty());
  const Vec3 m = vec(face.plane);
  for (int point = 0; point < 3; ++point) {
    const CohesiveResponse<double> r =
        cohesive_response<double>(law, cohesive_point(face, point), triple(f.in_axes(f.gap[point])), false);
    const Vec3 t = vec(r.across);
    const double normal = t.dot(m), shear = (t - normal * m).norm(),
                 left = unloaded_part * (1 - face.damage[point]);
    if (normal > left * law.tensile_strength ||
        cohesive_load(shear, law.tan_friction, normal) > left * law.cohesion)
      return std::nullopt;
  }
  const double before = of.stored(f);
  const Vec3 on_face = f.in_axes(at.stress * f.normal);
  for (int point = 0; point < 3; ++point) {
    const Vec3 gap = f.in_axes(f.gap[point]);
    const Vec3 traction = carried(law, face, point, gap);
    face.offset[point] = array((traction - on_face) / of.penalty() - gap);
    face.rest[point] = {};
  }
  of.state.stage[of.lane] = FaceStage::resumed;
  return before - of.stored(f);
}

} // namespace cdem
