// LuaCATS annotations of the module (`cdem annotations`), for completion and checks in editors.
#include "lua/binding/module/module.hpp"
#include "lua/binding/module/topics.hpp"

#include <cctype>

namespace cdem::script {

namespace {

std::string sentence(const Field& field) {
  std::string out;
  const auto add = [&](const std::string& part) {
    if (!part.empty())
      out += (out.empty() ? "" : ", ") + part;
  };
  add(field.unit_text);
  add(field.type.range.text());
  if (!field.standard_value.is_nil())
    add("default " + describe(field.standard_value));
  if (!field.doc_text.empty())
    out += (out.empty() ? "" : ": ") + field.doc_text;
  return out;
}

// ElasticOptions for elastic, ModelFixOptions for model:fix, SelectPlaneOptions for select.plane.
std::string options_name(const std::string& name) {
  std::string out;
  bool upper = true;
  for (const char c : name) {
    if (c == '.' || c == '_' || c == ':') {
      upper = true;
      continue;
    }
    out += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = false;
  }
  return out + "Options";
}

// Tables inside tables get classes of their own: MODEL + bodies -> ModelOptionsBodies.
std::string declare(std::string& out, const std::string& class_name, const std::vector<Field>& fields);

std::string type_name(std::string& out, const std::string& class_name, const Type& type) {
  if (type.kind == Kind::record)
    return "cdem." + declare(out, class_name, type.fields);
  if (type.kind == Kind::list && type.items[0].kind == Kind::record)
    return "cdem." + declare(out, class_name, type.items[0].fields) + "[]";
  return type.lua_type();
}

std::string declare(std::string& out, const std::string& class_name, const std::vector<Field>& fields) {
  std::string lines;
  for (const Field& f : fields) {
    std::string inner = f.name;
    inner[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(inner[0])));
    const std::string type = type_name(out, class_name + inner, f.type);
    const std::string text = sentence(f);
    lines += "---@field " + f.name + (f.must ? " " : "? ") + type + (text.empty() ? "" : " " + text) + "\n";
  }
  out += "---@class (exact) cdem." + class_name + "\n" + lines + "\n";
  return class_name;
}

void write_function(std::string& out, const std::string& shown, const std::string& options,
                    const Function& f) {
  std::string head = "---" + f.doc + "\n";
  std::string parameters;
  if (f.in_order) {
    for (const Field& field : f.fields) {
      const std::string type = type_name(out, options + field.name, field.type), text = sentence(field);
      head += "---@param " + field.name + (field.must ? " " : "? ") + type +
              (text.empty() ? "" : " " + text) + "\n";
      parameters += (parameters.empty() ? "" : ", ") + field.name;
    }
  } else if (!f.fields.empty()) {
    bool needed = false;
    for (const Field& field : f.fields)
      needed = needed || field.must;
    declare(out, options, f.fields);
    head += std::string("---@param options") + (needed ? " " : "? ") + "cdem." + options + "\n";
    parameters = "options";
  }
  if (!f.returns.empty())
    head += "---@return " + f.returns + (f.returns_doc.empty() ? "" : " # " + f.returns_doc) + "\n";
  out += head + "function " + shown + "(" + parameters + ") end\n\n";
}

} // namespace

std::string annotations() {
  const Module& all = module();
  std::string out = "---@meta cdem\n"
                    "-- Generated from the declarations that check a script's arguments; do not edit.\n"
                    "-- luacheck: no max line length\n\n"
                    "---@class cdem\n";
  for (const Constant& c : all.constants)
    out += "---@field " + c.name + " string " + c.doc + "\n";
  out += "local cdem = {}\n\n";
  out += "---A place: a side of the box of the model as made (\"x-\" .. \"z+\"), \"all\", a body, or one by "
         "model:select, a\n"
         "---cdem.select.* value, a function(x, y, z) of undeformed places (m), or a list of these.\n"
         "---@alias cdem.Place string|cdem.Selection|(fun(x: number, y: number, z: number): "
         "boolean)|cdem.Place[]\n\n";
  for (const RecordType& record : all.records) {
    out += "---" + record.doc + "\n";
    declare(out, record.name, record.fields);
  }
  std::string groups;
  for (const Class& c : all.classes) {
    out += "---" + c.doc + "\n---@class cdem." + c.name + "\n";
    for (const Property& p : c.properties) {
      const bool optional = !p.lua_type.empty() && p.lua_type.back() == '?';
      out += "---@field " + p.name + (optional ? "? " : " ") +
             (optional ? p.lua_type.substr(0, p.lua_type.size() - 1) : p.lua_type);
      const std::string text = p.unit + (p.unit.empty() || p.doc.empty() ? "" : ": ") + p.doc;
      out += (text.empty() ? "" : " " + text) + "\n";
    }
    if (c.item)
      out += "---@field [integer] " + c.item_type + "\n";
    if (c.length)
      out += "---@operator len: integer\n";
    out += "local " + c.name + " = {}\n\n";
    for (const Function& f : c.methods)
      write_function(out, c.name + ":" + f.name, options_name(c.name + ":" + f.name), f);
  }
  for (const Function& f : all.functions) {
    const auto dot = f.name.find('.');
    const std::string group = dot == std::string::npos ? "" : f.name.substr(0, dot);
    if (!group.empty() && groups.find(group + ";") == std::string::npos) {
      out += "cdem." + group + " = {}\n\n";
      groups += group + ";";
    }
    write_function(out, "cdem." + f.name, options_name(f.name), f);
  }
  return out + "return cdem\n";
}

} // namespace cdem::script
