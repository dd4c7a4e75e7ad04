// The reference page of the script language (docs/script-reference.md).
#include "lua/binding/runtime/engine.hpp"
#include "lua/binding/runtime/module.hpp"

namespace cdem::script {

namespace {

std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|')
      out += "\\|";
    else
      out += c;
  }
  return out;
}

std::string type_text(const Type& type) {
  switch (type.kind) {
  case Kind::record:
    return "table (below)";
  case Kind::list:
    return (type.items[0].kind == Kind::record ? "list of tables (below)"
                                               : "list of " + type_text(type.items[0])) +
           (type.fields.empty() ? "" : ", and named values (below)");
  case Kind::vec3:
    return type.whole ? "{x, y, z}, whole" : "{x, y, z}";
  case Kind::place:
    return "place";
  case Kind::function:
    return (type.or_number   ? "number or function "
            : type.or_vec3   ? "vector or function "
            : type.or_record ? "record, list of {time, value} or function "
                             : "function ") +
           type.name;
  case Kind::object:
    return with_or(type.name, " or ");
  case Kind::named:
    return "{ name = " + type_text(type.items[0]) + ", ... }";
  case Kind::tuple: {
    std::string out;
    for (const Type& item : type.items)
      out += (out.empty() ? "" : ", ") + type_text(item);
    return "{" + out + "}";
  }
  case Kind::choice:
    return type.lua_type();
  case Kind::scalar:
    return "string, number or boolean";
  case Kind::plain:
    return "plain value";
  default:
    return type.lua_type();
  }
}

void table_of(std::string& out, const std::vector<Field>& fields, const std::string& path, bool results,
              const char* heading = "Each of") {
  if (fields.empty())
    return;
  if (!path.empty())
    out += std::string(heading) + " `" + path + "`:\n\n";
  out += results ? "| name | type | unit | meaning |\n|---|---|---|---|\n"
                 : "| name | type | unit | range | default | meaning |\n|---|---|---|---|---|---|\n";
  for (const Field& f : fields) {
    out += "| `" + f.name + "` | " + cell(type_text(f.type)) + " | " + f.unit_text + " | ";
    if (!results) {
      const std::string standard = f.must                      ? "**required**"
                                   : f.standard_value.is_nil() ? ""
                                                               : "`" + describe(f.standard_value) + "`";
      out += f.type.range.text() + " | " + cell(standard) + " | ";
    }
    out += cell(f.doc_text) + " |\n";
  }
  out += "\n";
  for (const Field& f : fields) {
    const std::string inner = path.empty() ? f.name : path + "." + f.name;
    if (f.type.kind == Kind::record)
      table_of(out, f.type.fields, inner, results);
    if (f.type.kind == Kind::list && f.type.items[0].kind == Kind::record)
      table_of(out, f.type.items[0].fields, inner, results);
    if (f.type.kind == Kind::list)
      table_of(out, f.type.fields, inner, results, "Named values of");
  }
}

std::string link(const std::string& returns) {
  return returns.empty() ? "" : " -> `" + returns + "`";
}

void write_function(std::string& out, const std::string& shown, const Function& f) {
  std::string arguments;
  for (const Field& field : f.fields)
    if (f.in_order || field.must)
      arguments +=
          (arguments.empty() ? "" : ", ") + (f.in_order && !field.must ? "[" + field.name + "]" : field.name);
  const std::string call =
      f.in_order ? "(" + arguments + ")" : "{ " + arguments + (arguments.empty() ? "... }" : ", ... }");
  out += "### `" + shown + (f.fields.empty() ? "()" : call) + "`" + link(f.returns) + "\n\n" + f.doc;
  if (!f.returns_doc.empty())
    out += " Returns " + f.returns_doc + ".";
  out += "\n\n";
  table_of(out, f.fields, "", false);
}

} // namespace

std::string reference() {
  const Module& all = module();
  std::string out =
      "# Script reference\n\n"
      "Generated from the declarations that check a script's arguments; do not edit. SI units; angles in "
      "degrees; "
      "stress and traction are tension positive.\n\n"
      "A *place* is a side of the model's box (`\"x-\"` .. `\"z+\"`), `\"all\"`, the name of a body, a name "
      "given by "
      "`model:select`, a `cdem.select.*` value, a `function(x, y, z)` of undeformed places, or a list of "
      "these.\n\n"
      "Scripts run in a safe environment: they write below the output folder only and read beside "
      "themselves, in the "
      "output folder, below the results and, as a run of a sweep, below the sweep's folder; there is no "
      "`os.execute`, `io.popen`, `package.loadlib`, `debug` "
      "or "
      "bytecode; `require` finds `cdem` and `.lua` files beside the script. `--unsafe` lifts all of it.\n\n"
      "## Functions\n\n";
  for (const Function& f : all.functions)
    write_function(out, "cdem." + f.name, f);
  for (const Constant& c : all.constants)
    out += "### `cdem." + c.name + "`\n\n" + c.doc + "\n\n";
  for (const Class& c : all.classes) {
    out += "## " + c.name + "\n\n" + c.doc + "\n\n";
    if (!c.properties.empty()) {
      out += "| property | type | unit | meaning |\n|---|---|---|---|\n";
      for (const Property& p : c.properties)
        out += "| `" + p.name + "`" + (p.set ? " (can be set)" : "") + " | " + cell(p.lua_type) + " | " +
               p.unit + " | " + cell(p.doc) + " |\n";
      out += "\n";
    }
    std::string variable = c.name;
    for (char& letter : variable)
      letter = static_cast<char>(letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter);
    for (const Function& f : c.methods)
      write_function(out, variable + ":" + f.name, f);
  }
  out += "## Tables that calls return\n\n";
  for (const RecordType& record : all.records) {
    out += "### " + record.name + "\n\n" + record.doc + "\n\n";
    table_of(out, record.fields, "", true);
  }
  while (out.size() > 1 && out[out.size() - 2] == '\n')
    out.pop_back();
  return out;
}

} // namespace cdem::script
