// The reference page of the script language (docs/script-reference.md).
#include "lua/binding/module/module.hpp"
#include "lua/binding/module/topics.hpp"
#include "lua/binding/text/markdown.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace cdem::script {

namespace {

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
            : type.or_object ? type.object + " or function "
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

// The anchor of a heading: letters, digits and _ in lower case, blanks as hyphens.
std::string anchor(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_')
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (c == ' ' || c == '-')
      out += '-';
  }
  return out;
}

std::string link(const std::string& name) {
  return "[`" + name + "`](#" + anchor(name) + ")";
}

// " -> `cdem.RelaxResult`", with a link to what is described on the page.
std::string returned(const Module& all, const std::string& returns) {
  if (returns.empty())
    return "";
  const std::string bare = returns.substr(0, returns.find_first_of("[?|"));
  const std::string name = bare.rfind("cdem.", 0) == 0 ? bare.substr(5) : "";
  bool described = false;
  for (const Class& c : all.classes)
    described = described || c.name == name;
  for (const RecordType& r : all.records)
    described = described || r.name == name;
  return described ? " -> [`" + returns + "`](#" + anchor(name) + ")" : " -> `" + returns + "`";
}

std::string call_of(const std::string& shown, const Function& f) {
  std::string arguments;
  for (const Field& field : f.fields)
    if (f.in_order || field.must)
      arguments +=
          (arguments.empty() ? "" : ", ") + (f.in_order && !field.must ? "[" + field.name + "]" : field.name);
  if (f.fields.empty())
    return shown + "()";
  return shown +
         (f.in_order ? "(" + arguments + ")" : "{ " + arguments + (arguments.empty() ? "... }" : ", ... }"));
}

std::string lua_block(const std::string& text) {
  return text.empty() ? "" : "```lua\n" + text + "```\n\n";
}

void write_function(std::string& out, const Module& all, const std::string& shown, const Function& f) {
  out += "### " + shown + "\n\n`" + call_of(shown, f) + "`" + returned(all, f.returns) + "\n\n" + f.doc;
  if (!f.returns_doc.empty())
    out += " Returns " + f.returns_doc + ".";
  out += "\n\n";
  table_of(out, f.fields, "", false);
  out += lua_block(example_of(shown));
}

const Function& function_of(const Module& all, const std::string& name) {
  for (const Function& f : all.functions)
    if ("cdem." + f.name == name)
      return f;
  for (const Class& c : all.classes)
    for (const Function& f : c.methods)
      if (anchor(c.name) + ":" + f.name == name)
        return f;
  throw std::logic_error("no function " + name);
}

void write_class(std::string& out, const Class& c) {
  out += "### " + c.name + "\n\n" + c.doc + "\n\n";
  if (!c.properties.empty()) {
    out += "| property | type | unit | meaning |\n|---|---|---|---|\n";
    for (const Property& p : c.properties)
      out += "| `" + p.name + "`" + (p.set ? " (can be set)" : "") + " | " + cell(p.lua_type) + " | " +
             p.unit + " | " + cell(p.doc) + " |\n";
    out += "\n";
  }
  if (c.methods.empty())
    return;
  out += "Methods: ";
  for (std::size_t i = 0; i < c.methods.size(); ++i)
    out += (i > 0 ? ", " : "") + link(anchor(c.name) + ":" + c.methods[i].name);
  out += ".\n\n";
}

std::string contents() {
  std::string out = "## Contents\n\n";
  for (const Topic& topic : topics()) {
    out += "- [" + topic.title + "](#" + anchor(topic.title) + "): ";
    for (std::size_t i = 0; i < topic.names.size(); ++i)
      out += (i > 0 ? ", " : "") + link(topic.names[i]);
    out += "\n";
  }
  return out + "- [Tables that calls return](#tables-that-calls-return)\n\n";
}

void write_topic(std::string& out, const Module& all, const Topic& topic) {
  out += "## " + topic.title + "\n\n";
  if (const std::string preamble = example_preamble(topic.file); !preamble.empty())
    out += "The examples of this topic begin with:\n\n" + lua_block(preamble);
  for (const Class& c : all.classes)
    if (std::find(topic.classes.begin(), topic.classes.end(), c.name) != topic.classes.end())
      write_class(out, c);
  for (const std::string& name : topic.names)
    write_function(out, all, name, function_of(all, name));
}

} // namespace

