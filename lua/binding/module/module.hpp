// The `cdem` module as data: functions, classes with their methods and properties, and the tables that calls
// return.
#pragma once

#include "lua/binding/replay/journal.hpp"
#include "lua/binding/schema/schema.hpp"

#include <functional>

namespace cdem::script {

struct Session;

struct Function {
  std::string name; // "elastic", "select.plane"; a method's own name
  std::string doc;
  std::vector<Field> fields;
  // self is null for a function; an empty body: defined in lua/cdem, declared here for the annotations
  std::function<Value(Session&, Object* self, const Arguments&)> body;
  std::string returns{}; // LuaCATS type, "" for nothing
  std::string returns_doc{};
  bool in_order = false;  // f(a, b) rather than f{ a = ..., b = ... }
  bool named_too = false; // an in_order function that takes one table with its fields as well
  // In a resumed script. A method of Model that keeps a place, a condition or a function of the script is `again`; a
  // function that reads or writes files or the clock is `recorded`.
  Replay replay = Replay::standard;
  // With several ranks only the first executes the function and sends its plain result to the others. This holds for
  // functions that draw, write files by a library, ask the clock or start processes. Their fields contain no functions
  // of the script.
  bool led = false;

  Function& ordered();          // in_order
  Function& ordered_or_named(); // in_order, named_too
  Function& replayed(Replay);
  Function& by_rank_0(); // led
};

struct Property {
  std::string name, lua_type, unit, doc;
  std::function<Value(Session&, Object&)> get;
  std::function<void(Session&, Object&, const Value&)> set{}; // empty: read only
};

// The type of the object that a body takes: body(Session&, T&, const Arguments&), or body(T&).
template <class R, class T>
T* self_of(R (*)(T&));
template <class R, class T>
T* self_of(R (*)(Session&, T&, const Arguments&));
template <class Body, class R, class T>
T* self_of(R (Body::*)(Session&, T&, const Arguments&) const);
template <class Body, class R, class T>
T* self_of(R (Body::*)(T&) const);
template <class Body>
auto self_of(const Body&) -> decltype(self_of(&Body::operator()));
template <class Body>
using SelfOf = std::remove_pointer_t<decltype(self_of(std::declval<Body>()))>;

struct Class {
  std::string name, doc;
  std::vector<Property> properties{};
  std::vector<Function> methods{};
  std::function<std::int64_t(const Object&)> length{}; // the # operator, when there is one
  std::function<std::string(const Object&)> text{};    // what print shows
  // What [1] .. [length] hold; ipairs goes over them.
  std::function<Value(const Object&, std::int64_t)> item{};
  std::string item_type{}; // LuaCATS

  // A method whose body takes the session, the object and the arguments, or the object alone.
  template <class Body>
  Function& add(std::string called, std::string sentence, std::vector<Field> fields, Body body,
                std::string returns = "", std::string returns_doc = "") {
    using Self = SelfOf<Body>;
    methods.push_back({std::move(called), std::move(sentence), std::move(fields),
                       [body](Session& session, Object* self, const Arguments& arguments) -> Value {
                         if constexpr (std::is_invocable_v<Body, Self&>)
                           return as_value(body(static_cast<Self&>(*self)));
                         else
                           return as_value(body(session, static_cast<Self&>(*self), arguments));
                       },
                       std::move(returns), std::move(returns_doc)});
    return methods.back();
  }
  // get: a function of T&.
  template <class Get>
  void property(std::string called, std::string lua_type, std::string unit, std::string sentence, Get get) {
    properties.push_back(
        {std::move(called), std::move(lua_type), std::move(unit), std::move(sentence),
         [get](Session&, Object& self) -> Value { return as_value(get(static_cast<SelfOf<Get>&>(self))); }});
  }
};

// A table that a call returns.
struct RecordType {
  std::string name, doc;
  std::vector<Field> fields;
};

struct Constant {
  std::string name, doc;
  Value value;
};

struct Module {
  std::vector<Function> functions;
  std::vector<Class> classes;
  std::vector<RecordType> records;
  std::vector<Constant> constants;

  Class& the_class(const std::string& name); // declared before; assert
  Function& add(std::string name, std::string doc, std::vector<Field> fields,
                decltype(Function::body) body = nullptr, std::string returns = "",
                std::string returns_doc = "");
};

// Everything, declared once by the files of functions/.
const Module& module();

// Shares in the module, one per file.
void bind_parameters(Module&);
void bind_materials(Module&);
void bind_hoek_brown(Module&);
void bind_joint_laws(Module&);
void bind_shapes(Module&);
void bind_discs(Module&);
void bind_solids(Module&);
void bind_surfaces(Module&);    // after solids
void bind_solid_class(Module&); // by bind_solids
void bind_armour_units(Module&);
void bind_tet_meshes(Module&);
void bind_piles(Module&);
void bind_selections(Module&);
void bind_model(Module&);
void bind_model_class(Module&); // by bind_model
void bind_conditions(Module&);
void bind_in_situ(Module&);
void bind_water(Module&);
void bind_water_table(Module&);
void bind_solving(Module&);
void bind_stability(Module&);
void bind_settling(Module&);
void bind_fracture(Module&);
void bind_bolts(Module&);
void bind_water_fields(Module&);
void bind_flow(Module&); // after water_fields
void bind_waves(Module&);
void bind_measures(Module&);
void bind_cracks(Module&);
void bind_j_integral(Module&);
void bind_joints(Module&);
void bind_fragments(Module&);
void bind_units(Module&);
void bind_output(Module&);
void bind_films(Module&); // after output
void bind_checkpoints(Module&);
void bind_charts(Module&);
void bind_stereonets(Module&);
void bind_report(Module&);
void bind_tables(Module&);
void bind_sweep(Module&);

} // namespace cdem::script
