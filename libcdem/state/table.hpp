// What the table of State (state/fields.inc) says of a field, and how code goes through all of them.
#pragma once

#include "libgeom/core/types.hpp"

#include <type_traits>
#include <vector>

namespace cdem {

// bond: a spring of an interface; frame: an interface that may turn; face: of a mesh, face_batch and tet_batch: eight
// side by side; slip: eight faces with a broken spring; body: of each, and one more for the joints between them; column:
// a level of one; bolt: a node of one; excavation: a node of the rock around it.
enum class FieldPlace {
  model,
  node,
  bond,
  frame,
  small_strain_tet,
  tet_batch,
  face_batch,
  face,
  slip,
  contact,
  rigid_body,
  body,
  column,
  bolt,
  excavation
};

// Which models have the field from the beginning; later: empty until something asks for it.
enum class FieldNeed {
  always,
  softening_joints,
  joint_laws,
  stiffness_damping,
  plastic_bodies,
  cohesive_bodies,
  rate_effect,
  rigid_bodies,
  later
};

// Where the topology changes, an entry is found by the map from the new model to the old one (state/carry.hpp).
//   copied       it keeps its value; a new entry has the value of an initial state
//   blended      the same, and nodes of a part of a block interpolate in the old tet around them
//   divided      the new nodes share the value of the old one, so that the sum over all stays
enum class FieldCarried { copied, blended, divided };

// What each of several ranks holds of an array (ranks/state_shares.hpp).
//   by_all    all of it, up to date
//   motion    its own entries, and those that it reads; the pages of others are given back
//   large     its own entries; the pages of others are given back
//   small     all of it, of which its own entries are up to date
//   by_owner  all of it, which has a way of its own to be gathered
enum class FieldShared { by_all, motion, large, small, by_owner };

// What code that looks at a stage between two steps finds.
//   stands    the field as the step has left it; of contacts, as the next step will find it
//   advances  the field where the nodes are: bringing it there writes it, and it is put back (step/synchronised_view)
//   shown     it says how results are shown and nothing about mechanics: no part of the hash
enum class FieldLooked { stands, advances, shown };

// A field as the table has it.
struct FieldRow {
  const char* name;
  const char* unit;
  FieldPlace place;
  FieldNeed need;
  FieldCarried carried;
  FieldShared shared;
  FieldLooked looked;
  const char* writer;
};

template <class>
struct IsArray : std::false_type {};
template <class T>
struct IsArray<std::vector<T>> : std::true_type {};
template <class Field> // of a reference to a field: whether it is an array
inline constexpr bool is_array = IsArray<std::remove_cv_t<std::remove_reference_t<Field>>>::value;

// An entry of an array before anything has happened.
template <class T>
T first_entry(const std::vector<T>&) {
  if constexpr (std::is_same_v<T, geom::Vec3>)
    return geom::Vec3::Zero(); // Eigen leaves it open
  else
    return T{};
}

// visit(row, the field in each of the states), field by field in the order of the table. The rows are constants of the
// loop: `if (row.shared == ...)` costs nothing.
template <class Visit, class... States>
void each_field(const Visit& visit, States&... states) {
#define FIELD(type, name, unit, place, need, carried, shared, looked, writer)                                \
  visit(FieldRow{#name, unit, FieldPlace::place, FieldNeed::need, FieldCarried::carried,                     \
                 FieldShared::shared, FieldLooked::looked, writer},                                          \
        states.name...);
#include "libcdem/state/fields.inc"
#undef FIELD
}

} // namespace cdem