std::string reference() {
  const Module& all = module();
  std::string out =
      "<!-- Generated from the declarations that check a script's arguments; do not edit. -->\n"
      "# Script reference\n\n"
      "Every function a case script can call, by topic. Units are SI, angles are in degrees. Stress, "
      "traction and "
      "principal stress are positive in tension.\n\n"
      "A *place* says where something acts. It is one of these, or a list of them:\n\n"
      "- a side of the box of the model as it was made, `\"x-\"` to `\"z+\"`, or `\"all\"`;\n"
      "- the name of a body, or a name given by `model:select`;\n"
      "- a `cdem.select.*` value;\n"
      "- a `function(x, y, z)` that gets undeformed places (m) and returns true or false.\n\n"
      "A script runs in a [safe environment](security.md). It writes into its output folder only. It reads "
      "files beside itself, in its output folder, below the results and, in a sweep, below the sweep's "
      "folder. "
      "There is no `os.execute`, `io.popen`, `package.loadlib`, `debug` or bytecode; `require` finds `cdem` "
      "and the "
      "`.lua` files beside the script. `--unsafe` lifts these limits.\n\n"
      "Every function has an example, which the tests run. In the [repl](command-line.md#cdem-repl), "
      "`help NAME` shows the same text.\n\n";
  out += contents();
  for (const Topic& topic : topics())
    write_topic(out, all, topic);
  for (const Constant& c : all.constants)
    out += "### cdem." + c.name + "\n\n" + c.doc + "\n\n";
  out += "## Tables that calls return\n\n";
  for (const RecordType& record : all.records) {
    out += "### " + record.name + "\n\n" + record.doc + "\n\n";
    table_of(out, record.fields, "", true);
  }
  while (out.size() > 1 && out[out.size() - 2] == '\n')
    out.pop_back();
  return out;
}

std::string help(const std::string& name) {
  const Module& all = module();
  std::string out;
  if (name.empty()) {
    out = "help NAME tells about a function, a class or a topic. Topics:\n";
    for (const Topic& topic : topics())
      out += "  " + topic.file + std::string(14 - std::min<std::size_t>(topic.file.size(), 13), ' ') +
             topic.title + "\n";
    return out;
  }
  std::vector<std::string> known;
  for (const Topic& topic : topics()) {
    known.push_back(topic.file);
    if (topic.file == name) {
      out = topic.title + ":\n";
      for (const std::string& one : topic.names)
        out += "  " + call_of(one, function_of(all, one)) + "\n";
      return out;
    }
    for (const std::string& one : topic.names) {
      known.push_back(one);
      if (one != name && one.substr(one.find_first_of(".:") + 1) != name)
        continue;
      const Function& f = function_of(all, one);
      out += call_of(one, f) + (f.returns.empty() ? "" : " -> " + f.returns) + "\n  " + f.doc + "\n";
      for (const Field& field : f.fields) {
        const std::string range = field.type.range.text();
        out += "  " + field.name + ": " + type_text(field.type);
        out += (field.unit_text.empty() ? "" : ", " + field.unit_text) + (range.empty() ? "" : ", " + range);
        out += field.must                      ? ", required"
               : field.standard_value.is_nil() ? ""
                                               : ", default " + describe(field.standard_value);
        out += (field.doc_text.empty() ? "" : ": " + field.doc_text) + "\n";
      }
      if (const std::string example = example_of(one); !example.empty())
        out += "\n" + example;
    }
  }
  for (const Class& c : all.classes) {
    known.push_back(c.name);
    if (c.name != name)
      continue;
    out += c.name + ": " + c.doc + "\n";
    for (const Function& f : c.methods)
      out += "  " + call_of(anchor(c.name) + ":" + f.name, f) + "\n";
  }
  if (out.empty()) {
    // "cdem.gird" is nearer to cdem.grid than "gird".
    std::string hint = did_you_mean(name, known);
    if (hint.empty())
      hint = did_you_mean("cdem." + name, known);
    if (hint.empty())
      hint = did_you_mean("model:" + name, known);
    throw geom::InputError("help " + name + ": no such name" +
                           (hint.empty() ? "; help lists the topics" : hint));
  }
  return out;
}

} // namespace cdem::script
