// Forces of sources (triangles with their three semi-springs, and semi-edges) on the targets near them.
#pragma once

#include "libcdem/contact/broad_phase/active_surface.hpp"
#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/contact/geometry/face_cover.hpp"
#include "libcdem/contact/geometry/nearest.hpp"
#include "libcdem/contact/narrow_phase/edge_lines.hpp"
#include "libcdem/contact/response/contact_law.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/state/state.hpp"

#include <optional>

namespace cdem {

// Goes through rows of one kind, by ascending source. Adds their contacts, as they are after the step, with their forces
// and sums to `out`. Rows and candidates go to sleep.
class Evaluation {
public:
  Evaluation(const Model&, const State&, const ContactWork&, Contact::Kind, ContactChunk& out);

  void springs(ContactRow&, ContactCandidate*); // candidates: of all rows
  void edges(ContactRow&, ContactCandidate*);

private:
  // Contact law of two sides. between: their bodies, or their blocks and the law that a joint at them left,
  // where some have one.
  struct Law {
    std::array<int, 3> between{-1, -1, -1};
    const Joint* joint = nullptr;
    double tan_friction = 0;
  };
  const Law& law_between(const TrianglesOfSide& from, const TrianglesOfSide& to);
  // m, both blocks together, since the search; or what the pair has moved.
  double moved(const ContactRow&) const;
  // m, what is found now and is d away waits until `moved` is from + d.
  double from(const ContactRow&) const;
  double moved_in_step(const ContactRow&) const; // m
  // A semi-spring with this outward normal of its own triangle lies beside an edge of the target, and under the face beyond
  // the edge, which faces it better, no deeper than semi-springs stand in.
  bool at_a_step(const ContactTriangle& from, const geom::Vec3& outward, const geom::Vec3& spring,
                 const geom::Vec3& normal, int target) const;
  void go_to(int source); // what stood at it before
  const Contact* before(const Contact&) const;
  // m, as `begins` of add_contact: infinite where what is found may have been there unseen.
  double begins_at(int source, int target, double shallow) const;
  double narrow_phase(ContactRow&, ContactCandidate*, bool all); // returns how deep the deepest is, m
  using Springs = std::array<geom::Vec3, 3>;                     // where the three of a source are, m
  // All of them stand outside a fragment that is a single tet, or outside the other block of a rigid pair, and so they
  // touch nothing until they have moved.
  bool stand_outside(ContactRow&, const Springs&);
  // The nearest places of one fragment to them, of all targets that do not sleep.
  void find_nearest(ContactRow&, ContactCandidate*, bool all, const Springs&, std::array<Nearest, 3>&);
  Nearest nearest_on(int target, const geom::Vec3& spring, double gives);
  // begins: m, what was no contact before begins no deeper than that and the way of the step at its place. False where it
  // is none.
  bool add_contact(int source, int corner, const geom::Vec3& spring, int fragment, const Nearest&,
                   double begins);
  void add_contact(int source, int target, const NearestOfEdges&, const EdgeTouch&, bool may_begin);
  // Two flat faces, by their numbers.
  const FaceCover& cover(int f, int g);
  double size_of(const std::pair<int, int>&) const; // m
  // Part of what areas lack that a slip as that of the step brings, of those that change slowly and fast; 0: they go on as they did.
  const std::array<double, 2>& nearing(int f, int g);
  bool are_flat(int one, int other); // two triangles of such faces, that can lie on each other
  bool is_step(int one, int other, double depth) const; // deeper below a face than semi-springs stand in
  bool slid_over(const ContactEdge&, const ContactEdge&, const NearestOfEdges&);
  // What a flat face gives to a contact that presses on it.
  struct OnFace {
    double area = 0; // m2, for which the contact should stand; 0: no face lies there
    double nearing = 0;
    bool slid_on = false; // a new contact came over an outline, not through the face
    bool crosses = false; // no face lies there: two edges cross
    double to_end =
        std::numeric_limits<double>::infinity(); // m, to the nearest end of one of them where none goes on
    geom::Vec3 off_end = geom::Vec3::Zero();     // unit: how that changes by the slip
  };
  // f: the face of the source; of: m2, without the faces.
  OnFace on_face(int f, int g, const geom::Vec3& place, double of, const Contact* old, bool of_spring);
  // On which face a semi-spring presses whose nearest place on the surface of a block is `found`: on a flat one that its own face
  // lies on, however near the next face is; on none where a face beside its own lies on the found one, and stands for it.
  std::optional<Nearest> pressed_by(int source, const geom::Vec3& spring, const Nearest& found);
  // How a crossing stands to the ends of its two edges; sets end_moment.
  OnFace near_end(int source, int target, const NearestOfEdges&, const EdgeTouch&, ContactMotion&) const;
  // Sets stiffness and area of a contact. old: the same one before the step, null where there was none; of: m2, without
  // another face; on: m2, for which it should stand on a flat face, 0: on another, or as it does.
  void set_stiffness(Contact&, const Contact* old, const ContactLaw&, double of, double on) const;
  // Stores what the old one did before the step. Returns it, J: it is booked as lost with the old one, and is not.
  double take_over(Contact&, const Contact& old, const ContactLaw&, const ContactMotion&) const;
  // What the contacts between two blocks share in a step.
  struct BlockSide {
    bool turns_round = false;            // else it is held
    bool deforms = false;                // by itself or in pieces that do
    bool in_one_piece = false;           // else its pieces move by themselves
    double density = 0;                  // kg/m3
    double acceleration = 0;             // m/s2, that the forces on the block can give it
    const BlockMotion* motion = nullptr; // that restitution uses; null: that of the contact
    bool moves_as_whole() const { return !turns_round || !deforms || motion; }
  };
  struct BlockPair {
    int source_block = -1, target_block = -1;
    BlockSide source, target;
    double omega_step = 0, felt_over_usual = 1; // as in ContactMotion
    bool shares_friction = false;
  };
  BlockSide side_of(int block) const;
  const BlockPair& pair_of(int source_block, int target_block);
  // The velocity that restitution uses of one side of a contact, m/s.
  geom::Vec3 velocity_of_side(const BlockSide&, const std::array<int, 4>& nodes,
                              const std::array<double, 4>& weights) const;
  // m/s2, that a contact of this force (N) can give its nodes on one side.
  double local_acceleration(const BlockSide&, const ContactTriangle&, const std::array<int, 4>& nodes,
                            const std::array<double, 4>& weights, double force) const;
  // Gives a contact that closes again what is left of its means.
  void go_on_if_opened(Contact&) const;
  void widen(Contact&, const Contact& old, const ContactMotion&, const OnFace&) const;
  static void pass_end(Contact&, const Contact* old, const ContactLaw& usual, const ContactMotion&,
                       const OnFace&);
  // For restitution, of a contact before it advances. velocity: m/s, of its source past its target.
  void set_approach(const Contact&, const ContactLaw&, const BlockPair&, const ContactArms&,
                    const geom::Vec3& velocity, const ContactTriangle& from, const ContactTriangle& to,
                    ContactMotion&) const;
  // old: the contact before the step, null where there was none. The law is that of its kind, however stiff the contact is.
  void finish(Contact&, const Contact* old, ContactMotion&, const ContactArms&, const ContactLaw&,
              const ContactTriangle& from, const ContactTriangle& to, const OnFace&);

  // Where a triangle is now: of a few that follow each other it is worked out once.
  const Facet& facet(int triangle);

  const Model& model_;
  const ContactSurface& surface_;
  const State& state_;
  const ContactWork& work_;
  Contact::Kind kind_;
  ContactChunk& out_;
  EdgeLines lines_;
  std::vector<Contact>::const_iterator old_; // the first contact of the row's source or a later one
  std::array<Law, 8> laws_;                  // by the last bits of the numbers of both
  std::array<BlockPair, 8> pairs_;
  struct TwoFaces {
    std::pair<int, int> faces{-1, -1};
    std::optional<FaceCover> cover;
    std::optional<std::array<double, 2>> nearing;
  };
  TwoFaces& two_faces(int f, int g);
  std::array<TwoFaces, 8> two_faces_; // by the last bits of the numbers of both
  std::array<Facet, 64> facets_;      // by the last bits of a triangle's number
  std::array<int, 64> facet_of_;
};

} // namespace cdem
